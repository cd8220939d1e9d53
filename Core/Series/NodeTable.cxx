// SPDX-License-Identifier: BSD-3-Clause
#include "Series/NodeTable.h"

#include "Base/Error.h"
#include "Series/Zstd.h"

#include <array>
#include <cmath>

namespace banyan
{
namespace
{

constexpr std::uint8_t HasNonFiniteFlag = 1;
constexpr std::uint8_t NothingFiniteFlag = 2;

/// The columns of a table, in the order of the format.
struct Columns
{
  explicit Columns(std::size_t count)
    : Mode(count)
    , Flags(count)
    , Low(count)
    , High(count)
    , Mask(count)
    , Offset(count)
    , PayloadBytes(count)
    , IdentityLow(count)
    , IdentityHigh(count)
  {
  }

  template <class Visitor>
  void Visit(Visitor&& visit)
  {
    visit(this->Mode);
    visit(this->Flags);
    visit(this->Low);
    visit(this->High);
    visit(this->Mask);
    visit(this->Offset);
    visit(this->PayloadBytes);
    visit(this->IdentityLow);
    visit(this->IdentityHigh);
  }

  std::vector<std::uint8_t> Mode;
  std::vector<std::uint8_t> Flags;
  std::vector<std::uint64_t> Low;
  std::vector<std::uint64_t> High;
  std::vector<std::uint64_t> Mask;
  std::vector<std::uint64_t> Offset;
  std::vector<std::uint32_t> PayloadBytes;
  std::vector<std::uint64_t> IdentityLow;
  std::vector<std::uint64_t> IdentityHigh;
};

std::uint64_t EndOf(std::uint64_t offset, std::uint32_t bytes)
{
  return AlignUp(offset + bytes, segment::PayloadAlignment);
}

[[noreturn]] void Reject(const char* what)
{
  throw Error(std::string("A node table is not valid: ") + what);
}

ValueRange ReadRange(const Columns& columns, std::size_t i, ScalarType type)
{
  const std::uint64_t low = columns.Low[i];
  if ((columns.Flags[i] & NothingFiniteFlag) != 0)
  {
    if ((columns.Flags[i] & HasNonFiniteFlag) == 0 || low != 0 || columns.High[i] != 0)
    {
      Reject("a brick without finite samples has a range");
    }
    return {};
  }
  const ValueRange range = { BitCast<double>(low), BitCast<double>(low ^ columns.High[i]) };
  if (!std::isfinite(range.Low) || !std::isfinite(range.High) || range.Low > range.High)
  {
    Reject("the range of a brick is not a range");
  }
  if (columns.Mode[i] == 0 && (columns.High[i] != 0 || !HoldsExactly(type, range.Low)))
  {
    Reject("the value of a macro voxel does not fit its type");
  }
  return range;
}

void ReadPayload(const Columns& columns, std::size_t i, std::uint64_t payloadEnd,
  std::uint64_t& expected, BrickNode& node, PayloadReference& payload)
{
  const std::uint64_t offset = expected + columns.Offset[i];
  const std::uint32_t bytes = columns.PayloadBytes[i];
  if (bytes == 0 || offset < segment::HeaderBytes || offset % segment::PayloadAlignment != 0 ||
      offset > payloadEnd || bytes > payloadEnd - offset)
  {
    Reject("a payload lies outside its section");
  }
  payload.Offset = offset;
  node.PayloadBytes = bytes;
  node.Identity = { columns.IdentityLow[i], columns.IdentityHigh[i] };
  expected = EndOf(offset, bytes);
}

Columns ReadColumns(const std::uint8_t* stored, const segment::TableEntry& entry, std::size_t count)
{
  Bytes raw(static_cast<std::size_t>(entry.RawBytes));
  Decompress(stored, static_cast<std::size_t>(entry.StoredBytes), raw.data(), raw.size());
  Columns columns(count);
  const std::uint8_t* from = raw.data();
  columns.Visit(
    [&from, count](auto& column)
    {
      FromPlanes(from, count, column.data());
      from += count * sizeof(column[0]);
    });
  return columns;
}

} // namespace

PayloadIdentity MacroVoxelIdentity(ScalarType type, const glm::ivec3& samples, double value)
{
  std::uint8_t payload[8];
  StoreNumber(payload, value);
  const Hash128 hash =
    IdentityOf(static_cast<std::uint8_t>(BrickMode::MacroVoxel), payload, 8, {}, type, samples);
  return { hash.Low, hash.High };
}

NodeTable UnpackNodeTable(const std::uint8_t* stored, const segment::TableEntry& entry,
  const BrickLayout& layout, ScalarType type, std::uint64_t payloadEnd)
{
  const std::size_t count = static_cast<std::size_t>(layout.BrickCount());
  if (entry.RawBytes != count * segment::NodeBytes ||
      entry.RawBytes / segment::GreatestExpansion > entry.StoredBytes)
  {
    throw Error("A node table does not have the size that the grid needs",
      { {}, {}, entry.RawBytes, count * segment::NodeBytes });
  }
  const Columns columns = ReadColumns(stored, entry, count);
  NodeTable table;
  table.Nodes.resize(count);
  table.Payloads.resize(count);
  std::uint64_t expected = segment::HeaderBytes;
  for (std::size_t i = 0; i < count; ++i)
  {
    BrickNode& node = table.Nodes[i];
    table.Payloads[i].Mode = columns.Mode[i];
    if (columns.Flags[i] > (HasNonFiniteFlag | NothingFiniteFlag))
    {
      Reject("a brick has unknown flags");
    }
    node.HasNonFinite = (columns.Flags[i] & HasNonFiniteFlag) != 0;
    node.Uniform = columns.Mode[i] == static_cast<std::uint8_t>(BrickMode::MacroVoxel);
    node.Range = ReadRange(columns, i, type);
    node.Mask = columns.Mask[i];
    if (!node.Uniform)
    {
      ReadPayload(columns, i, payloadEnd, expected, node, table.Payloads[i]);
      continue;
    }
    if (node.HasNonFinite || columns.PayloadBytes[i] != 0)
    {
      Reject("a macro voxel has a payload or is not finite");
    }
    const glm::ivec3 samples = layout.SamplesOf(static_cast<std::int64_t>(i)).Size();
    node.Identity = MacroVoxelIdentity(type, samples, node.Range.Low);
  }
  return table;
}

void TranslateMasks(NodeTable& table, const MaskRange& from, const MaskRange& to)
{
  if (from.Low == to.Low && from.High == to.High)
  {
    return;
  }
  // One more bin on either side pays for the rounding of the edges; clipping to each brick's own
  // range afterwards takes most of it back, and is right because interpolants stay within it.
  std::array<ValueMask, 64> meaning{};
  const double width = from.High - from.Low;
  for (int bin = 0; bin < 64; ++bin)
  {
    const double low = from.Low + width * ((bin - 0.01) / 64.0);
    const double high = from.Low + width * ((bin + 1.01) / 64.0);
    const bool usable = std::isfinite(width) && width > 0;
    const int first = bin == 0 || !usable ? 0 : to.BinOf(low);
    const int last = bin == 63 || !usable ? 63 : to.BinOf(high);
    meaning[static_cast<std::size_t>(bin)] = MaskOfBins(first, last);
  }
  for (BrickNode& node : table.Nodes)
  {
    if (node.Range.Empty())
    {
      continue;
    }
    ValueMask mask = 0;
    for (int bin = 0; bin < 64; ++bin)
    {
      mask |= (node.Mask >> bin & 1) != 0 ? meaning[static_cast<std::size_t>(bin)] : 0;
    }
    node.Mask = mask & MaskOfBins(to.BinOf(node.Range.Low), to.BinOf(node.Range.High));
  }
}

} // namespace banyan
