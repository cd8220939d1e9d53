// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Raycast/RayTile.h"

#include "Render/Scene/ReusedRays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Render/Raycast/RayTile.cxx"
#include <hwy/foreach_target.h>

#include "Render/Raycast/RayFiller-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// @return false when the sample distance is too small for the distance of a ray's samples
bool FillRaysHere(
  const RayLattice& lattice, const double* ends, const double* active, RayTile& tile)
{
  RayFiller filler(lattice, tile);
  constexpr int lanes = static_cast<int>(hn::MaxLanes(DD()));
  constexpr int size = RayTile::PacketSize;
  alignas(64) double x[size];
  alignas(64) double y[size];
  const glm::ivec2 packets = tile.PacketsUnder(tile.Rect).Hi;
  for (int number = 0; number < packets.x * packets.y; ++number)
  {
    const int packet = number / packets.x * RayTile::PacketsPerRow + number % packets.x;
    for (int i = 0; i < size; ++i)
    {
      const glm::ivec2 at = tile.PixelAt(packet * size + i);
      x[i] = at.x;
      y[i] = at.y;
    }
    for (int i = 0; i < size; i += lanes)
    {
      const int slot = packet * size + i;
      if (!filler.Fill(slot, x + i, y + i, ends + slot, active + slot))
      {
        return false;
      }
    }
  }
  return true;
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace banyan
{

HWY_EXPORT(FillRaysHere);

void RayTile::Open(const RayLattice& lattice, const PixelRect& rect, const FloatImage& picture,
  float limit, int stride, bool begun, const PixelRect& drawn, std::uint64_t cast)
{
  this->Rect = rect;
  this->Stride = stride;
  this->Corner = rect.Lo / stride * stride;
  this->TransmittanceLimit = limit;
  this->SamplesTaken = 0;
  this->PacketsFit = true;
  alignas(64) double ends[Slots];
  alignas(64) double active[Slots];
  const auto forRows = [packets = this->PacketsUnder(rect).Hi](auto&& function)
  {
    for (int number = 0; number < packets.x * packets.y; ++number)
    {
      const int packet = number / packets.x * PacketsPerRow + number % packets.x;
      for (int row = 0; row < PacketEdge; ++row)
      {
        function(packet * PacketSize + row * PacketEdge);
      }
    }
  };
  forRows(
    [&](int slot)
    {
      const glm::ivec2 at = this->PixelAt(slot);
      const bool inside = at.y >= rect.Lo.y && at.y < rect.Hi.y;
      const bool drawnRow = at.y >= drawn.Lo.y && at.y < drawn.Hi.y;
      const glm::vec4* const row =
        inside && begun ? &picture.At(rect.Lo.x, at.y) - rect.Lo.x : nullptr;
      for (int i = 0; i < PacketEdge; ++i)
      {
        const int x = at.x + i * stride;
        const bool here = inside && x >= rect.Lo.x && x < rect.Hi.x;
        const float start = here && (cast & ReusedRays::BitOf(x, at.y)) != 0 ? 1.0f : 0.0f;
        const glm::vec4 pixel = row && here ? row[x] : glm::vec4(0, 0, 0, start);
        const bool wanted =
          here && drawnRow && x >= drawn.Lo.x && x < drawn.Hi.x && pixel.a > limit;
        active[slot + i] = wanted ? 1.0 : 0.0;
        ends[slot + i] = wanted && lattice.HasGeometry() ? lattice.GeometryAt(x, at.y)
                                                         : std::numeric_limits<double>::infinity();
        this->SetPixel(slot + i, pixel);
      }
    });
  if (!HWY_DYNAMIC_DISPATCH(FillRaysHere)(lattice, ends, active, *this))
  {
    RayLattice::ThrowTooFar();
  }
  this->ActiveRays = 0;
  forRows(
    [this](int first)
    {
      for (int slot = first; slot < first + PacketEdge; ++slot)
      {
        const bool empty = (this->Count[slot] == 0) & (this->Head.Fraction[slot] == 0.0f) &
                           (this->Tail.Fraction[slot] == 0.0f);
        this->ActiveRays += empty ? 0 : 1;
      }
    });
}

void RayTile::Close(FloatImage& picture) const
{
  if (this->Stride > 1)
  {
    this->ForSlotsUnder(this->Rect,
      [&](int slot)
      {
        const glm::ivec2 at = this->PixelAt(slot);
        picture.At(at.x, at.y) = this->PixelOf(slot);
      });
    return;
  }
  for (int slot = 0; slot < Slots; slot += PacketEdge)
  {
    const glm::ivec2 at = this->PixelAt(slot);
    const int width = at.y < this->Rect.Hi.y ? std::min(this->Rect.Hi.x - at.x, PacketEdge) : 0;
    glm::vec4* row = width > 0 ? &picture.At(at.x, at.y) : nullptr;
    for (int i = 0; i < width; ++i)
    {
      row[i] = this->PixelOf(slot + i);
    }
  }
}

RaySamples RayTile::RayOf(int slot) const
{
  const auto fixed = [](std::int32_t cell, std::uint32_t position)
  { return ToFixed(cell) + (position & ((1u << FractionBits) - 1)); };
  RaySamples ray;
  ray.Count = this->Count[slot];
  ray.Head.Fraction = this->Head.Fraction[slot];
  ray.Tail.Fraction = this->Tail.Fraction[slot];
  for (int axis = 0; axis < 3; ++axis)
  {
    ray.Head.Position[axis] = fixed(this->Head.Cell[axis][slot], this->Head.Position[axis][slot]);
    ray.Tail.Position[axis] = fixed(this->Tail.Cell[axis][slot], this->Tail.Position[axis][slot]);
    const double unit = 1 << FractionBits;
    ray.Step[axis] = static_cast<std::int64_t>(this->WholeStep[axis][slot]);
    ray.Base[axis] = static_cast<std::int64_t>(std::floor(this->Start[axis][slot] * unit));
    ray.Start[axis] = static_cast<double>(ray.Base[axis]) / unit;
    ray.InverseStep[axis] = ray.Step[axis] != 0 ? this->Inverse[axis][slot] : 0.0;
  }
  ray.CountInSmallerCells(this->BrickShift);
  return ray;
}

} // namespace banyan
#endif
