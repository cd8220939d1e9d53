// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Raycast/BrickMarcher.h"

#include "Render/Bricks/Interpolators.h"
#include "Render/Raycast/SegmentLog.h"

#include <optional>

namespace banyan
{
namespace
{

/// Shades samples of a packed brick with gradients.
class GradientShader
{
public:
  GradientShader(const PackedBrick& brick, const ShadingTable& shading, bool nearest)
    : Gradient{ { brick.GradientView(0), 0.0, nearest }, { brick.GradientView(1), 0.0, nearest },
      { brick.GradientView(2), 0.0, nearest } }
    , Shading(shading)
  {
  }

  void Apply(const std::int64_t (&position)[3], const float (&direction)[3], glm::vec4& step) const
  {
    const float gradient[3] = { this->Gradient[0].At(position), this->Gradient[1].At(position),
      this->Gradient[2].At(position) };
    const Shade shade = this->Shading.Of(gradient, direction);
    const float opacity = 1.0f - step.a;
    for (int channel = 0; channel < 3; ++channel)
    {
      step[channel] *= shade.Colour;
      step[channel] += this->Shading.HasHighlights ? shade.Highlight * opacity : 0.0f;
    }
  }

private:
  PlainInterpolator<float> Gradient[3];
  const ShadingTable& Shading;
};

/// Gives samples of a packed brick their colours.
class ColourTint
{
public:
  ColourTint(const PackedBrick& brick, bool nearest)
    : Channel{ { brick.ColourView(0), 0.0, nearest }, { brick.ColourView(1), 0.0, nearest },
      { brick.ColourView(2), 0.0, nearest } }
  {
  }

  void Apply(const std::int64_t (&position)[3], glm::vec4& step) const
  {
    for (int channel = 0; channel < 3; ++channel)
    {
      step[channel] *= this->Channel[channel].At(position) * (1.0f / 255.0f);
    }
  }

private:
  PlainInterpolator<std::uint8_t> Channel[3];
};

/// What samples of a packed brick do to their colour beside the table.
struct SampleColour
{
  std::optional<ColourTint> Tint;
  std::optional<GradientShader> Shader;

  /// @param step premultiplied colour and transmittance
  void Apply(const std::int64_t (&position)[3], const float (&direction)[3], glm::vec4& step) const
  {
    if (this->Tint)
    {
      this->Tint->Apply(position, step);
    }
    if (this->Shader)
    {
      this->Shader->Apply(position, direction, step);
    }
  }
};

/// The table's entries of a brick's values.
template <class T>
class BrickEntries
{
public:
  /// @param relative whether values become relative to the table's low end, or are already
  /// @param hidden null for none
  BrickEntries(const BrickView& view, const StepTable& table, bool relative, bool nearest,
    const HiddenInBrick* hidden)
    : Lookup(relative ? table.RelativeLookup() : table.Lookup())
    , Values(view, table.Low(), nearest)
    , Hidden(hidden)
  {
  }

  int At(const std::int64_t (&position)[3]) const
  {
    return this->Hidden && this->Hidden->At(CellAt(position))
             ? this->Lookup.Transparent
             : this->Lookup.IndexOf(this->Values.At(position));
  }

private:
  TableLookup Lookup;
  PlainInterpolator<T> Values;
  const HiddenInBrick* Hidden;
};

/// Where all values have one entry.
struct UniformEntries
{
  int Entry;

  int At(const std::int64_t (&)[3]) const { return this->Entry; }
};

/// One sample after the other.
/// @tparam Values BrickEntries, or what stands in for them
template <class Values>
class PlainMarcher
{
public:
  /// @param corner of the brick
  /// @param colour null where the table alone gives it
  PlainMarcher(const Values& entries, const Box& cells, const glm::ivec3& corner,
    const StepTable& table, const RayTile& tile, const SampleColour* colour = nullptr)
    : Table(table)
    , Entries(entries)
    , Colour(colour)
    , Cells(cells, tile.CellShift - tile.BrickShift)
    , Limit(tile.TransmittanceLimit)
    , Log(tile.Log)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Corner[axis] = ToFixed(corner[axis]);
    }
  }

  /// @param slot for the log
  /// @return samples taken
  std::int32_t MarchRay(
    int slot, const RaySamples& ray, const float (&direction)[3], glm::vec4& pixel) const
  {
    const Noted head{ slot, SegmentLog::Head };
    const Noted tail{ slot, SegmentLog::Tail };
    std::int32_t taken = this->MarchEnd(ray.Head, head, direction, pixel);
    std::int32_t begin = 0;
    std::int32_t end = 0;
    if (ray.Count > 0)
    {
      ray.SamplesIn(this->Cells, begin, end);
    }
    std::int64_t position[3];
    ray.PositionOf(begin, position);
    for (; begin < end && pixel.a > this->Limit; ++begin, ++taken)
    {
      this->Blend(
        position, { slot, begin }, direction, this->Table.Steps()[this->EntryAt(position)], pixel);
      for (int axis = 0; axis < 3; ++axis)
      {
        position[axis] += ray.Step[axis];
      }
    }
    return taken + this->MarchEnd(ray.Tail, tail, direction, pixel);
  }

private:
  /// A sample as SegmentLog has it.
  struct Noted
  {
    int Slot;
    std::int32_t Sample;
  };

