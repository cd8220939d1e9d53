// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Cells/TileRows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

constexpr int Slots = RayTile::Slots;
constexpr double Unit = 1 << FractionBits;

std::int64_t PositionOf(const RayTile::Ends& ends, int axis, int slot)
{
  return ToFixed(ends.Cell[axis][slot]) + (ends.Position[axis][slot] & ((1u << FractionBits) - 1));
}

void Include(TileRows::Range& range, int row)
{
  if (row != TileRows::None)
  {
    range.First = std::min(range.First, row);
    range.Last = std::max(range.Last, row);
  }
}

} // namespace

void TileRows::Take(const RayTile& tile, const LatticeSetup& lattice)
{
  const double perDirection = lattice.Distance / lattice.ShadingScale;
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (int slot = 0; slot < Slots; ++slot)
  {
    if (!tile.IsEmpty(slot))
    {
      lowest = std::min(lowest, tile.Number[slot] - 1.0);
      highest = std::max(highest, tile.Number[slot] + tile.Count[slot]);
    }
  }
  this->FirstNumber = lowest;
  this->Count = lowest <= highest ? static_cast<int>(highest - lowest) + 1 : 0;
  this->AnyEnds = false;
  std::fill_n(this->Heads, Slots / RayTile::PacketSize, Range{ this->Count, -1 });
  std::fill_n(this->Tails, Slots / RayTile::PacketSize, Range{ this->Count, -1 });
  for (int slot = 0; slot < Slots; ++slot)
  {
    const bool empty = tile.IsEmpty(slot);
    const auto first = empty ? 0 : static_cast<int>(tile.Number[slot] - lowest);
    const int count = empty ? 0 : tile.Count[slot];
    this->First[slot] = first;
    this->End[slot] = first + count;
    this->Head[slot] = !empty && tile.Head.Fraction[slot] > 0.0f ? first - 1 : None;
    this->Tail[slot] = !empty && tile.Tail.Fraction[slot] > 0.0f ? first + count : None;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double step = count > 0 ? tile.WholeStep[axis][slot] : 0.0;
      const double base = count > 0 ? std::floor(tile.Start[axis][slot] * Unit) : 0.0;
      this->Zero[axis][slot] = base - first * step;
      this->ZeroLow[axis][slot] =
        static_cast<std::uint32_t>(static_cast<std::int64_t>(this->Zero[axis][slot]));
      this->Step[axis][slot] = static_cast<float>(step / Unit);
      if (count == 0 && !empty)
      {
        const RayTile::Ends& end = tile.Head.Fraction[slot] > 0.0f ? tile.Head : tile.Tail;
        this->Zero[axis][slot] = static_cast<double>(PositionOf(end, axis, slot));
        this->Step[axis][slot] = static_cast<float>(tile.Direction[axis][slot] * perDirection);
      }
    }
    Include(this->Heads[slot / RayTile::PacketSize], this->Head[slot]);
    Include(this->Tails[slot / RayTile::PacketSize], this->Tail[slot]);
    this->AnyEnds |= this->Head[slot] != None || this->Tail[slot] != None;
  }
}

} // namespace banyan
