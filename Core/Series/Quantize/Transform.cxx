// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Quantize/Transform.h"

#include "Base/Error.h"
#include "Base/ForEachScalarType.h"
#include "Series/Quantize/AsinhMath.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace banyan
{

namespace
{

/// Values that are transformed at a time, so that those on the way stay in the first-level cache.
constexpr std::size_t Chunk = 512;

/// Half the distance of two neighbours of a type around a magnitude.
double HalfUnit(ScalarType type, double magnitude)
{
  if (type == ScalarType::Float32)
  {
    const float m = static_cast<float>(std::min(magnitude, 0x1p127));
    const float next = std::nextafter(m, std::numeric_limits<float>::infinity());
    return 0.5 * (static_cast<double>(next) - static_cast<double>(m));
  }
  if (type == ScalarType::Float64)
  {
    const double m = std::min(magnitude, 0x1p1023);
    // Half of the least distance is none: a whole one then.
    return std::max(0.5 * (std::nextafter(m, std::numeric_limits<double>::infinity()) - m),
      std::numeric_limits<double>::denorm_min());
  }
  return 0.5;
}

double GreatestMagnitude(double low, double high)
{
  return std::max(std::abs(low), std::abs(high));
}

double LeastMagnitude(double low, double high)
{
  return low <= 0 && high >= 0 ? 0.0 : std::min(std::abs(low), std::abs(high));
}

double RoundingOfAsinh(ScalarType type, const ValueRange& range, double scale)
{
  // The slope is 1 / hypot(x, scale). Times a unit of a real type, which grows as |x| does, it is
  // greatest at the greatest magnitude; times a constant unit, at the least.
  const double greatest = GreatestMagnitude(range.Low, range.High);
  const double least = LeastMagnitude(range.Low, range.High);
  const double flat = HalfUnit(type, least) / std::hypot(least, scale);
  const bool real = type == ScalarType::Float32 || type == ScalarType::Float64;
  // Twice, because a unit lies between one and two times what is proportional to |x|.
  return real ? flat + 2.0 * HalfUnit(type, greatest) / std::hypot(greatest, scale) : flat;
}

double RoundingOfTable(ScalarType type, const ValueRange& range, const PiecewiseLinear& forward)
{
  const auto& segments = forward.GetSegments();
  double rounding = 0.0;
  for (std::size_t j = 0; j < segments.size(); ++j)
  {
    const double start = j == 0 ? range.Low : std::max(segments[j].Argument, range.Low);
    const double end =
      j + 1 == segments.size() ? range.High : std::min(segments[j + 1].Argument, range.High);
    if (start <= end)
    {
      rounding =
        std::max(rounding, segments[j].Slope * HalfUnit(type, GreatestMagnitude(start, end)));
    }
  }
  return rounding;
}

} // namespace

Transform Transform::Asinh(double scale)
{
  if (!(scale >= 0x1p-1000) || !(scale <= 0x1p1000))
  {
    throw Error("The scale of an asinh transform must lie within 2^-1000 and 2^1000");
  }
  Transform transform;
  transform.Map = TransformKind::Asinh;
  transform.ScaleOfAsinh = scale;
  return transform;
}

Transform Transform::Table(std::vector<TransformKnot> knots)
{
  Transform transform;
  transform.Map = TransformKind::Table;
  transform.Knotted = std::make_shared<const MonotoneTable>(std::move(knots));
  return transform;
}

const std::vector<TransformKnot>& Transform::Knots() const
{
  static const std::vector<TransformKnot> none;
  return this->Knotted ? this->Knotted->Knots() : none;
}

bool Transform::operator==(const Transform& other) const
{
  const auto& a = this->Knots();
  const auto& b = other.Knots();
  return this->Map == other.Map && this->ScaleOfAsinh == other.ScaleOfAsinh &&
         std::equal(a.begin(), a.end(), b.begin(), b.end(),
           [](const TransformKnot& p, const TransformKnot& q) { return p.X == q.X && p.Y == q.Y; });
}

double Transform::Forward(double x) const
{
  switch (this->Map)
  {
    case TransformKind::Asinh:
      return asinh_math::ForwardOfAny(x, this->ScaleOfAsinh);
    case TransformKind::Table:
      return this->Knotted->Forward()(x);
    default:
      return x;
  }
}

double Transform::Inverse(double y) const
{
  switch (this->Map)
  {
    case TransformKind::Asinh:
      return asinh_math::Inverse(y, this->ScaleOfAsinh);
    case TransformKind::Table:
      return this->Knotted->Inverse()(y);
    default:
      return y;
  }
}

void Transform::Forward(const double* x, std::size_t count, double* y) const
{
  switch (this->Map)
  {
    case TransformKind::Asinh:
      asinh_math::Forward(x, count, this->ScaleOfAsinh, y);
      break;
    case TransformKind::Table:
      this->Knotted->Forward().Apply(x, count, y);
      break;
    default:
      std::copy(x, x + count, y);
  }
}

void Transform::Inverse(const double* y, std::size_t count, double* x) const
{
  switch (this->Map)
  {
    case TransformKind::Asinh:
      asinh_math::Inverse(y, count, this->ScaleOfAsinh, x);
      break;
    case TransformKind::Table:
      this->Knotted->Inverse().Apply(y, count, x);
      break;
    default:
      std::copy(y, y + count, x);
  }
}

template <class T>
void Transform::ForwardValues(const T* values, std::size_t count, double* y) const
{
  for (std::size_t i = 0; i < count; ++i)
  {
    y[i] = static_cast<double>(values[i]);
  }
  if (!this->IsIdentity())
  {
    this->Forward(y, count, y);
  }
}

template <class T>
void Transform::InverseValues(const double* y, std::size_t count, T* values) const
{
  double x[Chunk];
  for (std::size_t start = 0; start < count; start += Chunk)
  {
    const std::size_t some = std::min(Chunk, count - start);
    this->Inverse(y + start, some, x);
    for (std::size_t i = 0; i < some; ++i)
    {
      values[start + i] = ValueFromReal<T>(x[i]);
    }
  }
}

double Transform::TransformedWidth(const ValueRange& range) const
{
  return range.Empty() ? 0.0 : this->Forward(range.High) - this->Forward(range.Low);
}

double Transform::OutputRounding(ScalarType type, const ValueRange& range) const
{
  if (range.Empty())
  {
    return 0.0;
  }
  switch (this->Map)
  {
    case TransformKind::Asinh:
      return RoundingOfAsinh(type, range, this->ScaleOfAsinh);
    case TransformKind::Table:
      return RoundingOfTable(type, range, this->Knotted->Forward());
    default:
      return HalfUnit(type, GreatestMagnitude(range.Low, range.High));
  }
}

template <class T>
T ValueFromReal(double x)
{
  if constexpr (std::is_floating_point_v<T>)
  {
    return static_cast<T>(x);
  }
  else
  {
    constexpr double low = static_cast<double>(std::numeric_limits<T>::lowest());
    // The greatest 64-bit integers are no doubles; the power of two above them is.
    constexpr double above = 2.0 * static_cast<double>(std::numeric_limits<T>::max() / 2 + 1);
    const double down = std::floor(x);
    const double nearest = x - down >= 0.5 ? down + 1.0 : down;
    if (!(nearest >= low))
    {
      return x != x ? T(0) : std::numeric_limits<T>::lowest();
    }
    return nearest < above ? static_cast<T>(nearest) : std::numeric_limits<T>::max();
  }
}

#define BANYAN_INSTANTIATE(T)                                                                      \
  template void Transform::ForwardValues<T>(const T*, std::size_t, double*) const;                 \
  template void Transform::InverseValues<T>(const double*, std::size_t, T*) const;                 \
  template T ValueFromReal<T>(double)
BANYAN_FOR_EACH_SCALAR_TYPE(BANYAN_INSTANTIATE);
#undef BANYAN_INSTANTIATE

} // namespace banyan
