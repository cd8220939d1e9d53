#include "Series/GroupFormat.h"

#include "Codec/BlockEncoder.h"
#include "Codec/BlockModes.h"
#include "Codec/SymbolWriter.h"
#include "Series/Varint.h"

#include <cmath>

namespace banyan::group
{
namespace
{

constexpr std::uint8_t ModeMask = 0x0f;
constexpr std::uint8_t HasPayload = 0x10;
constexpr std::uint8_t IsPlain = 0x20; ///< mode 0: uniform; mode 1: the same as in reference A
constexpr std::uint8_t HasExceptions = 0x40;

constexpr std::uint8_t NodeNonFinite = 1;
constexpr std::uint8_t NodeNothing = 2;
constexpr std::uint8_t NodeUniform = 4;
constexpr std::uint8_t NodeExplicit = 8;
constexpr std::uint8_t NodeAged = 16;

void Append(Bytes& out, const Bytes& more)
{
  out.insert(out.end(), more.begin(), more.end());
}

template <class T>
void AppendNumber(Bytes& out, T value)
{
  const std::size_t at = out.size();
  out.resize(at + sizeof(T));
  StoreNumber(out.data() + at, value);
}

/// Places follow each other; one that does not says how far it is from where it was expected.
void PutPlace(Bytes& out, const Place& place, std::uint64_t& next)
{
  PutVarint(out, place.Bytes);
  PutSigned(out, static_cast<std::int64_t>(place.Offset - next));
  next = std::max(next, place.Offset + place.Bytes);
}

Place GetPlace(ByteReader& in, std::uint64_t& next, std::uint64_t end)
{
  const std::uint64_t bytes = in.Varint();
  const std::uint64_t offset = next + static_cast<std::uint64_t>(in.Signed());
  if (bytes == 0 || bytes > end || offset > end - bytes || offset < 64 || bytes > 0xffffffffu)
  {
    throw Error("A payload of the segment does not lie inside it");
  }
  next = std::max(next, offset + bytes);
  return { offset, static_cast<std::uint32_t>(bytes) };
}

} // namespace

Bytes PackHead(const FieldHead& head)
{
  Bytes out;
  out.insert(out.end(), head.Axes.begin(), head.Axes.end());
  out.push_back(head.Exact ? 1 : 0);
  AppendNumber(out, head.Origin);
  AppendNumber(out, head.Step);
  AppendNumber(out, head.Bin);
  AppendNumber(out, head.Least);
  AppendNumber(out, head.Greatest);
  for (const std::vector<tans::Frequencies>& set : head.Frequencies)
  {
    const Bytes packed = PackFrequencies(set);
    PutVarint(out, packed.size());
    Append(out, packed);
  }
  return out;
}

FieldHead UnpackHead(const std::uint8_t* data, std::size_t bytes)
{
  ByteReader in(data, bytes);
  FieldHead head;
  int seen = 0;
  for (std::uint8_t& axis : head.Axes)
  {
    axis = in.Byte();
    seen |= axis < 3 ? 1 << axis : 0;
  }
  const std::uint8_t flags = in.Byte();
  head.Exact = flags == 1;
  head.Origin = in.Number<double>();
  head.Step = in.Number<double>();
  head.Bin = in.Number<std::int32_t>();
  head.Least = in.Number<std::int32_t>();
  head.Greatest = in.Number<std::int32_t>();
  if (seen != 7 || flags > 1 || !std::isfinite(head.Origin) || !std::isfinite(head.Step) ||
      !(head.Step > 0) || head.Bin < 1 || head.Bin % 2 == 0 || head.Least > head.Greatest)
  {
    throw Error("The head of a field of the segment is not valid");
  }
  for (std::vector<tans::Frequencies>& set : head.Frequencies)
  {
    const std::uint64_t size = in.Varint();
    set = UnpackFrequencies(in.Skip(std::min<std::uint64_t>(size, in.Left() + 1)), size);
  }
  in.MustBeDone();
  return head;
}

std::uint64_t StepTable::MemoryBytes() const
{
  std::uint64_t bytes = this->Top.size() * sizeof(std::int32_t);
  for (const auto& plane : this->Planes)
  {
    bytes += plane.size() * sizeof(BlockEntry);
  }
  for (const auto& level : this->Levels)
  {
    bytes += level.size() * sizeof(NodeEntry);
  }
  return bytes;
}

std::vector<glm::ivec3> PlanesOf(glm::ivec3 samples)
{
  std::vector<glm::ivec3> planes{ samples };
  do
  {
    samples = CoarserSamples(samples);
    planes.push_back(samples);
  } while (std::max(samples.x, std::max(samples.y, samples.z)) > 2);
  return planes;
}

Bytes PackStep(const StepTable& table, bool first)
{
  Bytes flags;
  Bytes numbers;
  std::uint64_t next = table.FirstPayload;
  for (const auto& plane : table.Planes)
  {
    for (const BlockEntry& block : plane)
    {
      flags.push_back(static_cast<std::uint8_t>((block.Same ? 1 : block.Mode) | (block.Payload.Bytes > 0 ? HasPayload : 0) |
        (block.Uniform || block.Same ? IsPlain : 0) | (block.Exceptions.Bytes > 0 ? HasExceptions : 0)));
      if (block.Payload.Bytes > 0)
      {
        PutPlace(numbers, block.Payload, next);
      }
      if (block.Uniform)
      {
        PutSigned(numbers, block.Value);
      }
      if (block.Exceptions.Bytes > 0)
      {
        PutPlace(numbers, block.Exceptions, next);
      }
    }
  }
  Bytes nodes;
  for (const auto& level : table.Levels)
  {
    std::int64_t low = 0;
    for (const NodeEntry& node : level)
    {
      flags.push_back(static_cast<std::uint8_t>((node.HasNonFinite ? NodeNonFinite : 0) |
        (node.NothingFinite ? NodeNothing : 0) | (node.Uniform ? NodeUniform : 0) |
        (node.Explicit ? NodeExplicit : 0) | (node.Age > 0 ? NodeAged : 0)));
      if (node.Age > 0)
      {
        PutVarint(nodes, node.Age);
      }
      if (node.Explicit)
      {
        AppendNumber(nodes, node.LowValue);
        AppendNumber(nodes, node.HighValue);
      }
      else if (!node.NothingFinite)
      {
        PutSigned(nodes, node.Low - low);
        PutVarint(nodes, static_cast<std::uint64_t>(std::int64_t{ node.High } - node.Low));
        low = node.Low;
      }
      if (first && !node.Uniform)
      {
        AppendNumber(nodes, node.Content);
      }
    }
  }
  Bytes out;
  AppendNumber(out, table.FirstPayload);
  for (const std::int32_t number : table.Top)
  {
    PutSigned(out, number);
  }
  Append(out, flags);
  Append(out, numbers);
  Append(out, nodes);
  return out;
}

namespace
{

void ReadBlocks(ByteReader& in, const std::uint8_t*& flags, std::uint64_t payloadEnd, StepTable& table)
{
  std::uint64_t next = table.FirstPayload;
  for (auto& plane : table.Planes)
  {
    for (BlockEntry& block : plane)
    {
      const std::uint8_t flag = *flags++;
      block.Mode = flag & ModeMask;
      const bool plain = (flag & IsPlain) != 0;
      block.Uniform = plain && block.Mode == 0;
      block.Same = plain && block.Mode == 1;
      if (block.Mode >= block::ModeCount || (flag & 0x80) != 0 ||
          (plain && (block.Mode > 1 || (flag & HasPayload) != 0)))
      {
        throw Error("A block of the segment has an unknown mode");
      }
      if ((flag & HasPayload) != 0)
      {
        block.Payload = GetPlace(in, next, payloadEnd);
      }
      if (block.Uniform)
      {
        block.Value = in.Signed32();
      }
      if ((flag & HasExceptions) != 0)
      {
        block.Exceptions = GetPlace(in, next, payloadEnd);
      }
    }
  }
}

void ReadNode(ByteReader& in, std::uint8_t flag, bool first, int step, std::int64_t& low, NodeEntry& node)
{
  node.HasNonFinite = (flag & NodeNonFinite) != 0;
  node.NothingFinite = (flag & NodeNothing) != 0;
  node.Uniform = (flag & NodeUniform) != 0;
  node.Explicit = (flag & NodeExplicit) != 0;
  bool valid = flag < 32 && !(node.Explicit && node.NothingFinite) &&
               !(node.Uniform && (node.NothingFinite || node.HasNonFinite));
  if ((flag & NodeAged) != 0)
  {
    const std::uint64_t age = in.Varint();
    valid = valid && age > 0 && age <= static_cast<std::uint64_t>(step);
    node.Age = static_cast<std::uint32_t>(valid ? age : 0);
  }
  if (node.Explicit)
  {
    node.LowValue = in.Number<double>();
    node.HighValue = in.Number<double>();
    valid = valid && std::isfinite(node.LowValue) && std::isfinite(node.HighValue) &&
            node.LowValue <= node.HighValue;
  }
  else if (!node.NothingFinite)
  {
    const std::int64_t from = in.Signed32() + low;
    const std::uint64_t width = in.Varint();
    valid = valid && from == static_cast<std::int32_t>(from) &&
            width <= static_cast<std::uint64_t>(INT32_MAX - from);
    low = valid ? from : 0;
    node.Low = static_cast<std::int32_t>(low);
    node.High = static_cast<std::int32_t>(low + static_cast<std::int64_t>(valid ? width : 0));
  }
  if (first && !node.Uniform)
  {
    node.Content = in.Number<std::uint64_t>();
  }
  if (!valid)
  {
    throw Error("A node of the segment is not valid");
  }
}

} // namespace

StepTable UnpackStep(const std::uint8_t* data, std::size_t bytes, bool first, int step,
  const std::vector<std::size_t>& blocks, std::size_t topSamples,
  const std::vector<std::size_t>& bricks, std::uint64_t payloadEnd)
{
  ByteReader in(data, bytes);
  StepTable table;
  table.FirstPayload = in.Number<std::uint64_t>();
  if (table.FirstPayload > payloadEnd)
  {
    throw Error("The payloads of a step do not lie inside the segment");
  }
  for (std::size_t i = 0; i < topSamples; ++i)
  {
    table.Top.push_back(in.Signed32());
  }
  std::size_t count = 0;
  for (const std::size_t n : blocks)
  {
    count += n;
  }
  for (const std::size_t n : bricks)
  {
    count += n;
  }
  const std::uint8_t* flags = in.Skip(count); // before any memory is taken for them
  for (const std::size_t n : blocks)
  {
    table.Planes.emplace_back(n);
  }
  for (const std::size_t n : bricks)
  {
    table.Levels.emplace_back(n);
  }
  ReadBlocks(in, flags, payloadEnd, table);
  for (auto& level : table.Levels)
  {
    std::int64_t low = 0;
    for (NodeEntry& node : level)
    {
      ReadNode(in, *flags++, first, step, low, node);
    }
  }
  in.MustBeDone();
  return table;
}

} // namespace banyan::group
