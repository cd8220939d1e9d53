#include "Render/BrickMarcher.h"

#include "Render/BlockInterpolator.h"

#include <algorithm>

namespace banyan
{
namespace
{

/// What all marchers of a brick share, whatever the type of its values.
class MarcherBase
{
public:
  MarcherBase(const BrickPart& part, const StepTable& table, bool relative, float limit)
    : Table(table)
    , Lookup(relative ? table.RelativeLookup() : table.Lookup())
    , Steps(table.Steps())
    , Limit(limit)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Corner[axis] = ToFixed(part.Corner[axis]);
    }
  }

protected:
  void ToBrick(std::int64_t (&position)[3]) const
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      position[axis] -= this->Corner[axis];
    }
  }

  std::int64_t Corner[3]; ///< fixed-point position of the brick's first sample
  const StepTable& Table;
  TableLookup Lookup;
  const glm::vec4* Steps;
  float Limit;
};

/// One sample after the other.
template <class T>
class PlainMarcher : public MarcherBase
{
public:
  PlainMarcher(const BrickPart& part, const StepTable& table, float limit)
    : MarcherBase(part, table, IsRelative<T>, limit)
    , Values(part.View, table.Low())
  {
  }

  /// Whole samples [begin, end) of a ray, all inside the cells, at least one.
  /// @return samples taken
  std::int32_t MarchWhole(
    const RaySamples& ray, std::int32_t begin, std::int32_t end, glm::vec4& pixel) const
  {
    std::int64_t position[3];
    ray.PositionOf(begin, position);
    this->ToBrick(position);
    std::int32_t sample = begin;
    do
    {
      const glm::vec4& step = this->Steps[this->Lookup.IndexOf(this->Values.At(position))];
      pixel.r += pixel.a * step.r;
      pixel.g += pixel.a * step.g;
      pixel.b += pixel.a * step.b;
      pixel.a *= step.a;
      for (int axis = 0; axis < 3; ++axis)
      {
        position[axis] += ray.Step[axis];
      }
      ++sample;
    } while (sample < end && pixel.a > this->Limit);
    return sample - begin;
  }

  /// A head or tail that lies in the cells.
  void MarchPartial(const PartialSample& sample, glm::vec4& pixel) const
  {
    std::int64_t position[3] = { sample.Position[0], sample.Position[1], sample.Position[2] };
    this->ToBrick(position);
    const int index = this->Lookup.IndexOf(this->Values.At(position));
    const glm::vec4 entry = this->Table.Partial(index, sample.Fraction);
    pixel.r += pixel.a * entry.r;
    pixel.g += pixel.a * entry.g;
    pixel.b += pixel.a * entry.b;
    pixel.a *= 1.0f - entry.a;
  }

private:
  PlainInterpolator<T> Values;
};

#if BANYAN_HAS_BLOCKS

/// Four samples at a time; the picture is that of PlainMarcher, bit for bit.
template <class T, bool Pairs>
class BlockMarcher : public PlainMarcher<T>
{
public:
  BlockMarcher(const BrickPart& part, const StepTable& table, float limit)
    : PlainMarcher<T>(part, table, limit)
    , Values(part.View, table.Low())
  {
  }

  std::int32_t MarchWhole(
    const RaySamples& ray, std::int32_t begin, std::int32_t end, glm::vec4& pixel) const
  {
    std::int64_t start[3];
    ray.PositionOf(begin, start);
    this->ToBrick(start);
    PositionBlock block(start, ray.Step, std::min(4, end - begin));
    __m128i stride[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      stride[axis] = _mm_set1_epi64x(4 * ray.Step[axis]);
    }
    __m128 color = _mm_loadu_ps(&pixel.r);
    __m128 transmittance = _mm_set1_ps(pixel.a);
    // The next block is on its way while one is blended: the processor looks only so far ahead.
    __m128i next = this->IndicesOf(this->Values.At(block));
    std::int32_t sample = begin;
    while (true)
    {
      const __m128i indices = next;
      const int count = std::min(4, end - sample);
      const int left = end - sample - count;
      if (left >= 4)
      {
        for (int axis = 0; axis < 3; ++axis)
        {
          block.Axis[axis][0] = _mm_add_epi64(block.Axis[axis][0], stride[axis]);
          block.Axis[axis][1] = _mm_add_epi64(block.Axis[axis][1], stride[axis]);
        }
        next = this->IndicesOf(this->Values.At(block));
      }
      else if (left > 0)
      {
        ray.PositionOf(sample + count, start);
        this->ToBrick(start);
        next = this->IndicesOf(this->Values.At(PositionBlock(start, ray.Step, left)));
      }
      const int taken = this->Blend(indices, count, color, transmittance);
      sample += taken;
      if (left == 0 || taken < count || !(_mm_cvtss_f32(transmittance) > this->Limit))
      {
        break;
      }
    }
    _mm_storeu_ps(&pixel.r, color);
    pixel.a = _mm_cvtss_f32(transmittance);
    return sample - begin;
  }

private:
  /// The first `count` entries blended behind, until the limit. @return entries taken
  int Blend(__m128i indices, int count, __m128& color, __m128& transmittance) const
  {
    alignas(16) std::int32_t index[4];
    _mm_store_si128(reinterpret_cast<__m128i*>(index), indices);
    if (count == 4)
    {
      const __m128 a = this->StepOf(index[0]);
      const __m128 b = this->StepOf(index[1]);
      const __m128 c = this->StepOf(index[2]);
      const __m128 d = this->StepOf(index[3]);
      const __m128 afterA = _mm_mul_ps(transmittance, _mm_shuffle_ps(a, a, 0xFF));
      const __m128 afterB = _mm_mul_ps(afterA, _mm_shuffle_ps(b, b, 0xFF));
      const __m128 afterC = _mm_mul_ps(afterB, _mm_shuffle_ps(c, c, 0xFF));
      const __m128 afterD = _mm_mul_ps(afterC, _mm_shuffle_ps(d, d, 0xFF));
      // Transmittance never grows: when the last is above the limit, all are.
      if (_mm_cvtss_f32(afterD) > this->Limit)
      {
        color = _mm_add_ps(color, _mm_mul_ps(transmittance, a));
        color = _mm_add_ps(color, _mm_mul_ps(afterA, b));
        color = _mm_add_ps(color, _mm_mul_ps(afterB, c));
        color = _mm_add_ps(color, _mm_mul_ps(afterC, d));
        transmittance = afterD;
        return 4;
      }
    }
    int taken = 0;
    do
    {
      const __m128 step = this->StepOf(index[taken]);
      color = _mm_add_ps(color, _mm_mul_ps(transmittance, step));
      transmittance = _mm_mul_ps(transmittance, _mm_shuffle_ps(step, step, 0xFF));
      ++taken;
    } while (taken < count && _mm_cvtss_f32(transmittance) > this->Limit);
    return taken;
  }

