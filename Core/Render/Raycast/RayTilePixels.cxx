// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Raycast/RayTile.h"

#include <algorithm>
#include <cmath>

namespace banyan
{

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

void RaySamples::CountInSmallerCells(int levels)
{
  if (levels == 0)
  {
    return;
  }
  const std::int64_t factor = std::int64_t{ 1 } << levels;
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Base[axis] *= factor;
    this->Step[axis] *= factor;
    this->Start[axis] *= static_cast<double>(factor);
    this->InverseStep[axis] /= static_cast<double>(factor);
    this->Head.Position[axis] *= factor;
    this->Tail.Position[axis] *= factor;
  }
}

} // namespace banyan
