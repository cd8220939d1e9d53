// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/HiddenInBrick.h"

#include "Render/Bricks/HiddenCells.h"

namespace banyan
{
namespace
{

int WordsOf(int cells)
{
  return (cells + 31) / 32;
}

} // namespace

HiddenInBrick::HiddenInBrick(const HiddenCells* hidden, const Box& cells)
{
  if (hidden && hidden->Any(cells))
  {
    const glm::ivec3 size = cells.Size();
    this->RowWords = WordsOf(size.x);
    this->Rows = size.y;
    this->Bits.assign(BytesFor(cells) / sizeof(std::uint32_t), 0);
    hidden->CopyBits(cells, this->RowWords, this->Bits.data());
  }
}

std::size_t HiddenInBrick::BytesFor(const Box& cells)
{
  const glm::ivec3 size = cells.Size();
  return static_cast<std::size_t>(WordsOf(size.x)) * size.y * size.z * sizeof(std::uint32_t);
}

bool HiddenInBrick::All(const Box& cells) const
{
  bool all = this->Any();
  for (int z = cells.Lo.z; all && z < cells.Hi.z; ++z)
  {
    for (int y = cells.Lo.y; all && y < cells.Hi.y; ++y)
    {
      for (int x = cells.Lo.x; all && x < cells.Hi.x; ++x)
      {
        all = this->Has({ x, y, z });
      }
    }
  }
  return all;
}

} // namespace banyan
