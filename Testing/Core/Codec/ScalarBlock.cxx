#include "Codec/ScalarBlock.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>

namespace banyan::testing
{
namespace
{

using Position = std::array<int, 3>;

/// Reads a payload bit by bit, lowest bit of a byte first.
class BitReader
{
public:
  BitReader(const std::uint8_t* data, std::size_t bytes)
    : Data(data)
    , Bits(8 * bytes)
  {
  }

  std::uint32_t Take(int count)
  {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i)
    {
      if (this->Next == this->Bits)
      {
        throw std::runtime_error("the payload ends too early");
      }
      value |= static_cast<std::uint32_t>(this->Data[this->Next / 8] >> this->Next % 8 & 1) << i;
      ++this->Next;
    }
    return value;
  }

  std::size_t Left() const { return this->Bits - this->Next; }

private:
  const std::uint8_t* Data;
  std::size_t Bits;
  std::size_t Next = 0;
};

/// The table of one context: what each of the 1024 states decodes to.
struct State
{
  int Symbol;
  int Bits;
  int Base;
};

std::vector<State> StatesOf(const tans::Frequencies& frequencies)
{
  std::vector<int> symbolAt(1024, 0);
  int place = 0;
  bool any = false;
  for (int symbol = 0; symbol < 72; ++symbol)
  {
    for (int i = 0; i < frequencies.Count[symbol]; ++i)
    {
      symbolAt[static_cast<std::size_t>(place)] = symbol;
      place = (place + 643) % 1024;
      any = true;
    }
  }
  std::vector<State> states(1024, { 0, 0, 0 });
  std::array<int, 72> seen = {};
  for (std::size_t i = 0; any && i < 1024; ++i)
  {
    const int symbol = symbolAt[i];
    const int number = frequencies.Count[symbol] + seen[static_cast<std::size_t>(symbol)]++;
    int bits = 0;
    while (number * (1 << bits) < 1024)
    {
      ++bits;
    }
    states[i] = { symbol, bits, number * (1 << bits) - 1024 };
  }
  return states;
}

/// Symbols of a payload: four states take turns.
class Symbols
{
public:
  Symbols(
    const std::vector<std::vector<State>>& tables, const std::uint8_t* data, std::size_t bytes)
    : Tables(tables)
    , Bits(data, bytes)
  {
    for (std::uint32_t& state : this->States)
    {
      state = this->Bits.Take(10);
    }
  }

  int Next(int context)
  {
    std::uint32_t& state = this->States[this->Count++ % 4];
    const State& entry = this->Tables[static_cast<std::size_t>(context)][state];
    state = static_cast<std::uint32_t>(entry.Base) + this->Bits.Take(entry.Bits);
    return entry.Symbol;
  }

  /// 0, 1, -1, 2, -2, ... by code.
  std::int32_t Residual(int context)
  {
    const int symbol = this->Next(context);
    const std::uint32_t code =
      symbol < 40 ? static_cast<std::uint32_t>(symbol)
                  : 39u + (std::uint32_t{ 1 } << (symbol - 40)) + this->Bits.Take(symbol - 40);
    return static_cast<std::int32_t>(code % 2 == 0 ? code / 2 : 0u - (code / 2 + code % 2));
  }

  void MustBeAtEnd() const
  {
    for (const std::uint32_t state : this->States)
    {
      if (state != 0)
      {
        throw std::runtime_error("a state does not end where encoding began");
      }
    }
    if (this->Bits.Left() >= 8)
    {
      throw std::runtime_error("the payload is too long");
    }
  }

private:
  const std::vector<std::vector<State>>& Tables;
  BitReader Bits;
  std::array<std::uint32_t, 4> States = {};
  std::size_t Count = 0;
};

/// The magnitude of a residual is the number of the last of these that it reaches, plus 2, or 0.
int MagnitudeOf(std::int32_t residual)
{
  const std::int64_t size = residual < 0 ? -std::int64_t{ residual } : residual;
  int magnitude = 0;
  for (const int limit : { 1, 2, 3, 4, 6, 9, 13, 20, 27, 39, 55 })
  {
    magnitude += size >= limit ? (magnitude == 0 ? 2 : 1) : 0;
  }
  return magnitude;
}

/// Axes of the units in the order of the payload.
const std::vector<std::vector<int>> Units = { { 0 }, { 1 }, { 2 }, { 0, 1 }, { 0, 2 }, { 1, 2 },
  { 0, 1, 2 } };

/// The passes of a unit, and the rows of each: what a payload is read in, and samples predicted in.
/// @param body called as body(stride, axis, y, z, first, step): the samples x = first, first +
/// step,
/// ... of the row
template <class Body>
void ForEachRow(int edge, int dimensions, Body&& body)
{
  for (int stride = 2; stride >= 1; --stride)
  {
    for (int axis = 0; axis < dimensions; ++axis)
    {
      // Finished axes have all multiples of the stride, those to come only every second one.
      Position first{ 0, 0, 0 };
      Position step{ edge, edge, edge };
      for (int a = 0; a < dimensions; ++a)
      {
        const std::size_t i = static_cast<std::size_t>(a);
        first[i] = a <= axis ? stride : 2 * stride;
        step[i] = a < axis ? stride : 2 * stride;
      }
      for (int z = first[2]; z < edge; z += step[2])
      {
        for (int y = first[1]; y < edge; y += step[1])
        {
          body(stride, axis, y, z, first[0], step[0]);
        }
      }
    }
  }
}

/// The residuals of one block: all samples that it owns, whatever unit they belong to.
class Block
{
public:
  explicit Block(int edge)
    : Edge(edge)
    , Residuals(static_cast<std::size_t>(edge * edge * edge), 0)
  {
  }

