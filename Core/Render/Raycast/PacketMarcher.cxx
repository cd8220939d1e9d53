// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Raycast/BrickMarcher.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Render/Raycast/PacketMarcher.cxx"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#if HWY_TARGET != HWY_SCALAR
#include "Render/Raycast/PacketMarcher-inl.h"
#include "Render/Raycast/PacketSamples-inl.h"
#include "Render/Raycast/UniformSamples-inl.h"
#endif

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

#if HWY_TARGET == HWY_SCALAR

// Processors without SSE4, and others without vectors: one ray after the other.
void MarchPackedHere(const PackedBrick& brick, const BrickVisibility& seen, const StepTable& table,
  const ShadingTable* shading, const PixelRect& pixels, RayTile& tile,
  SampleInterpolation interpolation)
{
  MarchUnpacked(brick, seen, table, shading, pixels, tile, interpolation);
}

void MarchUniformHere(
  const Box& cells, const StepTable& table, int entry, const PixelRect& pixels, RayTile& tile)
{
  MarchUniformPlain(cells, table, entry, pixels, tile);
}

#else

template <bool Special, bool Holes, bool Shaded, bool Nearest, bool Numbers = false,
  bool Coloured = false>
void MarchPackets(const PackedBrick& brick, const BrickVisibility& seen, const StepTable& table,
  const ShadingTable* shading, const PixelRect& pixels, RayTile& tile)
{
  using Values = PacketSamples<Special, Shaded, Nearest, Numbers, Coloured>;
  PacketMarcher<Values, Holes> marcher(
    Values(brick, table, shading), seen.Cells, brick.Corner(), tile);
  marcher.SkipMacros(brick, seen);
  marcher.March(pixels);
}

void MarchUniformHere(
  const Box& cells, const StepTable& table, int entry, const PixelRect& pixels, RayTile& tile)
{
  PacketMarcher<UniformSamples, false>({ table, entry }, cells, cells.Lo, tile).March(pixels);
}

void MarchPackedHere(const PackedBrick& brick, const BrickVisibility& seen, const StepTable& table,
  const ShadingTable* shading, const PixelRect& pixels, RayTile& tile,
  SampleInterpolation interpolation)
{
  using March = void (*)(const PackedBrick&, const BrickVisibility&, const StepTable&,
    const ShadingTable*, const PixelRect&, RayTile&);
  static constexpr March linear[8] = { MarchPackets<false, false, false, false>,
    MarchPackets<true, false, false, false>, MarchPackets<false, true, false, false>,
    MarchPackets<true, true, false, false>, MarchPackets<false, false, true, false>,
    MarchPackets<true, false, true, false>, MarchPackets<false, true, true, false>,
    MarchPackets<true, true, true, false> };
  // One way for all values: labels are not drawn so often that a second one would pay.
  static constexpr March nearest[4] = { MarchPackets<true, false, false, true>,
    MarchPackets<true, true, false, true>, MarchPackets<true, false, true, true>,
    MarchPackets<true, true, true, true> };
  if (brick.HasColours())
  {
    static constexpr March colours[8] = { MarchPackets<true, false, false, false, false, true>,
      MarchPackets<true, true, false, false, false, true>,
      MarchPackets<true, false, true, false, false, true>,
      MarchPackets<true, true, true, false, false, true>,
      MarchPackets<true, false, false, true, false, true>,
      MarchPackets<true, true, false, true, false, true>,
      MarchPackets<true, false, true, true, false, true>,
      MarchPackets<true, true, true, true, false, true> };
    const int way = (seen.Holes ? 1 : 0) + (shading ? 2 : 0) +
                    (interpolation == SampleInterpolation::Nearest ? 4 : 0);
    return colours[way](brick, seen, table, shading, pixels, tile);
  }
  const bool hasEdges = table.Lookup().Edges != nullptr;
  if (brick.HasNumbers())
  {
#if BANYAN_HAS_NUMBERS
    static constexpr March numbers[8] = { MarchPackets<false, false, false, false, true>,
      MarchPackets<false, true, false, false, true>, MarchPackets<false, false, false, true, true>,
      MarchPackets<false, true, false, true, true>, MarchPackets<true, false, false, false, true>,
      MarchPackets<true, true, false, false, true>, MarchPackets<true, false, false, true, true>,
      MarchPackets<true, true, false, true, true> };
    const int way = (seen.Holes ? 1 : 0) + (interpolation == SampleInterpolation::Nearest ? 2 : 0) +
                    (hasEdges ? 4 : 0);
    return numbers[way](brick, seen, table, shading, pixels, tile);
#else
    return MarchUnpacked(brick, seen, table, shading, pixels, tile, interpolation);
#endif
  }
  const int which = (seen.Holes ? 1 : 0) + (shading ? 2 : 0);
  const March march = interpolation == SampleInterpolation::Nearest
                        ? nearest[which]
                        : linear[2 * which + (brick.Special() || hasEdges ? 1 : 0)];
  march(brick, seen, table, shading, pixels, tile);
}

#endif

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace banyan
{

HWY_EXPORT(MarchPackedHere);

void MarchPacked(const PackedBrick& brick, const BrickVisibility& seen, const StepTable& table,
  const ShadingTable* shading, const PixelRect& pixels, RayTile& tile,
  SampleInterpolation interpolation)
{
  const PixelRect rect = Intersection(pixels, tile.Rect);
  if (!rect.Empty() && !seen.Cells.Empty())
  {
    HWY_DYNAMIC_DISPATCH(MarchPackedHere)
    (brick, seen, table, shading, rect, tile, interpolation);
  }
}

HWY_EXPORT(MarchUniformHere);

void MarchUniform(
  const Box& cells, const StepTable& table, int entry, const PixelRect& pixels, RayTile& tile)
{
  const PixelRect rect = Intersection(pixels, tile.Rect);
  const std::int64_t taken = tile.SamplesTaken;
  if (!rect.Empty() && !cells.Empty())
  {
    HWY_DYNAMIC_DISPATCH(MarchUniformHere)(cells, table, entry, rect, tile);
  }
  tile.SamplesTaken = taken;
}

} // namespace banyan
#endif
