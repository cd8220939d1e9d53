// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Quantize_Transform_h
#define banyan_Series_Quantize_Transform_h

#include "Base/ScalarType.h"
#include "Series/Quantize/MonotoneTable.h"
#include "Series/Quantize/ValueRange.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace banyan
{

enum class TransformKind
{
  Uniform, ///< y = x
  Asinh,   ///< y = asinh(x / scale): linear below the scale, logarithmic above, odd, 0 at 0
  Table    ///< piecewise linear through knots, by a user or from a histogram (MakeAdaptive)
};

/// A monotone map y = f(x) from values to the *transformed domain*, in which the error bound holds
/// uniformly and in which the codec's lattice lies. Where f is steep, values are kept more exactly.
///
/// Exactness: both directions use only + - * / sqrt in double precision, rounding and the exponents
/// of numbers: the same bits on every CPU and build. Both are increasing in the weak sense: of two
/// arguments the greater never gives the smaller result (for Asinh: as long as the arguments differ
/// by more than 8 units in the last place). The maps are *agreed* ones: Asinh is within 8 units in
/// the last place of the mathematical function either way, f^-1(f(x)) gives x but for rounding; the
/// encoder compares each value with what it decodes to, so that bounds do not rest on this.
///
/// f(0) = 0 and f^-1(0) = 0, bit-exact, for Uniform, Asinh, and tables that have the knot (0, 0): a
/// lattice through y = 0 keeps zeros. NaN gives NaN; infinities give infinities (or, for inverse
/// Asinh, the greatest finite value). Thread-safe; copies share the table.
///
/// @par Source: "A study of time-varying octree and difference encoding", section 3.1 (uniform,
/// non-uniform and adaptive quantizers).
class Transform
{
public:
  /// The identity.
  Transform() = default;

  /// @param scale finite, within [2^-1000, 2^1000]. Throws Error otherwise. AsinhScale chooses one.
  static Transform Asinh(double scale);

  /// @param knots as MonotoneTable demands: 2 to 4096, strictly increasing in x and y. Throws
  /// Error.
  static Transform Table(std::vector<TransformKnot> knots);

  TransformKind Kind() const { return this->Map; }
  bool IsIdentity() const { return this->Map == TransformKind::Uniform; }
  /// Returns the scale of the kind Asinh; 1 for other kinds.
  double Scale() const { return this->ScaleOfAsinh; }
  /// Returns the knots of the kind Table; empty for other kinds.
  const std::vector<TransformKnot>& Knots() const;

  /// Same kind and the same numbers, hence the same bits for every argument.
  bool operator==(const Transform& other) const;
  bool operator!=(const Transform& other) const { return !(*this == other); }

  double Forward(double x) const;
  double Inverse(double y) const;

  /// The same for `count` numbers; x and y may be the same array.
  void Forward(const double* x, std::size_t count, double* y) const;
  void Inverse(const double* y, std::size_t count, double* x) const;

  /// y[i] = Forward((double)values[i]). For all types of ScalarType.
  template <class T>
  void ForwardValues(const T* values, std::size_t count, double* y) const;

  /// values[i] = ValueFromReal<T>(Inverse(y[i])).
  template <class T>
  void InverseValues(const double* y, std::size_t count, T* values) const;

  /// f(high) - f(low): what a relative error bound is relative to. 0 for an empty range.
  double TransformedWidth(const ValueRange& range) const;

  /// The most that rounding to the type moves a value of the range in the transformed domain (half
  /// a unit in the last place, one half for integers, at the steepest place): what the codec has to
  /// take off the bound before it chooses its step. At least that, and not more than 4 times that.
  double OutputRounding(ScalarType type, const ValueRange& range) const;

private:
  TransformKind Map = TransformKind::Uniform;
  double ScaleOfAsinh = 1.0;
  std::shared_ptr<const MonotoneTable> Knotted; ///< of the kind Table
};

/// The T next to a double. Real types: as static_cast. Integer types: rounded to the nearest
/// (halves up) and clamped to the type; NaN gives 0.
template <class T>
T ValueFromReal(double x);

} // namespace banyan

#endif