  std::int32_t& At(const Position& p)
  {
    return this
      ->Residuals[static_cast<std::size_t>((p[2] * this->Edge + p[1]) * this->Edge + p[0])];
  }

  void Read(const glm::ivec3& limit, Symbols& symbols)
  {
    for (const std::vector<int>& axes : Units)
    {
      ForEachRow(this->Edge, static_cast<int>(axes.size()),
        [&](int stride, int axis, int y, int z, int first, int step) {
          this->ReadRow(axes, limit, stride, axis, { first, y, z }, step, symbols);
        });
    }
  }

private:
  static Position InBlock(const std::vector<int>& axes, const Position& inUnit)
  {
    Position p{ 0, 0, 0 };
    for (std::size_t a = 0; a < axes.size(); ++a)
    {
      p[static_cast<std::size_t>(axes[a])] = inUnit[a];
    }
    return p;
  }

  void ReadRow(const std::vector<int>& axes, const glm::ivec3& limit, int stride, int axis,
    Position at, int step, Symbols& symbols)
  {
    const int dimensions = static_cast<int>(axes.size());
    const auto inside = [&](const Position& inUnit)
    {
      const Position p = InBlock(axes, inUnit);
      bool is = true;
      for (std::size_t a = 0; a < axes.size(); ++a)
      {
        const int real = axes[a];
        is = is && p[static_cast<std::size_t>(real)] <= limit[real];
      }
      return is;
    };
    if (!inside(at))
    {
      return; // not even its first sample lies in the field
    }
    const int band = dimensions == 1   ? 2 - stride
                     : dimensions == 2 ? (stride == 2 ? 2 : 3 + axis)
                                       : (stride == 2 ? 5 : 8) + axis;
    bool smooth = true;
    for (int x = 0; x < this->Edge; ++x)
    {
      smooth = smooth && this->Roughness(axes, stride, axis, { x, at[1], at[2] }) == 0;
    }
    if (smooth && symbols.Next(88 + band) != 0)
    {
      return;
    }
    std::vector<std::int32_t> row;
    for (Position p = at; p[0] < this->Edge && inside(p); p[0] += step)
    {
      const int roughness = this->Roughness(axes, stride, axis, p);
      int contextClass = 0;
      for (const int limitOfClass : { 0, 3, 8, 15, 25, 38, 60 })
      {
        contextClass += roughness > limitOfClass ? 1 : 0;
      }
      row.push_back(symbols.Residual(8 * band + contextClass));
    }
    // Residuals of a row are no context for the same row.
    for (std::size_t i = 0; i < row.size(); ++i)
    {
      this->At(InBlock(axes, { at[0] + static_cast<int>(i) * step, at[1], at[2] })) = row[i];
    }
  }

