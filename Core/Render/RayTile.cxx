#include "Render/RayTile.h"

#include <cstdlib>
#include <limits>

namespace banyan
{

void RayTile::SetRay(int slot, const RaySamples& ray)
{
  static_assert(FractionBits == 24, "positions modulo 256 cells have 32 bits");
  this->Rays[static_cast<std::size_t>(slot)] = ray;
  this->Count[slot] = ray.Count;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (ray.Count == 0)
    {
      // Empty rays never come near a brick; those with a head or tail alone always do.
      constexpr double infinity = std::numeric_limits<double>::infinity();
      this->Base[axis][slot] = this->Step[axis][slot] = 0;
      this->Start[axis][slot] = ray.Empty() ? -1e9 : 0.0;
      this->Inverse[axis][slot] = ray.Empty() ? infinity : 0.0;
      continue;
    }
    this->Base[axis][slot] = static_cast<std::uint32_t>(ray.Base[axis]);
    this->Step[axis][slot] = static_cast<std::uint32_t>(ray.Step[axis]);
    this->Start[axis][slot] = ray.Start[axis];
    this->Inverse[axis][slot] = ray.InverseStep[axis];
    if (ray.Step[axis] == 0)
    {
      // Distances to faces are then infinite, with the right sign: no product of 0 and infinity.
      this->Start[axis][slot] += 0.25 / (1 << FractionBits);
      this->Inverse[axis][slot] = std::numeric_limits<double>::infinity();
    }
    this->PacketsFit &= std::llabs(ray.Step[axis]) <= ToFixed(LongestStep);
  }
}

void RayTile::Open(
  const RayLattice& lattice, const PixelRect& rect, const FloatImage& picture, float limit)
{
  this->Rect = rect;
  this->TransmittanceLimit = limit;
  this->ActiveRays = 0;
  this->SamplesTaken = 0;
  this->PacketsFit = true;
  this->Rays.resize(Slots);
  for (int y = rect.Lo.y; y < rect.Lo.y + Edge; ++y)
  {
    for (int x = rect.Lo.x; x < rect.Lo.x + Edge; ++x)
    {
      const int slot = this->SlotOf(x, y);
      const bool inside = x < rect.Hi.x && y < rect.Hi.y;
      const glm::vec4 pixel = inside ? picture.At(x, y) : glm::vec4(0.0f);
      const bool active = inside && pixel.a > limit;
      this->SetRay(slot, active ? lattice.SamplesOf(x, y) : RaySamples{});
      this->ActiveRays += this->Rays[static_cast<std::size_t>(slot)].Empty() ? 0 : 1;
      this->SetPixel(slot, pixel);
    }
  }
}

void RayTile::Close(FloatImage& picture) const
{
  for (int y = this->Rect.Lo.y; y < this->Rect.Hi.y; ++y)
  {
    for (int x = this->Rect.Lo.x; x < this->Rect.Hi.x; ++x)
    {
      picture.At(x, y) = this->PixelOf(this->SlotOf(x, y));
    }
  }
}

} // namespace banyan
