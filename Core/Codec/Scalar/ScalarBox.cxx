// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/Scalar/ScalarBox.h"

#include "Codec/Scalar/ScalarResiduals.h"

#include "Base/Error.h"

#include <algorithm>
#include <cstddef>

namespace banyan::scalar
{
namespace
{

/// All samples of a box, and which of them are known.
class Box
{
public:
  Box(int edge, const scalar::Plane& plane, const BoxCode& code)
    : Edge(edge)
    , Shared(plane)
    , Code(code)
    , Values(static_cast<std::size_t>((edge + 1) * (edge + 1) * (edge + 1)), 0)
    , Known(this->Values.size(), false)
  {
  }

  std::vector<std::int32_t> Decode()
  {
    this->CheckReferences();
    this->PlaceCoarse();
    this->PlacePlain();
    const auto blocks = this->ReadBlocks();
    // All edges, then all faces that they frame, then the interior.
    for (std::size_t unit = 0; unit < Units.size(); ++unit)
    {
      for (int owner = 0; owner < 8; ++owner)
      {
        this->DecodeUnit(Units[unit], owner, blocks[static_cast<std::size_t>(owner)]);
      }
    }
    return this->Values;
  }

private:
  std::size_t IndexOf(const Position& p) const
  {
    const int n = this->Edge + 1;
    return static_cast<std::size_t>((p[2] * n + p[1]) * n + p[0]);
  }

  void Set(const Position& p, std::int32_t value)
  {
    this->Values[this->IndexOf(p)] = value;
    this->Known[this->IndexOf(p)] = true;
  }

  template <class Body>
  void ForEachSample(int step, Body&& body)
  {
    for (int z = 0; z <= this->Edge; z += step)
    {
      for (int y = 0; y <= this->Edge; y += step)
      {
        for (int x = 0; x <= this->Edge; x += step)
        {
          body(Position{ x, y, z });
        }
      }
    }
  }

  void CheckReferences() const
  {
    for (const BlockCode& block : this->Code.Blocks)
    {
      const bool plain = block.Uniform || block.Same;
      const bool refers = block.Exists && (block.Same || (!plain && block.Mode / 3 != 0));
      if (refers && (this->Code.A == nullptr || (!block.Same && this->Code.B == nullptr)))
      {
        throw Error("A block refers to a step that its group does not have");
      }
    }
  }

  void PlaceCoarse()
  {
    const int n = this->Edge / 4 + 1;
    this->ForEachSample(4, [&](const Position& p)
      { this->Set(p, this->Code.Coarse[(p[2] / 4 * n + p[1] / 4) * n + p[0] / 4]); });
  }

  /// The neighbour (bits: offset in x, y, z) that a sample belongs to.
  int OwnerOf(const Position& p) const
  {
    return (p[0] == this->Edge ? 1 : 0) + (p[1] == this->Edge ? 2 : 0) +
           (p[2] == this->Edge ? 4 : 0);
  }

  void PlacePlain()
  {
    this->ForEachSample(1,
      [&](const Position& p)
      {
        const BlockCode& block = this->Code.Blocks[this->OwnerOf(p)];
        if (block.Exists && block.Same)
        {
          this->Set(p, this->Code.A[this->IndexOf(p)]);
        }
        else if (block.Exists && block.Uniform)
        {
          this->Set(p, block.Value);
        }
      });
  }

  /// By owner; empty where a block has no payload.
  std::vector<std::vector<std::int32_t>> ReadBlocks() const
  {
    std::vector<std::vector<std::int32_t>> blocks;
    for (const BlockCode& code : this->Code.Blocks)
    {
      blocks.emplace_back();
      if (code.Exists && code.Bytes > 0)
      {
        blocks.back() = ReadResiduals(
          this->Edge, this->Shared.States, code.Limit, this->Narrow(), code.Data, code.Bytes);
      }
    }
    return blocks;
  }

