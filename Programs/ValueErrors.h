// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Programs_ValueErrors_h
#define banyan_Programs_ValueErrors_h

#include "Base/ScalarType.h"
#include "Series/Quantize/OpacityWeight.h"
#include "Series/Quantize/Transform.h"
#include "Series/Quantize/ValueRange.h"

#include <cstdint>
#include <vector>

namespace banyan
{

class ThreadPool;

/// How decoded values differ from original ones, of one component at one step or over all.
struct ValueErrors
{
  std::int64_t Finite = 0;
  std::int64_t NonFinite = 0;        ///< originals that are NaN or infinite, or hidden
  std::int64_t NonFiniteChanged = 0; ///< of these, those that are not bit-exact
  std::int64_t OutOfBound = 0;       ///< finite originals
  std::int64_t Fill = 0;       ///< finite originals that are fill values; wrong unless bit-exact
  std::int64_t Invisible = 0;  ///< beyond the bound, but invisible before and after: not wrong
  std::int64_t OtherClass = 0; ///< finite originals whose 8-bit code is not that of the original
  /// |decoded - original|, but for those counted as Fill and Invisible; infinity when a finite
  /// value is no longer one.
  double Greatest = 0.0;
  /// In what the bound is one on: |f(decoded) - f(original)|; as `Greatest` without a transform.
  double GreatestJudged = 0.0;
  double SumSquared = 0.0;  ///< of the errors of finite values
  double SumWeighted = 0.0; ///< of opacity times squared error
  ValueRange Range;         ///< of the finite originals that are no fill values
  /// Number of the worst value: the first one with the greatest judged error. Non-finite values
  /// that are not bit-exact are worse than all others. -1 when nothing differs.
  std::int64_t Worst = -1;
  double WorstError = 0.0; ///< judged; infinity for the non-finite

  /// @param first number of the other's first value: counted on from the ones here. Merging in
  /// order gives the first of equally bad values.
  void Merge(const ValueErrors& other, std::int64_t first);

  /// Every finite value within the bound, all others bit-exact.
  bool Proven() const { return this->OutOfBound == 0 && this->NonFiniteChanged == 0; }
  double MeanSquared() const; ///< the study's equation 1; 0 without finite values
  double Weighted() const;    ///< its equation 2
  double Rmse() const;
  double OtherClassShare() const;
};

/// The 8-bit classes of the study that Banyan started from: 256 parts of a range, equally wide.
/// @par Source: "A study of time-varying octree and difference encoding", section 3.1.
class ValueClasses
{
public:
  ValueClasses() = default;
  /// With an empty range, or one without width, there is one class.
  explicit ValueClasses(const ValueRange& range);

  /// Values outside of the range are in the first or last class, NaN in the first.
  int ClassOf(double value) const
  {
    // Halves, because the width of a range of doubles may overflow. In this order NaN becomes 0.
    const double position = (0.5 * value - this->HalfLow) * this->ClassesPerHalf;
    const double number = position > 0.0 ? position : 0.0;
    return static_cast<int>(number < 255.0 ? number : 255.0);
  }

private:
  double HalfLow = 0.0;
  double ClassesPerHalf = 0.0;
};

/// Says what values are judged by.
struct Judgement
{
  double Bound = 0.0; ///< |f(decoded) - f(original)| <= this
  Transform Map;      ///< f
  ValueClasses Classes;
  const OpacityFunction* Opacity = nullptr; ///< null: 1 everywhere
  /// Beyond the bound, a value may become another one of its interval.
  InvisibleIntervals Invisible{};
  std::vector<double> FillValues{}; ///< must keep their bits
  /// By value: not 0 where a point is hidden. Such a value must keep its bits, and counts as one
  /// that is not finite. Null: none is.
  const std::uint8_t* Hidden = nullptr;
};

/// Compares `count` values of one component.
/// @param original the first value of the component, `stride` from one to the next
/// @param decoded without gaps
/// Whether a value is within the bound is decided in the type's own precision and beyond: for reals
/// with at least 64 bits of mantissa, for integers exactly; with a transform in double precision,
/// in which transforms are defined. The result does not depend on the number of threads.
ValueErrors CompareValues(ScalarType type, const void* original, int stride, const void* decoded,
  std::int64_t count, const Judgement& judgement, ThreadPool& pool);

} // namespace banyan

#endif
