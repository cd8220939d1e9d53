#include "Render/BrickMarcher.h"

#include "Render/PartialMarcher.h"

namespace banyan
{
namespace
{

/// One sample after the other.
template <class T>
class PlainMarcher : public PartialMarcher<T>
{
public:
  PlainMarcher(const BrickPart& part, const StepTable& table, bool relative, float limit)
    : PartialMarcher<T>(part.View, part.Corner, table, relative)
    , Cells(part.Cells)
    , Steps(table.Steps())
    , Limit(limit)
  {
  }

  /// @return samples taken
  std::int32_t MarchRay(const RaySamples& ray, glm::vec4& pixel) const
  {
    std::int32_t taken = 0;
    if (ray.Head.Fraction > 0.0f && this->Cells.Contains(ray.Head.Position))
    {
      this->March(ray.Head, pixel);
      ++taken;
    }
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
    if (ray.Tail.Fraction > 0.0f && this->Cells.Contains(ray.Tail.Position) &&
        pixel.a > this->Limit)
    {
      this->March(ray.Tail, pixel);
      ++taken;
    }
    return taken;
  }

private:
  /// Whole samples [begin, end) of a ray, all inside the cells, at least one.
  /// @return samples taken
  std::int32_t MarchWhole(
    const RaySamples& ray, std::int32_t begin, std::int32_t end, glm::vec4& pixel) const
  {
    std::int64_t position[3];
    ray.PositionOf(begin, position);
    this->MoveToBrick(position);
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

  FixedBox Cells;
  const glm::vec4* Steps;
  float Limit;
};

template <class T>
void MarchRays(const PlainMarcher<T>& marcher, const PixelRect& rect, RayTile& tile)
{
  const float limit = tile.TransmittanceLimit;
  for (int y = rect.Lo.y; y < rect.Hi.y; ++y)
  {
    for (int x = rect.Lo.x; x < rect.Hi.x; ++x)
    {
      const int slot = tile.SlotOf(x, y);
      if (!tile.IsEmpty(slot) && tile.Transmittance[slot] > limit)
      {
        glm::vec4 pixel = tile.PixelOf(slot);
        tile.SamplesTaken += marcher.MarchRay(tile.RayOf(slot), pixel);
        tile.ActiveRays -= pixel.a > limit ? 0 : 1;
        tile.SetPixel(slot, pixel);
      }
    }
  }
}

} // namespace

void MarchBrick(
  const BrickPart& part, const StepTable& table, const PixelRect& pixels, RayTile& tile)
{
  Dispatch(part.View.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const PlainMarcher<T> marcher(part, table, IsRelative<T>, tile.TransmittanceLimit);
      MarchRays(marcher, Intersection(pixels, tile.Rect), tile);
    });
}

void MarchUnpacked(const PackedBrick& brick, const BrickVisibility& seen, const StepTable& table,
  const PixelRect& pixels, RayTile& tile)
{
  const BrickView view = brick.View();
  const PlainMarcher<float> marcher(
    { view, brick.Corner(), seen.Cells }, table, brick.Relative(), tile.TransmittanceLimit);
  MarchRays(marcher, Intersection(pixels, tile.Rect), tile);
}

} // namespace banyan