  /// Arithmetic wraps in 16 bits, or in 32 where the lattice is larger.
  bool Narrow() const
  {
    const std::int64_t least = this->Shared.Least;
    const std::int64_t greatest = this->Shared.Greatest;
    return least >= -8000 && greatest <= 8000 && greatest - least <= 8000;
  }
  std::int64_t Wrap(std::int64_t number) const
  {
    return this->Narrow() ? static_cast<std::int16_t>(number) : static_cast<std::int32_t>(number);
  }

  /// The number that reference m / 3 of a mode m subtracts from a sample.
  std::int64_t Reference(int mode, const Position& p) const
  {
    const auto sample = [&](const std::int32_t* box)
    { return std::int64_t{ box[this->IndexOf(p)] }; };
    switch (mode / 3)
    {
      case 1:
        return this->Wrap(sample(this->Code.A) + sample(this->Code.B) + 1) >> 1;
      case 2:
        return this->Wrap(sample(this->Code.A) + sample(this->Code.B) + 2) >> 2;
      case 3:
        return sample(this->Code.A);
      case 4:
        return sample(this->Code.B);
      default:
        return 0;
    }
  }

  /// The sample without its reference.
  std::int64_t Rest(int mode, const Position& p) const
  {
    if (!this->Known[this->IndexOf(p)])
    {
      throw Error("A sample of a block is predicted from one that is not known yet");
    }
    return this->Wrap(this->Values[this->IndexOf(p)] - this->Reference(mode, p));
  }

  std::int64_t Predict(int mode, Position at, std::size_t axis, int place, int s) const
  {
    const int start = at[axis] - place; // where the unit begins on this axis
    const auto value = [&](int i)
    {
      at[axis] = start + i;
      return this->Rest(mode, at);
    };
    const int edge = this->Edge;
    if (mode % 3 == 2)
    {
      return 0;
    }
    if (mode % 3 == 1)
    {
      return this->Wrap(value(place - s) + value(place + s) + 1) >> 1;
    }
    if (place == s)
    {
      return this->Quadratic(value(0), value(2 * s), value(4 * s));
    }
    if (place == edge - s)
    {
      return this->Quadratic(value(edge), value(edge - 2 * s), value(edge - 4 * s));
    }
    const std::int64_t middle = this->Wrap(value(place - s) + value(place + s));
    const std::int64_t outer = this->Wrap(value(place - 3 * s) + value(place + 3 * s));
    return this->Wrap(middle + 1 + (this->Wrap(middle - outer) >> 3)) >> 1;
  }

  std::int64_t Quadratic(std::int64_t near, std::int64_t other, std::int64_t far) const
  {
    const std::int64_t slope = this->Wrap(near - far + 4) >> 1;
    return this->Wrap(other + (this->Wrap(this->Wrap(near - other) + slope) >> 2));
  }

  void DecodeUnit(
    const std::vector<int>& axes, int owner, const std::vector<std::int32_t>& residuals)
  {
    const BlockCode& block = this->Code.Blocks[owner];
    for (const int axis : axes)
    {
      if ((owner >> axis & 1) != 0)
      {
        return; // lies outside the box
      }
    }
    if (block.Exists && (block.Uniform || block.Same))
    {
      return;
    }
    const int mode = block.Exists ? block.Mode : 0;
    const Position corner{ owner & 1 ? this->Edge : 0, owner & 2 ? this->Edge : 0,
      owner & 4 ? this->Edge : 0 };
    std::vector<Position> done;
    ForEachRow(this->Edge, static_cast<int>(axes.size()),
      [&](int stride, int axis, int y, int z, int first, int step)
      {
        for (int x = first; x < this->Edge; x += step)
        {
          const Position inUnit{ x, y, z };
          Position inBlock{ 0, 0, 0 };
          Position at = corner;
          for (std::size_t a = 0; a < axes.size(); ++a)
          {
            inBlock[static_cast<std::size_t>(axes[a])] = inUnit[a];
            at[static_cast<std::size_t>(axes[a])] += inUnit[a];
          }
          const std::size_t along = static_cast<std::size_t>(axes[static_cast<std::size_t>(axis)]);
          const std::int64_t rest =
            this->Predict(mode, at, along, inUnit[static_cast<std::size_t>(axis)], stride) +
            std::int64_t{
              residuals.empty()
                ? 0
                : residuals[static_cast<std::size_t>(
                    (inBlock[2] * this->Edge + inBlock[1]) * this->Edge + inBlock[0])]
            } *
              (stride == 2 ? this->Shared.CoarseBin : this->Shared.FineBin);
          this->Set(at, static_cast<std::int32_t>(this->Wrap(rest + this->Reference(mode, at))));
          done.push_back(at);
        }
      });
    // Limits come last: predictions inside the unit are made from what is not limited yet.
    for (const Position& p : done)
    {
      std::int32_t& value = this->Values[this->IndexOf(p)];
      value = std::min(std::max(value, this->Shared.Least), this->Shared.Greatest);
    }
  }