  __m128 StepOf(std::int32_t index) const { return _mm_loadu_ps(&this->Steps[index].r); }

  /// TableLookup::IndexOf for four values.
  __m128i IndicesOf(__m128 values) const
  {
    const TableLookup& lookup = this->Lookup;
    const __m128 offset = _mm_sub_ps(values, _mm_set1_ps(lookup.Low));
    const __m128 position =
      _mm_add_ps(_mm_mul_ps(offset, _mm_set1_ps(lookup.Scale)), _mm_set1_ps(lookup.Bias));
    // The maximum with a NaN is its second operand.
    const __m128 notBelow = _mm_max_ps(position, _mm_setzero_ps());
    const __m128i index = _mm_cvttps_epi32(_mm_min_ps(notBelow, _mm_set1_ps(lookup.Last)));
    const __m128 largest = _mm_set1_ps(std::numeric_limits<float>::max());
    const __m128i finite = _mm_castps_si128(_mm_and_ps(
      _mm_cmple_ps(values, largest), _mm_cmpge_ps(values, _mm_sub_ps(_mm_setzero_ps(), largest))));
    return _mm_or_si128(
      _mm_and_si128(finite, index), _mm_andnot_si128(finite, _mm_set1_epi32(lookup.Transparent)));
  }

  BlockInterpolator<T, Pairs> Values;
};

#endif

/// @return samples taken
template <class Marcher>
std::int32_t MarchRay(const Marcher& marcher, const FixedBox& cells, float limit,
  const RaySamples& ray, glm::vec4& pixel)
{
  std::int32_t taken = 0;
  if (ray.Head.Fraction > 0.0f && cells.Contains(ray.Head.Position))
  {
    marcher.MarchPartial(ray.Head, pixel);
    ++taken;
  }
  std::int32_t begin = 0;
  std::int32_t end = 0;
  if (ray.Count > 0)
  {
    ray.SamplesIn(cells, begin, end);
  }
  if (begin < end && pixel.a > limit)
  {
    taken += marcher.MarchWhole(ray, begin, end, pixel);
  }
  if (ray.Tail.Fraction > 0.0f && cells.Contains(ray.Tail.Position) && pixel.a > limit)
  {
    marcher.MarchPartial(ray.Tail, pixel);
    ++taken;
  }
  return taken;
}

template <class Marcher>
void MarchRays(const BrickPart& part, const StepTable& table, const PixelRect& rect, RayTile& tile)
{
  const float limit = tile.TransmittanceLimit;
  const Marcher marcher(part, table, limit);
  const FixedBox cells(part.Cells);
  const int width = tile.Rect.Size().x;
  for (int y = rect.Lo.y; y < rect.Hi.y; ++y)
  {
    const RaySamples* rays = &tile.Rays[static_cast<std::size_t>(y - tile.Rect.Lo.y) * width];
    for (int x = rect.Lo.x; x < rect.Hi.x; ++x)
    {
      const RaySamples& ray = rays[x - tile.Rect.Lo.x];
      glm::vec4& pixel = tile.Picture->At(x, y);
      if (!ray.Empty() && pixel.a > limit)
      {
        tile.SamplesTaken += MarchRay(marcher, cells, limit, ray, pixel);
        tile.ActiveRays -= pixel.a > limit ? 0 : 1;
      }
    }
  }
}

/// Picks the fastest marcher that can read the brick.
template <class T>
void MarchTyped(const BrickPart& part, const StepTable& table, const PixelRect& rect, RayTile& tile)
{
#if BANYAN_HAS_BLOCKS
  if constexpr (!IsRelative<T>)
  {
    if (BlockInterpolator<T, true>::CanRead(part.View))
    {
      return MarchRays<BlockMarcher<T, true>>(part, table, rect, tile);
    }
  }
  if (BlockInterpolator<T, false>::CanRead(part.View))
  {
    return MarchRays<BlockMarcher<T, false>>(part, table, rect, tile);
  }
#endif
  MarchRays<PlainMarcher<T>>(part, table, rect, tile);
}

} // namespace

void MarchBrick(
  const BrickPart& part, const StepTable& table, const PixelRect& pixels, RayTile& tile)
{
  const PixelRect rect = Intersection(pixels, tile.Rect);
  Dispatch(part.View.Type,
    [&](auto tag) { MarchTyped<typename decltype(tag)::Type>(part, table, rect, tile); });
}

} // namespace banyan
