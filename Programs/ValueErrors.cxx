// SPDX-License-Identifier: BSD-3-Clause
#include "ValueErrors.h"

#include "Base/Bytes.h"
#include "Base/ThreadPool.h"
#include "Series/Quantize/FillValues.h"
#include "Series/Quantize/ValueArithmetic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace banyan
{
namespace
{

// Values that a thread takes at a time; sums are made per part, in their order.
constexpr std::int64_t PartValues = 1 << 16;

constexpr double Infinity = std::numeric_limits<double>::infinity();

template <class T>
bool Within(T original, T decoded, double bound)
{
  if constexpr (std::is_integral_v<T>)
  {
    const std::uint64_t a = static_cast<std::uint64_t>(original);
    const std::uint64_t b = static_cast<std::uint64_t>(decoded);
    // A long double holds all 64 bits, and the bound.
    return static_cast<long double>(original > decoded ? a - b : b - a) <=
           static_cast<long double>(bound);
  }
  else
  {
    // Far from the bound rounding does not matter, and doubles are several times faster.
    const double difference =
      std::abs(static_cast<double>(original) - static_cast<double>(decoded));
    return difference < bound * (1.0 - 1e-12) ||
           std::abs(static_cast<long double>(original) - static_cast<long double>(decoded)) <=
             static_cast<long double>(bound);
  }
}

template <class T>
bool IsFinite(T value)
{
  return !std::is_floating_point_v<T> || std::isfinite(static_cast<double>(value));
}

/// Compares the values of a part.
template <class T>
class PartComparison
{
public:
  PartComparison(const Judgement& judgement, const T* original, std::size_t stride,
    const T* decoded, std::int64_t count, const std::uint8_t* hidden)
    : Rule(judgement)
    , Original(original)
    , Stride(stride)
    , Decoded(decoded)
    , Count(count)
    , Hidden(hidden)
    , Fills(judgement.FillValues)
  {
  }

  ValueErrors Run()
  {
    const ValueClasses& classes = this->Rule.Classes;
    this->TransformValues();
    for (std::int64_t i = 0; i < this->Count; ++i)
    {
      const std::size_t at = static_cast<std::size_t>(i);
      const T original = this->Original[at * this->Stride];
      if (IsFinite(original) && (this->Hidden == nullptr || this->Hidden[at] == 0))
      {
        this->AddFinite(i, original, this->Decoded[at]);
        this->Errors.OtherClass += classes.ClassOf(static_cast<double>(original)) !=
                                       classes.ClassOf(static_cast<double>(this->Decoded[at]))
                                     ? 1
                                     : 0;
      }
      else
      {
        this->AddNonFinite(i, original, this->Decoded[at]);
      }
    }
    return this->Errors;
  }

private:
  /// Nothing to do without a transform.
  void TransformValues()
  {
    if (this->Rule.Map.IsIdentity())
    {
      return;
    }
    const std::size_t count = static_cast<std::size_t>(this->Count);
    std::vector<T> packed(count);
    for (std::size_t i = 0; i < count; ++i)
    {
      packed[i] = this->Original[i * this->Stride];
    }
    this->OriginalMapped.resize(count);
    this->DecodedMapped.resize(count);
    this->Rule.Map.ForwardValues(packed.data(), count, this->OriginalMapped.data());
    this->Rule.Map.ForwardValues(this->Decoded, count, this->DecodedMapped.data());
  }

  void AddFill(std::int64_t number, T original, T decoded)
  {
    ++this->Errors.Fill;
    if (std::memcmp(&original, &decoded, sizeof(T)) != 0)
    {
      ++this->Errors.OutOfBound;
      this->Blame(number, Infinity);
    }
  }

  void AddFinite(std::int64_t number, T original, T decoded)
  {
    ++this->Errors.Finite;
    if (this->Fills.Holds(original))
    {
      this->AddFill(number, original, decoded);
      return;
    }
    this->Errors.Range.Include({ DoubleNotAbove(original), DoubleNotBelow(original) });
    if (!IsFinite(decoded))
    {
      ++this->Errors.OutOfBound;
      this->Errors.Greatest = Infinity;
      this->Errors.GreatestJudged = Infinity;
      this->Blame(number, Infinity);
      return;
    }
    const double error = Difference(original, decoded);
    double judged = error;
    bool within = false;
    if (this->OriginalMapped.empty())
    {
      within = Within(original, decoded, this->Rule.Bound);
    }
    else
    {
      const std::size_t at = static_cast<std::size_t>(number);
      judged = std::abs(this->DecodedMapped[at] - this->OriginalMapped[at]);
      within = judged <= this->Rule.Bound;
    }
    const double before = static_cast<double>(original);
    const double after = static_cast<double>(decoded);
    const bool unseen =
      !within && this->Rule.Invisible.Invisible(std::min(before, after), std::max(before, after));
    if (unseen)
    {
      ++this->Errors.Invisible;
      judged = 0.0;
    }
    else
    {
      this->Errors.OutOfBound += within ? 0 : 1;
      this->Errors.GreatestJudged = std::max(this->Errors.GreatestJudged, judged);
      this->Errors.Greatest = std::max(this->Errors.Greatest, error);
    }
    this->Errors.SumSquared += error * error;
    if (error > 0.0)
    {
      const double opacity =
        this->Rule.Opacity ? (*this->Rule.Opacity)(static_cast<double>(original)) : 1.0;
      this->Errors.SumWeighted += opacity * error * error;
    }
    this->Blame(number, judged);
  }

  void AddNonFinite(std::int64_t number, T original, T decoded)
  {
    ++this->Errors.NonFinite;
    if (std::memcmp(&original, &decoded, sizeof(T)) != 0)
    {
      ++this->Errors.NonFiniteChanged;
      this->Blame(number, Infinity);
    }
  }

  void Blame(std::int64_t number, double error)
  {
    if (error > this->Errors.WorstError)
    {
      this->Errors.Worst = number;
      this->Errors.WorstError = error;
    }
  }

  const Judgement& Rule;
  const T* Original;
  std::size_t Stride;
  const T* Decoded;
  std::int64_t Count;
  const std::uint8_t* Hidden;
  FillSet<T> Fills;
  std::vector<double> OriginalMapped; ///< empty without a transform
  std::vector<double> DecodedMapped;
  ValueErrors Errors;
};

} // namespace

ValueClasses::ValueClasses(const ValueRange& range)
  : HalfLow(0.5 * range.Low)
{
  const double half = range.Empty() ? 0.0 : 0.5 * range.High - 0.5 * range.Low;
  const double width = half / 256.0;
  this->ClassesPerHalf = width > 0.0 ? 1.0 / width : 0.0;
}

void ValueErrors::Merge(const ValueErrors& other, std::int64_t first)
{
  this->Finite += other.Finite;
  this->NonFinite += other.NonFinite;
  this->NonFiniteChanged += other.NonFiniteChanged;
  this->OutOfBound += other.OutOfBound;
  this->Fill += other.Fill;
  this->Invisible += other.Invisible;
  this->OtherClass += other.OtherClass;
  this->Greatest = std::max(this->Greatest, other.Greatest);
  this->GreatestJudged = std::max(this->GreatestJudged, other.GreatestJudged);
  this->SumSquared += other.SumSquared;
  this->SumWeighted += other.SumWeighted;
  this->Range.Include(other.Range);
  if (other.WorstError > this->WorstError)
  {
    this->Worst = first + other.Worst;
    this->WorstError = other.WorstError;
  }
}

double ValueErrors::MeanSquared() const
{
  return this->Finite > 0 ? this->SumSquared / static_cast<double>(this->Finite) : 0.0;
}

double ValueErrors::Weighted() const
{
  return this->Finite > 0 ? this->SumWeighted / static_cast<double>(this->Finite) : 0.0;
}

double ValueErrors::Rmse() const
{
  return std::sqrt(this->MeanSquared());
}

double ValueErrors::OtherClassShare() const
{
  return this->Finite > 0
           ? static_cast<double>(this->OtherClass) / static_cast<double>(this->Finite)
           : 0.0;
}

ValueErrors CompareValues(ScalarType type, const void* original, int stride, const void* decoded,
  std::int64_t count, const Judgement& judgement, ThreadPool& pool)
{
  std::vector<ValueErrors> parts(static_cast<std::size_t>((count + PartValues - 1) / PartValues));
  Dispatch(type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      pool.ParallelFor(static_cast<std::int64_t>(parts.size()),
        [&](std::int64_t part)
        {
          const std::int64_t first = part * PartValues;
          parts[static_cast<std::size_t>(part)] = PartComparison<T>(judgement,
            static_cast<const T*>(original) + first * stride, static_cast<std::size_t>(stride),
            static_cast<const T*>(decoded) + first, std::min(PartValues, count - first),
            judgement.Hidden != nullptr ? judgement.Hidden + first : nullptr)
                                                    .Run();
        });
    });
  ValueErrors errors;
  for (std::size_t part = 0; part < parts.size(); ++part)
  {
    errors.Merge(parts[part], static_cast<std::int64_t>(part) * PartValues);
  }
  return errors;
}

} // namespace banyan