  /// A head or tail, if it lies in the cells.
  std::int32_t MarchEnd(const PartialSample& sample, const Noted& noted,
    const float (&direction)[3], glm::vec4& pixel) const
  {
    if (!(sample.Fraction > 0.0f) || !this->Cells.Contains(sample.Position) ||
        !(pixel.a > this->Limit))
    {
      return 0;
    }
    glm::vec4 step = this->Table.Partial(this->EntryAt(sample.Position), sample.Fraction);
    step.a = 1.0f - step.a;
    this->Blend(sample.Position, noted, direction, step, pixel);
    return 1;
  }

  int EntryAt(const std::int64_t (&position)[3]) const
  {
    const std::int64_t inBrick[3] = { position[0] - this->Corner[0], position[1] - this->Corner[1],
      position[2] - this->Corner[2] };
    return this->Entries.At(inBrick);
  }

  /// @param step premultiplied colour and transmittance
  void Blend(const std::int64_t (&position)[3], const Noted& noted, const float (&direction)[3],
    glm::vec4 step, glm::vec4& pixel) const
  {
    if (this->Colour)
    {
      const std::int64_t inBrick[3] = { position[0] - this->Corner[0],
        position[1] - this->Corner[1], position[2] - this->Corner[2] };
      this->Colour->Apply(inBrick, direction, step);
    }
    if (this->Log)
    {
      this->Log->Add(noted.Slot, noted.Sample, step.r, step.g, step.b, step.a);
    }
    pixel.r += pixel.a * step.r;
    pixel.g += pixel.a * step.g;
    pixel.b += pixel.a * step.b;
    pixel.a *= step.a;
  }

  std::int64_t Corner[3]; ///< fixed-point position of the brick's first sample
  const StepTable& Table;
  Values Entries;
  const SampleColour* Colour;
  FixedBox Cells;
  float Limit;
  SegmentLog* Log;
};

template <class Values>
void MarchRays(const PlainMarcher<Values>& marcher, const PixelRect& rect, RayTile& tile)
{
  const float limit = tile.TransmittanceLimit;
  tile.ForSlotsUnder(rect,
    [&](int slot)
    {
      if (!tile.IsEmpty(slot) && tile.Transmittance[slot] > limit)
      {
        const float direction[3] = { tile.Direction[0][slot], tile.Direction[1][slot],
          tile.Direction[2][slot] };
        glm::vec4 pixel = tile.PixelOf(slot);
        tile.SamplesTaken += marcher.MarchRay(slot, tile.RayOf(slot), direction, pixel);
        tile.ActiveRays -= pixel.a > limit ? 0 : 1;
        tile.SetPixel(slot, pixel);
      }
    });
}

} // namespace

void MarchBrick(const BrickPart& part, const StepTable& table, const PixelRect& pixels,
  RayTile& tile, SampleInterpolation interpolation)
{
  const bool nearest = interpolation == SampleInterpolation::Nearest;
  Dispatch(part.View.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const BrickEntries<T> entries(part.View, table, IsRelative<T>, nearest, part.Hidden);
      const PlainMarcher marcher(entries, part.Cells, part.Corner, table, tile);
      MarchRays(marcher, Intersection(pixels, tile.Rect), tile);
    });
}

void MarchUnpacked(const PackedBrick& brick, const BrickVisibility& seen, const StepTable& table,
  const ShadingTable* shading, const PixelRect& pixels, RayTile& tile,
  SampleInterpolation interpolation)
{
  const bool nearest = interpolation == SampleInterpolation::Nearest;
  const BrickView view = brick.View();
  SampleColour colour;
  if (brick.HasColours())
  {
    colour.Tint.emplace(brick, nearest);
  }
  if (shading)
  {
    colour.Shader.emplace(brick, *shading, nearest);
  }
  const bool byTable = !colour.Tint && !colour.Shader;
  const BrickEntries<float> entries(view, table, brick.Relative(), nearest, &brick.Hidden());
  const PlainMarcher marcher(
    entries, seen.Cells, brick.Corner(), table, tile, byTable ? nullptr : &colour);
  MarchRays(marcher, Intersection(pixels, tile.Rect), tile);
}

void MarchUniformPlain(
  const Box& cells, const StepTable& table, int entry, const PixelRect& pixels, RayTile& tile)
{
  const std::int64_t taken = tile.SamplesTaken;
  const PlainMarcher marcher(UniformEntries{ entry }, cells, cells.Lo, table, tile);
  MarchRays(marcher, Intersection(pixels, tile.Rect), tile);
  tile.SamplesTaken = taken;
}

} // namespace banyan
