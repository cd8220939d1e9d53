// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/BlockModes.h"
#include "Series/Format/AdaptiveBits.h"
#include "Series/Format/GroupFormat.h"
#include "Series/Format/StepNeighbours.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace banyan::group
{
namespace
{

/// A block costs more than 1 / BlocksPerByte bytes, whatever is known of it.
constexpr std::size_t BlocksPerByte = 16384;

constexpr int SizeClasses = 14;

/// A reader of version 1 refuses a table with any other mode, and says that it is damaged.
constexpr int ModesOfVersion1 = 15;
static_assert(block::ModeCount == ModesOfVersion1,
  "Files with a further mode need a feature, by which older readers refuse them: see 'Adding a "
  "block mode' in Core/Codec/README.md");

constexpr int ModeBits = 4;
static_assert(block::ModeCount <= 1 << ModeBits, "the number of a mode is a tree of so many bits");

std::uint8_t FlagsOf(const NodeEntry& node)
{
  return static_cast<std::uint8_t>((node.HasNonFinite ? 1 : 0) | (node.NothingFinite ? 2 : 0) |
                                   (node.Uniform ? 4 : 0) | (node.Explicit ? 8 : 0));
}

int LengthOf(std::uint64_t value)
{
  int length = 0;
  for (; value != 0; value >>= 1)
  {
    ++length;
  }
  return length;
}

/// Writes or reads a table, whichever the coder does.
template <class Coder>
class StepCode
{
public:
  StepCode(Coder& coder, const TableShape& shape, int step, const TableReference& reference,
    std::uint64_t payloadEnd, StepTable& table)
    : Code(coder)
    , Shape(shape)
    , Step(step)
    , Reference(reference)
    , PayloadEnd(payloadEnd)
    , Table(table)
  {
  }

  void Run()
  {
    StepTable& table = this->Table;
    table.FirstPayload = this->Number64(table.FirstPayload);
    if (Coder::Reads && table.FirstPayload > this->PayloadEnd)
    {
      throw Error("The payloads of a step do not lie inside the segment");
    }
    this->Next = table.FirstPayload;
    std::int32_t before = 0;
    for (std::size_t i = 0; i < table.Top.size(); ++i)
    {
      std::int32_t& number = table.Top[i];
      number = this->TopNumbers.Near(
        this->Code, number, this->Reference.Table ? this->Reference.Table->Top[i] : before);
      before = number;
    }
    for (std::size_t p = 0; p < table.Planes.size(); ++p)
    {
      const Neighbours<BlockEntry> neighbours(table.Planes[p], this->Shape.Blocks[p]);
      for (std::size_t b = 0; b < table.Planes[p].size(); ++b)
      {
        this->Block(neighbours, p, b);
      }
    }
    for (std::size_t level = 0; level < table.Levels.size(); ++level)
    {
      for (std::size_t b = 0; b < table.Levels[level].size(); ++b)
      {
        this->Node(level, b);
      }
    }
  }

private:
  std::uint64_t Number64(std::uint64_t value)
  {
    const int bits = static_cast<int>(
      bits::Raw(this->Code, 7, static_cast<std::uint64_t>(Coder::Reads ? 0 : LengthOf(value))));
    if (bits > 64)
    {
      throw Error("A table of the segment holds a number that is out of range");
    }
    return bits::Raw(this->Code, bits, value);
  }

  /// Places follow each other; one that does not says how far it is from where it was expected.
  void CodePlace(bits::Numbers& sizes, Place& place)
  {
    place.Bytes = sizes.Code(this->Code, place.Bytes);
    const bool follows = this->Code.Bit(this->Follows, place.Offset == this->Next);
    place.Offset = follows ? this->Next : this->Next + this->Number64(place.Offset - this->Next);
    if (Coder::Reads && (place.Bytes == 0 || place.Bytes > this->PayloadEnd || place.Offset < 64 ||
                          place.Offset > this->PayloadEnd - place.Bytes))
    {
      throw Error("A payload of the segment does not lie inside it");
    }
    this->Next = std::max(this->Next, place.Offset + place.Bytes);
  }

  void Block(const Neighbours<BlockEntry>& neighbours, std::size_t plane, std::size_t index)
  {
    BlockEntry& block = this->Table.Planes[plane][index];
    const BlockEntry* const reference =
      this->Reference.Table ? &this->Reference.Table->Planes[plane][index] : nullptr;
    std::size_t payloads = 0, plains = 0, exceptions = 0;
    std::uint64_t bytes = 0, count = 0;
    const auto see = [&](const BlockEntry& other)
    {
      payloads += other.Payload.Bytes > 0 ? 1 : 0;
      plains += other.Uniform || other.Same ? 1 : 0;
      exceptions += other.Exceptions.Bytes > 0 ? 1 : 0;
      bytes += other.Payload.Bytes;
      ++count;
    };
    neighbours.ForEach(index, see);
    const std::size_t there = reference == nullptr ? 0 : reference->Payload.Bytes > 0 ? 2 : 1;
    const bool payload = this->Code.Bit(this->HasPayload[there][payloads], block.Payload.Bytes > 0);
    const bool plain =
      !payload && this->Code.Bit(this->IsPlain[plains], block.Uniform || block.Same);
    const bool exceptional =
      this->Code.Bit(this->HasExceptions[exceptions], block.Exceptions.Bytes > 0);
    if (plain)
    {
      block.Same = this->Code.Bit(this->IsSame, block.Same);
      block.Uniform = !block.Same;
      block.Mode = block.Same ? 1 : 0;
    }
    else
    {
      block.Mode = static_cast<std::uint8_t>(
        bits::Tree(this->Code, this->Modes[payload ? 1 : 0].data(), ModeBits, block.Mode));
    }
    if (block.Mode >= block::ModeCount)
    {
      throw Error("A block of the segment has an unknown mode");
    }
    if (payload)
    {
      std::uint64_t expected = count > 0 ? bytes / count : 0;
      if (reference)
      {
        expected = count > 0 ? (expected + reference->Payload.Bytes) / 2 : reference->Payload.Bytes;
      }
      this->CodePlace(
        this->Sizes[static_cast<std::size_t>(std::min(LengthOf(expected), SizeClasses - 1))],
        block.Payload);
    }
    if (block.Uniform)
    {
      block.Value = this->Values.Near(this->Code, block.Value, this->LastValue);
      this->LastValue = block.Value;
    }
    if (exceptional)
    {
      this->CodePlace(this->ExceptionSizes, block.Exceptions);
    }
  }

  /// Without wrapping: sums and differences of 32-bit numbers.
  static std::int32_t Wrap(std::int64_t value)
  {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(value));
  }

  void CodeExtremes(
    std::size_t level, std::size_t index, const NodeEntry* reference, NodeEntry& node)
  {
    const Extremes children = ChildrenOf(this->Table, this->Shape, level, index);
    Extremes expected = children;
    if (reference != nullptr && HasNumbers(*reference))
    {
      expected = { true, reference->Low, reference->High };
      const Extremes before = ChildrenOf(*this->Reference.Table, this->Shape, level, index);
      if (children.Known && before.Known)
      {
        // The part of its children's extremes that a coarser brick misses changes little.
        expected.Low = Wrap(std::int64_t{ children.Low } + reference->Low - before.Low);
        expected.High = Wrap(std::int64_t{ children.High } + reference->High - before.High);
      }
    }
    else if (!children.Known)
    {
      std::int64_t low = 0, high = 0, count = 0;
      Neighbours<NodeEntry>(this->Table.Levels[level], this->Shape.Bricks[level])
        .ForEach(index,
          [&](const NodeEntry& other)
          {
            if (HasNumbers(other))
            {
              low += other.Low;
              high += other.High;
              ++count;
            }
          });
      if (count > 0)
      {
        expected = { true, Wrap(low / count), Wrap(high / count) };
      }
    }
    const std::size_t kind = (level > 0 ? 2 : 0) + (reference != nullptr ? 1 : 0);
    node.Low = this->Lows[kind].Near(this->Code, node.Low, expected.Low);
    node.High =
      node.Uniform ? node.Low : this->Highs[kind].Near(this->Code, node.High, expected.High);
  }

  void Node(std::size_t level, std::size_t index)
  {
    NodeEntry& node = this->Table.Levels[level][index];
    const NodeEntry* const reference =
      this->Reference.Table ? &this->Reference.Table->Levels[level][index] : nullptr;
    const int since = this->Reference.Step - this->Step;
    const bool derived =
      reference != nullptr && since > 0 && reference->Age >= static_cast<std::uint32_t>(since);
    const std::uint64_t content = node.Content;
    if (derived)
    {
      node = *reference;
      node.Age -= static_cast<std::uint32_t>(since);
    }
    else
    {
      this->CodeNode(level, index, reference, node);
    }
    node.Content = 0;
    if (!node.Uniform && (this->Step == 0 || this->Reference.Table == nullptr))
    {
      this->CodeContent(derived || node.Age > 0, content, node);
    }
  }

  /// @param rests whether the brick is the same as one step later, or earlier
  void CodeContent(bool rests, std::uint64_t content, NodeEntry& node)
  {
    if (this->Code.Bit(this->HasContent[rests ? 1 : 0][this->LastContent ? 1 : 0], content != 0))
    {
      node.Content = bits::Raw(this->Code, ContentBits, content);
    }
    this->LastContent = node.Content != 0;
  }

  void CodeNode(std::size_t level, std::size_t index, const NodeEntry* reference, NodeEntry& node)
  {
    const std::size_t context =
      (this->LastFlags != 0 ? 1 : 0) + (reference != nullptr && FlagsOf(*reference) != 0 ? 2 : 0);
    const std::uint32_t flags =
      bits::Tree(this->Code, this->NodeFlags[context].data(), 4, FlagsOf(node));
    this->LastFlags = flags;
    node.HasNonFinite = (flags & 1) != 0;
    node.NothingFinite = (flags & 2) != 0;
    node.Uniform = (flags & 4) != 0;
    node.Explicit = (flags & 8) != 0;
    bool valid = !(node.Explicit && node.NothingFinite) &&
                 !(node.Uniform && (node.NothingFinite || node.HasNonFinite));
    node.Age = static_cast<std::uint32_t>(
      this->Ages.Near(this->Code, static_cast<std::int32_t>(node.Age), this->LastAge));
    valid = valid && node.Age <= static_cast<std::uint32_t>(this->Step);
    this->LastAge = static_cast<std::int32_t>(node.Age);
    if (node.Explicit)
    {
      node.LowValue = this->RealExtremes.Code(this->Code, 0, node.LowValue);
      node.HighValue = this->RealExtremes.Code(this->Code, 1, node.HighValue);
      valid = valid && std::isfinite(node.LowValue) && std::isfinite(node.HighValue) &&
              node.LowValue <= node.HighValue;
    }
    else if (!node.NothingFinite)
    {
      this->CodeExtremes(level, index, reference, node);
      valid = valid && node.Low <= node.High;
    }
    if (!valid)
    {
      throw Error("A node of the segment is not valid");
    }
  }

  Coder& Code;
  const TableShape& Shape;
  int Step;
  TableReference Reference;
  std::uint64_t PayloadEnd;
  StepTable& Table;

  std::uint64_t Next = 0; ///< where the next payload is expected
  std::int32_t LastValue = 0;
  std::int32_t LastAge = 0;
  std::uint32_t LastFlags = 0;
  bool LastContent = false;

  bits::Numbers TopNumbers, Values, ExceptionSizes, Ages;
  bits::Numbers Sizes[SizeClasses], Lows[4], Highs[4];
  bits::Model Follows, IsSame, HasPayload[3][4], IsPlain[4], HasExceptions[4];
  bits::Model HasContent[2][2];
  bits::Reals RealExtremes;
  std::array<bits::Model, 1 << ModeBits> Modes[2];
  std::array<bits::Model, 16> NodeFlags[4];
};

std::size_t CountOf(const glm::ivec3& size)
{
  return static_cast<std::size_t>(std::int64_t{ size.x } * size.y * size.z);
}

} // namespace

