// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Raycast/BrickProjector.h"

#include "Render/Bricks/Interpolators.h"

namespace banyan
{
namespace
{

/// One sample after the other.
template <class T>
class PlainProjector
{
public:
  /// @param relative whether values become relative to the table's low end, or are already
  PlainProjector(
    const BrickPart& part, const ProjectionTable& table, bool relative, const RayTile& tile)
    : Table(table)
    , Scale(table.ScaleOf(relative))
    , Values(part.View, table.Low(), table.Nearest())
    , Hidden(part.Hidden)
    , Cells(part.Cells, tile.CellShift - tile.BrickShift)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Corner[axis] = ToFixed(part.Corner[axis]);
    }
  }

  /// @return samples taken
  std::int32_t ProjectRay(const RaySamples& ray, glm::vec4& pixel) const
  {
    std::int32_t taken = this->ProjectEnd(ray.Head, pixel);
    std::int32_t begin = 0;
    std::int32_t end = 0;
    if (ray.Count > 0)
    {
      ray.SamplesIn(this->Cells, begin, end);
    }
    for (std::int32_t sample = begin; sample < end; ++sample, ++taken)
    {
      std::int64_t position[3];
      ray.PositionOf(sample, position);
      float counted;
      const float met = this->At(position, counted);
      if (this->Table.Averages())
      {
        pixel.r += met;
        pixel.g += counted;
      }
      else
      {
        pixel.r = met > pixel.r ? met : pixel.r;
      }
    }
    return taken + this->ProjectEnd(ray.Tail, pixel);
  }

private:
  /// A head or tail, if it lies in the cells.
  std::int32_t ProjectEnd(const PartialSample& sample, glm::vec4& pixel) const
  {
    if (!(sample.Fraction > 0.0f) || !this->Cells.Contains(sample.Position))
    {
      return 0;
    }
    float counted;
    const float met = this->At(sample.Position, counted);
    if (this->Table.Averages())
    {
      pixel.r += met * sample.Fraction;
      pixel.b += counted * sample.Fraction;
    }
    else
    {
      pixel.r = met > pixel.r ? met : pixel.r;
    }
    return 1;
  }

  /// Rank, or value times opacity.
  /// @param counted set to 1 where an average counts the sample, to 0 where not
  float At(const std::int64_t (&position)[3], float& counted) const
  {
    const std::int64_t inBrick[3] = { position[0] - this->Corner[0], position[1] - this->Corner[1],
      position[2] - this->Corner[2] };
    const float value = this->Values.At(inBrick);
    const bool hidden = this->Hidden && this->Hidden->At(CellAt(inBrick));
    const int entry = hidden ? this->Table.Transparent() : this->Scale.Lookup.IndexOf(value);
    const bool counts = entry != this->Table.Transparent() && value >= this->Scale.LowestCounted &&
                        value <= this->Scale.HighestCounted;
    counted = counts ? 1.0f : 0.0f;
    if (!this->Table.Averages())
    {
      return this->Table.RankOf(entry);
    }
    // Not a number where nothing counts, and where numbers overflow.
    const float level = (value - this->Scale.Black) * this->Scale.PerValue;
    const float notBelow = level > 0.0f ? level : 0.0f;
    const float inside = notBelow < 1.0f ? notBelow : 1.0f;
    return counts ? inside * this->Table.OpacityOfEntries()[entry] : 0.0f;
  }

  std::int64_t Corner[3]; ///< fixed-point position of the brick's first sample
  const ProjectionTable& Table;
  const ProjectionTable::Scale& Scale;
  PlainInterpolator<T> Values;
  const HiddenInBrick* Hidden;
  FixedBox Cells;
};

template <class T>
void ProjectRays(const PlainProjector<T>& projector, const PixelRect& rect, RayTile& tile)
{
  tile.ForSlotsUnder(rect,
    [&](int slot)
    {
      if (!tile.IsEmpty(slot))
      {
        glm::vec4 pixel = tile.PixelOf(slot);
        tile.SamplesTaken += projector.ProjectRay(tile.RayOf(slot), pixel);
        tile.SetPixel(slot, pixel);
      }
    });
}

} // namespace

void ProjectBrick(
  const BrickPart& part, const ProjectionTable& table, const PixelRect& pixels, RayTile& tile)
{
  Dispatch(part.View.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      ProjectRays(
        PlainProjector<T>(part, table, IsRelative<T>, tile), Intersection(pixels, tile.Rect), tile);
    });
}

void ProjectUnpacked(const PackedBrick& brick, const Box& cells, const ProjectionTable& table,
  const PixelRect& pixels, RayTile& tile)
{
  const BrickView view = brick.View();
  const PlainProjector<float> projector(
    { view, brick.Corner(), cells, &brick.Hidden() }, table, brick.Relative(), tile);
  ProjectRays(projector, Intersection(pixels, tile.Rect), tile);
}

} // namespace banyan
