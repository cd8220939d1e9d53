// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/ChainLengths.h"

#include "Codec/BlockModes.h"
#include "Codec/GroupOrder.h"
#include "Series/Format/GroupFormat.h"

#include <algorithm>
#include <bitset>

namespace banyan
{
namespace
{

std::size_t IndexIn(const glm::ivec3& count, const glm::ivec3& at)
{
  return (static_cast<std::size_t>(at.z) * static_cast<std::size_t>(count.y) +
           static_cast<std::size_t>(at.y)) *
           static_cast<std::size_t>(count.x) +
         static_cast<std::size_t>(at.x);
}

std::size_t CountOf(const glm::ivec3& size)
{
  return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
         static_cast<std::size_t>(size.z);
}

/// The steps that each box takes, as bits: bit 0 is the step before the group.
class StepsOfBoxes
{
public:
  StepsOfBoxes(const EncodedField& field, const group::TableShape& shape, int brickCells)
    : Field(field)
    , Shape(shape)
    , Edge(brickCells)
    , Words((field.Steps.size() + 1 + 63) / 64)
    , Bits(field.Steps.size())
  {
    const int steps = static_cast<int>(field.Steps.size());
    for (const int step : DyadicOrder(steps)) // references come first
    {
      auto& planes = this->Bits[static_cast<std::size_t>(step)];
      planes.resize(shape.Blocks.size());
      for (std::size_t p = planes.size(); p-- > 0;)
      {
        planes[p].resize(CountOf(shape.Blocks[p]) * this->Words);
        this->FillPlane(step, static_cast<int>(p));
      }
    }
  }

  /// How many steps a box of the finest plane takes.
  int Count(int step, const glm::ivec3& block) const
  {
    const std::uint64_t* bits = this->At(step, 0, block);
    std::size_t count = 0;
    for (std::size_t w = 0; w < this->Words; ++w)
    {
      count += std::bitset<64>(bits[w]).count();
    }
    return static_cast<int>(count);
  }

private:
  const std::uint64_t* At(int step, int plane, const glm::ivec3& block) const
  {
    const std::size_t p = static_cast<std::size_t>(plane);
    return this->Bits[static_cast<std::size_t>(step)][p].data() +
           IndexIn(this->Shape.Blocks[p], block) * this->Words;
  }

  static void Mark(std::uint64_t* bits, int step)
  {
    const std::size_t bit = static_cast<std::size_t>(step - StepBefore);
    bits[bit / 64] |= std::uint64_t{ 1 } << bit % 64;
  }

  void Include(std::uint64_t* bits, int step, int plane, const glm::ivec3& block) const
  {
    if (step == StepBefore)
    {
      return Mark(bits, step); // a key frame
    }
    const std::uint64_t* from = this->At(step, plane, block);
    for (std::size_t w = 0; w < this->Words; ++w)
    {
      bits[w] |= from[w];
    }
  }

  /// Fills a box in the order of GroupField::DecodeAs.
  void FillBox(int step, int plane, const glm::ivec3& block, std::uint64_t* bits) const
  {
    const std::size_t p = static_cast<std::size_t>(plane);
    const glm::ivec3 count = this->Shape.Blocks[p];
    const auto& blocks = this->Field.Steps[static_cast<std::size_t>(step)].Planes[p];
    bool same = true;
    bool refers = false;
    for (int corner = 0; corner < 8; ++corner)
    {
      const glm::ivec3 at = block + glm::ivec3{ corner & 1, corner >> 1 & 1, corner >> 2 };
      if (at.x >= count.x || at.y >= count.y || at.z >= count.z)
      {
        same = false;
        continue;
      }
      const EncodedBlock& one = blocks[IndexIn(count, at)];
      same = same && one.Same;
      refers = refers || one.Same ||
               (!one.Uniform && block::ModeOf(one.Mode).From != block::Reference::None);
    }
    Mark(bits, step);
    const StepReferences references =
      ReferencesOfStep(step, static_cast<int>(this->Field.Steps.size()), this->Field.Head.Open);
    if (refers)
    {
      this->Include(bits, references.A, plane, block);
    }
    if (refers && !same)
    {
      this->Include(bits, references.B, plane, block);
    }
    if (!same && p + 1 < this->Shape.Blocks.size())
    {
      this->Include(bits, step, plane + 1, block * (this->Edge / 4) / this->Edge);
    }
  }

  void FillPlane(int step, int plane)
  {
    const std::size_t p = static_cast<std::size_t>(plane);
    std::uint64_t* bits = this->Bits[static_cast<std::size_t>(step)][p].data();
    const glm::ivec3 count = this->Shape.Blocks[p];
    for (int z = 0; z < count.z; ++z)
    {
      for (int y = 0; y < count.y; ++y)
      {
        for (int x = 0; x < count.x; ++x, bits += this->Words)
        {
          this->FillBox(step, plane, { x, y, z }, bits);
        }
      }
    }
  }

  const EncodedField& Field;
  const group::TableShape& Shape;
  int Edge;
  std::size_t Words;
  std::vector<std::vector<std::vector<std::uint64_t>>> Bits; ///< by step and plane
};

} // namespace

void CountChains(EncodedField& field, const glm::ivec3& samples, int brickCells)
{
  const group::TableShape shape = group::ShapeOf(samples, field.Head.Axes, brickCells, 1);
  const StepsOfBoxes boxes(field, shape, brickCells);
  const glm::ivec3 bricks = shape.Bricks[0];
  field.ChainSum = 0;
  field.ChainMost = 0;
  field.ChainBricks = 0;
  for (std::size_t step = 0; step < field.Steps.size(); ++step)
  {
    for (std::size_t brick = 0; brick < field.Steps[step].Levels[0].size(); ++brick)
    {
      const int b = static_cast<int>(brick);
      const glm::ivec3 position{ b % bricks.x, b / bricks.x % bricks.y, b / bricks.x / bricks.y };
      glm::ivec3 block;
      for (int a = 0; a < 3; ++a)
      {
        block[a] = position[field.Head.Axes[static_cast<std::size_t>(a)]];
      }
      const bool uniform = field.Steps[step].Levels[0][brick].Uniform;
      const int chain = uniform ? 1 : boxes.Count(static_cast<int>(step), block);
      field.ChainSum += chain;
      field.ChainMost = std::max(field.ChainMost, chain);
      ++field.ChainBricks;
    }
  }
}

} // namespace banyan