Bytes PackStep(
  const StepTable& table, const TableShape& shape, int step, const TableReference& reference)
{
  bits::Writer writer;
  StepTable copy = table; // coding goes both ways
  std::make_unique<StepCode<bits::Writer>>(writer, shape, step, reference, UINT64_MAX, copy)->Run();
  return writer.Finish();
}

StepTable UnpackStep(const std::uint8_t* data, std::size_t bytes, const TableShape& shape, int step,
  const TableReference& reference, std::uint64_t payloadEnd)
{
  std::size_t blocks = 0;
  for (const glm::ivec3& size : shape.Blocks)
  {
    blocks += CountOf(size);
  }
  if (blocks / BlocksPerByte > bytes) // before any memory is taken for them
  {
    throw Error("A table of the segment is too short for its blocks");
  }
  StepTable table;
  table.Top.resize(CountOf(shape.Planes.back()));
  for (const glm::ivec3& size : shape.Blocks)
  {
    table.Planes.emplace_back(CountOf(size));
  }
  for (const glm::ivec3& size : shape.Bricks)
  {
    table.Levels.emplace_back(CountOf(size));
  }
  bits::Reader reader(data, bytes);
  std::make_unique<StepCode<bits::Reader>>(reader, shape, step, reference, payloadEnd, table)
    ->Run();
  reader.MustBeDone();
  return table;
}

} // namespace banyan::group
