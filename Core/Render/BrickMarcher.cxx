#include "Render/BrickMarcher.h"

#include <cmath>
#include <type_traits>

namespace banyan
{
namespace
{

/// Types that float cannot hold exactly are taken relative to the table's low end, in double,
/// before they become float: data with a large offset keep all their digits.
template <class T>
constexpr bool IsRelative = sizeof(T) >= 4 && !std::is_same_v<T, float>;

/// Values this far outside a table may as well be here: keeps differences finite in float.
constexpr double FarAway = 1e30;

template <class T>
inline float Corner(T value, [[maybe_unused]] double low)
{
  if constexpr (!IsRelative<T>)
  {
    return static_cast<float>(value);
  }
  else
  {
    double relative = static_cast<double>(value) - low;
    if constexpr (std::is_same_v<T, double>)
    {
      if (!(std::abs(relative) < FarAway))
      {
        relative = std::isfinite(value) ? std::copysign(FarAway, relative)
                                        : std::numeric_limits<double>::quiet_NaN();
      }
    }
    return static_cast<float>(relative);
  }
}

inline float Mix(float a, float b, float part)
{
  return a + part * (b - a);
}

/// What stays the same over all rays of a brick.
template <class T>
struct Marcher
{
  const T* Values;
  std::ptrdiff_t Stride[3];
  std::int64_t Corner[3]; ///< fixed-point position of Values[0]
  FixedBox Cells;
  const StepTable& Table;
  const glm::vec4* Entries;
  double Low;
  float Limit;

  Marcher(const BrickPart& part, const StepTable& table, float limit)
    : Values(static_cast<const T*>(part.View.Values))
    , Cells(part.Cells)
    , Table(table)
    , Entries(table.Data())
    , Low(table.Low())
    , Limit(limit)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Stride[axis] = part.View.Stride[axis];
      this->Corner[axis] = ToFixed(part.Corner[axis]);
    }
  }

  /// Number of the table entry at a position relative to the brick's corner.
  int Sample(std::int64_t x, std::int64_t y, std::int64_t z) const
  {
    const std::ptrdiff_t sx = this->Stride[0];
    const std::ptrdiff_t sy = this->Stride[1];
    const std::ptrdiff_t sz = this->Stride[2];
    const T* p =
      this->Values + (x >> FractionBits) * sx + (y >> FractionBits) * sy + (z >> FractionBits) * sz;
    const float fx = Fraction(x);
    const float fy = Fraction(y);
    const float fz = Fraction(z);
    const auto at = [this, p](std::ptrdiff_t offset)
    { return banyan::Corner<T>(p[offset], this->Low); };
    const float z00 = Mix(at(0), at(sz), fz);
    const float z10 = Mix(at(sx), at(sx + sz), fz);
    const float z01 = Mix(at(sy), at(sy + sz), fz);
    const float z11 = Mix(at(sx + sy), at(sx + sy + sz), fz);
    const float value = Mix(Mix(z00, z01, fy), Mix(z10, z11, fy), fx);
    if constexpr (IsRelative<T>)
    {
      return this->Table.IndexOfRelative(value);
    }
    else
    {
      return this->Table.IndexOf(value);
    }
  }

  /// The upper 24 bits below the point, so that the fraction is exact in float and below 1.
  static float Fraction(std::int64_t position)
  {
    const auto bits = static_cast<std::int32_t>((position >> (FractionBits - 24)) & 0xFFFFFF);
    return static_cast<float>(bits) * (1.0f / 16777216.0f);
  }

  void Blend(const glm::vec4& entry, glm::vec4& pixel) const
  {
    const float transmittance = pixel.a;
    pixel.r += transmittance * entry.r;
    pixel.g += transmittance * entry.g;
    pixel.b += transmittance * entry.b;
    pixel.a = transmittance * (1.0f - entry.a);
  }

  /// @return samples taken
  std::int32_t March(const RaySamples& ray, glm::vec4& pixel) const
  {
    std::int32_t taken = this->MarchPartial(ray.Head, pixel);
    std::int32_t begin = 0;
    std::int32_t end = 0;
    if (ray.Count > 0)
    {
      ray.SamplesIn(this->Cells, begin, end);
    }
    if (begin < end && pixel.a > this->Limit)
    {
      taken += this->MarchWhole(ray, begin, end, pixel);
    }
    if (pixel.a > this->Limit)
    {
      taken += this->MarchPartial(ray.Tail, pixel);
    }
    return taken;
  }

  std::int32_t MarchWhole(
    const RaySamples& ray, std::int32_t begin, std::int32_t end, glm::vec4& result) const
  {
    std::int64_t x = ray.Base[0] + begin * ray.Step[0] - this->Corner[0];
    std::int64_t y = ray.Base[1] + begin * ray.Step[1] - this->Corner[1];
    std::int64_t z = ray.Base[2] + begin * ray.Step[2] - this->Corner[2];
    glm::vec4 pixel = result;
    std::int32_t sample = begin;
    do
    {
      this->Blend(this->Entries[this->Sample(x, y, z)], pixel);
      x += ray.Step[0];
      y += ray.Step[1];
      z += ray.Step[2];
      ++sample;
    } while (sample < end && pixel.a > this->Limit);
    result = pixel;
    return sample - begin;
  }

  std::int32_t MarchPartial(const PartialSample& sample, glm::vec4& pixel) const
  {
    if (sample.Fraction == 0.0f || !this->Cells.Contains(sample.Position))
    {
      return 0;
    }
    const int index = this->Sample(sample.Position[0] - this->Corner[0],
      sample.Position[1] - this->Corner[1], sample.Position[2] - this->Corner[2]);
    this->Blend(this->Table.Partial(index, sample.Fraction), pixel);
    return 1;
  }
};

} // namespace

void MarchBrick(
  const BrickPart& part, const StepTable& table, const PixelRect& pixels, RayTile& tile)
{
  const PixelRect rect = Intersection(pixels, tile.Rect);
  Dispatch(part.View.Type,
    [&](auto tag)
    {
      const Marcher<typename decltype(tag)::Type> marcher(part, table, tile.TransmittanceLimit);
      const int width = tile.Rect.Size().x;
      for (int y = rect.Lo.y; y < rect.Hi.y; ++y)
      {
        const RaySamples* rays = &tile.Rays[static_cast<std::size_t>(y - tile.Rect.Lo.y) * width];
        for (int x = rect.Lo.x; x < rect.Hi.x; ++x)
        {
          const RaySamples& ray = rays[x - tile.Rect.Lo.x];
          glm::vec4& pixel = tile.Picture->At(x, y);
          if (!ray.Empty() && pixel.a > tile.TransmittanceLimit)
          {
            tile.SamplesTaken += marcher.March(ray, pixel);
            tile.ActiveRays -= pixel.a > tile.TransmittanceLimit ? 0 : 1;
          }
        }
      }
    });
}

} // namespace banyan
