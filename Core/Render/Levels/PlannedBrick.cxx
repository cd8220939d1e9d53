// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Levels/PlannedBrick.h"

namespace banyan
{

ValueRange PlannedBrick::RangeIn(const BrickSource& source) const
{
  ValueRange range;
  this->ForEach(source, [&](std::int64_t number) { range.Include(source.RangeOf(number)); });
  return range;
}

std::uint64_t PlannedBrick::LoadBytes(const BrickSource& source) const
{
  std::uint64_t bytes = 0;
  this->ForEach(source, [&](std::int64_t number) { bytes += source.LoadBytes(number); });
  return bytes;
}

std::uint64_t PlannedBrick::PackedBytes(const BrickSource& source, bool shaded) const
{
  return PackedBrick::BytesFor(this->Cells, shaded, source.HasColours()) +
         (source.Hidden() ? HiddenInBrick::BytesFor(this->Cells) : 0);
}

std::uint64_t PlannedBrick::BytesToDraw(const BrickSource& source, bool shaded) const
{
  return this->Entry ? 0 : this->LoadBytes(source) + this->PackedBytes(source, shaded);
}

std::int64_t PlannedBrick::KeptNumber(const BrickSource& source) const
{
  constexpr std::int64_t together = std::int64_t{ 1 } << 40;
  const std::int64_t bricks = this->Together.Count();
  return source.KeptNumber(this->Number) + (bricks == 0    ? 0
                                             : bricks <= 8 ? together
                                                           : 2 * together);
}

} // namespace banyan