  /// Weighted sum of magnitudes around a sample of a unit.
  int Roughness(const std::vector<int>& axes, int s, int axis, const Position& at)
  {
    const int dimensions = static_cast<int>(axes.size());
    const auto m = [&](int x, int y, int z) {
      return x < 0 || x >= this->Edge ? 0 : MagnitudeOf(this->At(InBlock(axes, { x, y, z })));
    };
    // The next row of that axis, or the one before where there is none.
    const auto next = [&](int position, int step)
    { return position + step < this->Edge ? position + step : position - step; };
    const auto [x, y, z] = at;
    int sum = 0;
    if (axis == 0)
    {
      sum += 2 * (m(x - s, y, z) + m(x + s, y, z));
      if (dimensions > 1)
      {
        const int before = y - 2 * s;
        const int after = next(y, 2 * s);
        sum += m(x - s, before, z) + m(x + s, before, z) + 2 * m(x, before, z);
        sum += m(x - s, after, z) + m(x + s, after, z);
      }
      if (dimensions > 2)
      {
        const int before = z - 2 * s;
        const int after = next(z, 2 * s);
        sum += m(x - s, y, before) + m(x + s, y, before) + 2 * m(x, y, before);
        sum += m(x - s, y, after) + m(x + s, y, after);
      }
      return sum;
    }
    if (axis == 1)
    {
      for (const int end : { y - s, next(y, s) })
      {
        sum += 2 * m(x, end, z) + m(x - s, end, z) + m(x + s, end, z);
        sum += dimensions > 2 ? m(x, end, z - 2 * s) + m(x, end, next(z, 2 * s)) : 0;
      }
      sum +=
        y >= 2 * s ? 2 * m(x, y - 2 * s, z) + m(x - s, y - 2 * s, z) + m(x + s, y - 2 * s, z) : 0;
    }
    else
    {
      for (const int end : { z - s, next(z, s) })
      {
        sum += 2 * m(x, y, end) + m(x - s, y, end) + m(x + s, y, end);
        sum += m(x, y - s, end) + m(x, next(y, s), end);
      }
      sum += 2 * m(x, y - s, z) + m(x - s, y - s, z) + m(x + s, y - s, z);
    }
    sum += dimensions > 2 && z >= 2 * s ? 2 * m(x, y, z - 2 * s) : 0;
    return sum;
  }

  int Edge;
  std::vector<std::int32_t> Residuals;
};

/// All samples of a box, and which of them are known.
class Box
{
public:
  Box(int edge, const ScalarPlane& plane, const BoxCode& code)
    : Edge(edge)
    , Plane(plane)
    , Code(code)
    , Values(static_cast<std::size_t>((edge + 1) * (edge + 1) * (edge + 1)), 0)
    , Known(this->Values.size(), false)
  {
  }

  std::vector<std::int32_t> Decode()
  {
    this->PlaceCoarse();
    this->PlacePlain();
    std::vector<Block> blocks = this->ReadBlocks();
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

  std::vector<Block> ReadBlocks() const
  {
    std::vector<std::vector<State>> tables;
    for (const tans::Frequencies& context : this->Plane.Frequencies)
    {
      tables.push_back(StatesOf(context));
    }
    std::vector<Block> blocks;
    for (const BlockCode& code : this->Code.Blocks)
    {
      blocks.emplace_back(this->Edge);
      if (code.Exists && code.Bytes > 0)
      {
        Symbols symbols(tables, code.Data, code.Bytes);
        blocks.back().Read(code.Limit, symbols);
        symbols.MustBeAtEnd();
      }
    }
    return blocks;
  }

  /// What mode m / 3 subtracts from a sample.
  std::int64_t Reference(int mode, const Position& p) const
  {
    const auto sample = [&](const std::int32_t* box)
    { return std::int64_t{ box[this->IndexOf(p)] }; };
    switch (mode / 3)
    {
      case 1:
        return (sample(this->Code.A) + sample(this->Code.B) + 1) >> 1;
      case 2:
        return (sample(this->Code.A) + sample(this->Code.B) + 2) >> 2;
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
      throw std::logic_error("a prediction uses a sample that is not known yet");
    }
    return this->Values[this->IndexOf(p)] - this->Reference(mode, p);
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
      return (value(place - s) + value(place + s) + 1) >> 1;
    }
    if (place == s)
    {
      return (3 * value(0) + 6 * value(2 * s) - value(4 * s) + 4) >> 3;
    }
    if (place == edge - s)
    {
      return (3 * value(edge) + 6 * value(edge - 2 * s) - value(edge - 4 * s) + 4) >> 3;
    }
    return (9 * (value(place - s) + value(place + s)) - value(place - 3 * s) -
             value(place + 3 * s) + 8) >>
           4;
  }

  void DecodeUnit(const std::vector<int>& axes, int owner, Block& residuals)
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
            std::int64_t{ residuals.At(inBlock) } *
              (stride == 2 ? this->Plane.CoarseBin : this->Plane.FineBin);
          this->Set(at, static_cast<std::int32_t>(rest + this->Reference(mode, at)));
          done.push_back(at);
        }
      });
    // Limits come last: predictions inside the unit are made from what is not limited yet.
    for (const Position& p : done)
    {
      std::int32_t& value = this->Values[this->IndexOf(p)];
      value = std::min(std::max(value, this->Plane.Least), this->Plane.Greatest);
    }
  }

  int Edge;
  const ScalarPlane& Plane;
  const BoxCode& Code;
  std::vector<std::int32_t> Values;
  std::vector<bool> Known;
};

} // namespace

std::vector<std::int32_t> DecodeBoxSlowly(int edge, const ScalarPlane& plane, const BoxCode& code)
{
  return Box(edge, plane, code).Decode();
}

} // namespace banyan::testing
