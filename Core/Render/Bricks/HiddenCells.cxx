// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/HiddenCells.h"

#include "Base/Error.h"

#include <algorithm>
#include <cstring>

namespace banyan
{
namespace
{

int BitsIn(std::uint16_t bits)
{
  return __builtin_popcount(bits);
}

/// Bits from one to another, half-open, of 16.
std::uint16_t BitsBetween(int begin, int end)
{
  return static_cast<std::uint16_t>(((1u << end) - 1u) & ~((1u << begin) - 1u));
}

} // namespace

HiddenCells::HiddenCells(const glm::ivec3& cells)
  : Cells(glm::max(cells, glm::ivec3(0)))
  , Blocks((Cells + (BlockEdge - 1)) / BlockEdge)
  , States(static_cast<std::size_t>(Box{ glm::ivec3(0), Blocks }.Count()), State::None)
{
}

std::int64_t HiddenCells::NumberOf(const glm::ivec3& block) const
{
  return block.x +
         std::int64_t{ this->Blocks.x } * (block.y + std::int64_t{ this->Blocks.y } * block.z);
}

Box HiddenCells::CellsOf(const glm::ivec3& block) const
{
  return { block * BlockEdge, glm::min((block + 1) * BlockEdge, this->Cells) };
}

/// Calls function(block, cells of it) for the parts of a box.
template <class Function>
void HiddenCells::ForBlocks(const Box& cells, Function&& function) const
{
  const Box inside = Intersection(cells, { glm::ivec3(0), this->Cells });
  if (inside.Empty())
  {
    return;
  }
  const glm::ivec3 first = inside.Lo / BlockEdge;
  const glm::ivec3 last = (inside.Hi - 1) / BlockEdge;
  for (int z = first.z; z <= last.z; ++z)
  {
    for (int y = first.y; y <= last.y; ++y)
    {
      for (int x = first.x; x <= last.x; ++x)
      {
        const glm::ivec3 block(x, y, z);
        function(block, Intersection(inside, this->CellsOf(block)));
      }
    }
  }
}

/// Calls function(y, z, bits) for the rows of a part of a block, with the bits of the part.
template <class Function>
void HiddenCells::ForRows(const Rows& bits, const Box& block, const Box& part, Function&& function)
{
  const std::uint16_t mask = BitsBetween(part.Lo.x - block.Lo.x, part.Hi.x - block.Lo.x);
  for (int z = part.Lo.z; z < part.Hi.z; ++z)
  {
    for (int y = part.Lo.y; y < part.Hi.y; ++y)
    {
      const int row = (z - block.Lo.z) * BlockEdge + (y - block.Lo.y);
      function(y, z, static_cast<std::uint16_t>(bits[static_cast<std::size_t>(row)] & mask));
    }
  }
}

void HiddenCells::Hide(const Box& cells, const std::uint8_t* flags, std::uint8_t bits)
{
  const glm::i64vec3 size(cells.Size());
  this->ForBlocks(cells,
    [&](const glm::ivec3& block, const Box& part)
    {
      const Box own = this->CellsOf(block);
      Rows rows{};
      for (int z = part.Lo.z; z < part.Hi.z; ++z)
      {
        for (int y = part.Lo.y; y < part.Hi.y; ++y)
        {
          const std::uint8_t* row =
            flags + size.x * ((y - cells.Lo.y) + size.y * (z - cells.Lo.z)) - cells.Lo.x;
          unsigned hidden = 0;
          for (int x = part.Lo.x; x < part.Hi.x; ++x)
          {
            hidden |= (row[x] & bits) != 0 ? 1u << (x - own.Lo.x) : 0u;
          }
          rows[static_cast<std::size_t>((z - own.Lo.z) * BlockEdge + (y - own.Lo.y))] =
            static_cast<std::uint16_t>(hidden);
        }
      }
      this->HideIn(block, rows);
    });
}

void HiddenCells::HideAll(const glm::ivec3& block)
{
  const std::int64_t number = this->NumberOf(block);
  this->States[static_cast<std::size_t>(number)] = State::All;
  this->Mixed.erase(number);
}

void HiddenCells::HideIn(const glm::ivec3& block, const Rows& bits)
{
  const std::int64_t number = this->NumberOf(block);
  State& state = this->States[static_cast<std::size_t>(number)];
  const bool any =
    std::any_of(bits.begin(), bits.end(), [](std::uint16_t row) { return row != 0; });
  if (!any || state == State::All)
  {
    return;
  }
  state = State::Some;
  Block& mixed = this->Mixed[number];
  mixed.Count = 0;
  for (std::size_t row = 0; row < bits.size(); ++row)
  {
    mixed.Bits[row] = static_cast<std::uint16_t>(mixed.Bits[row] | bits[row]);
    mixed.Count += BitsIn(mixed.Bits[row]);
  }
  if (mixed.Count == this->CellsOf(block).Count())
  {
    this->HideAll(block);
  }
}

std::int64_t HiddenCells::CountIn(const Box& cells) const
{
  std::int64_t count = 0;
  this->ForBlocks(cells,
    [&](const glm::ivec3& block, const Box& part)
    {
      const std::int64_t number = this->NumberOf(block);
      const State state = this->States[static_cast<std::size_t>(number)];
      if (state != State::Some)
      {
        count += state == State::All ? part.Count() : 0;
        return;
      }
      const Block& mixed = this->Mixed.at(number);
      const Box own = this->CellsOf(block);
      if (part == own)
      {
        count += mixed.Count;
        return;
      }
      ForRows(mixed.Bits, own, part, [&](int, int, std::uint16_t row) { count += BitsIn(row); });
    });
  return count;
}

bool HiddenCells::All(const Box& cells) const
{
  const Box inside = Intersection(cells, { glm::ivec3(0), this->Cells });
  return !inside.Empty() && this->CountIn(inside) == inside.Count();
}

/// The bits of a block of which some or all cells are hidden.
HiddenCells::Rows HiddenCells::RowsOf(std::int64_t number) const
{
  const auto mixed = this->Mixed.find(number);
  if (mixed != this->Mixed.end())
  {
    return mixed->second.Bits;
  }
  Rows all;
  all.fill(0xffff);
  return all;
}

void HiddenCells::CopyBits(const Box& cells, int wordsPerRow, std::uint32_t* words) const
{
  const std::ptrdiff_t rowsPerSlice = cells.Size().y;
  this->ForBlocks(cells,
    [&](const glm::ivec3& block, const Box& part)
    {
      const std::int64_t number = this->NumberOf(block);
      if (this->States[static_cast<std::size_t>(number)] == State::None)
      {
        return;
      }
      const Box own = this->CellsOf(block);
      ForRows(this->RowsOf(number), own, part,
        [&](int y, int z, std::uint16_t row)
        {
          std::uint32_t* const out =
            words + ((z - cells.Lo.z) * rowsPerSlice + (y - cells.Lo.y)) * wordsPerRow;
          for (int x = part.Lo.x; row != 0 && x < part.Hi.x; ++x)
          {
            const int bit = x - cells.Lo.x;
            out[bit / 32] |= static_cast<std::uint32_t>(row >> (x - own.Lo.x) & 1) << bit % 32;
          }
        });
    });
}

HiddenCells HiddenCells::Coarser(const glm::ivec3& edges) const
{
  HiddenCells coarse((this->Cells + (edges - 1)) / edges);
  const Box whole{ glm::ivec3(0), this->Cells };
  const auto fine = [&](const Box& cells) {
    return Intersection({ cells.Lo * edges, cells.Hi * edges }, whole);
  };
  coarse.ForBlocks({ glm::ivec3(0), coarse.Cells },
    [&](const glm::ivec3& block, const Box& cells)
    {
      const std::int64_t hidden = this->CountIn(fine(cells));
      if (hidden == 0 || hidden == fine(cells).Count())
      {
        hidden == 0 ? void() : coarse.HideAll(block);
        return;
      }
      Rows rows{};
      for (std::int64_t i = 0; i < cells.Count(); ++i)
      {
        const glm::i64vec3 size(cells.Size());
        const glm::ivec3 in(i % size.x, i / size.x % size.y, i / size.x / size.y);
        const Box part = fine({ cells.Lo + in, cells.Lo + in + 1 });
        const bool hide = 2 * this->CountIn(part) >= part.Count();
        std::uint16_t& row = rows[static_cast<std::size_t>(in.z * BlockEdge + in.y)];
        row = static_cast<std::uint16_t>(row | (hide ? 1u << in.x : 0u));
      }
      coarse.HideIn(block, rows);
    });
  return coarse;
}

/// Per block: twice its number, and 1 more if all of it is hidden, otherwise its rows behind that.
std::string HiddenCells::ToBytes() const
{
  std::string bytes;
  for (std::size_t i = 0; i < this->States.size(); ++i)
  {
    if (this->States[i] == State::None)
    {
      continue;
    }
    const bool all = this->States[i] == State::All;
    const std::uint64_t head = 2 * static_cast<std::uint64_t>(i) + (all ? 1 : 0);
    bytes.append(reinterpret_cast<const char*>(&head), sizeof(head));
    if (!all)
    {
      const Rows& rows = this->Mixed.at(static_cast<std::int64_t>(i)).Bits;
      bytes.append(reinterpret_cast<const char*>(rows.data()), sizeof(rows));
    }
  }
  return bytes;
}

void HiddenCells::Add(const std::string& bytes)
{
  const auto take = [&](std::size_t& at, void* out, std::size_t size)
  {
    if (bytes.size() - at < size)
    {
      throw Error("What a rank tells of hidden cells ends too soon");
    }
    std::memcpy(out, bytes.data() + at, size);
    at += size;
  };
  for (std::size_t at = 0; at < bytes.size();)
  {
    std::uint64_t head = 0;
    take(at, &head, sizeof(head));
    const auto number = static_cast<std::int64_t>(head / 2);
    if (number >= static_cast<std::int64_t>(this->States.size()))
    {
      throw Error("What a rank tells of hidden cells is of another grid");
    }
    const glm::ivec3 block(static_cast<int>(number % this->Blocks.x),
      static_cast<int>(number / this->Blocks.x % this->Blocks.y),
      static_cast<int>(number / this->Blocks.x / this->Blocks.y));
    if (head % 2 == 1)
    {
      this->HideAll(block);
      continue;
    }
    Rows rows;
    take(at, rows.data(), sizeof(rows));
    this->HideIn(block, rows);
  }
}

} // namespace banyan