  int Edge;
  const scalar::Plane& Shared;
  const BoxCode& Code;
  std::vector<std::int32_t> Values;
  std::vector<bool> Known;
};

/// A state in the tables of the kernels.
State StateIn(const DecodeTables& tables, int context, std::uint32_t state)
{
  const bool flag = context >= residual::FlagContext;
  const int number = flag ? context - residual::FlagContext : context;
  const int classes = flag ? residual::RowClasses : residual::Classes;
  const DecodeTables::Band& band =
    tables.Bands[static_cast<std::size_t>((flag ? residual::Bands : 0) + number / classes)];
  const std::uint32_t entry =
    tables
      .Entries[band.First + std::size_t{ band.Tables[number % classes] } * tans::TableSize + state];
  const auto symbol = static_cast<std::int8_t>(entry >> residual::SymbolShift);
  return { symbol < residual::EscapeSymbol
             ? static_cast<int>(residual::Zigzag(symbol))
             : residual::DirectSymbols + symbol - residual::EscapeSymbol,
    static_cast<int>(entry & 0xffu), static_cast<int>(entry >> residual::BaseShift) };
}

} // namespace

std::vector<std::int32_t> Decode(int edge, const Plane& plane, const BoxCode& code)
{
  return Box(edge, plane, code).Decode();
}

template <class Number>
void DecodeBox(int edge, const PlaneCode& plane, const BoxCodeOf<Number>& code, Number* box)
{
  const auto numbersOf = [](const Number* from, int n)
  {
    return from == nullptr ? std::vector<std::int32_t>()
                           : std::vector<std::int32_t>(from, from + n * n * n);
  };
  const auto coarse = numbersOf(code.Coarse, edge / 4 + 1);
  const auto a = numbersOf(code.A, edge + 1);
  const auto b = numbersOf(code.B, edge + 1);
  BoxCode wide;
  std::copy(std::begin(code.Blocks), std::end(code.Blocks), std::begin(wide.Blocks));
  wide.Coarse = coarse.data();
  wide.A = code.A == nullptr ? nullptr : a.data();
  wide.B = code.B == nullptr ? nullptr : b.data();
  const auto stateOf = [&plane](int context, std::uint32_t state)
  { return StateIn(*plane.Tables, context, state); };
  const std::vector<std::int32_t> numbers =
    Decode(edge, { stateOf, plane.CoarseBin, plane.FineBin, plane.Least, plane.Greatest }, wide);
  std::transform(numbers.begin(), numbers.end(), box,
    [](std::int32_t number) { return static_cast<Number>(number); });
}

template void DecodeBox(int, const PlaneCode&, const BoxCodeOf<std::int16_t>&, std::int16_t*);
template void DecodeBox(int, const PlaneCode&, const BoxCodeOf<std::int32_t>&, std::int32_t*);

} // namespace banyan::scalar
