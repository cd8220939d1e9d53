// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Octree/HexBrickSummary.h"

#include "Base/ThreadPool.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <vector>

namespace banyan
{
namespace
{

/// Returns the range of the finite ones among eight corners.
ValueRange RangeOfElement(const double (&corners)[8], bool& special)
{
  ValueRange range;
  for (const double value : corners)
  {
    if (std::isfinite(value))
    {
      range.Include(value);
    }
    special = special || !std::isfinite(value);
  }
  return range;
}

std::size_t Index(std::int64_t i)
{
  return static_cast<std::size_t>(i);
}

/// A hash of the values at the corners of elements, one after the other.
/// @tparam Value that has the bits of the field's values
template <class Value>
class CornersHash
{
public:
  explicit CornersHash(const Hash128& elements)
    : Hash(elements)
  {
  }

  void Add(const double (&corners)[8])
  {
    std::transform(std::begin(corners), std::end(corners), this->Next,
      [](double value) { return static_cast<Value>(value); });
    this->Next += 8;
    if (this->Next == std::end(this->Pending))
    {
      this->Fold();
    }
  }

  Hash128 Get()
  {
    this->Fold();
    return this->Hash;
  }

private:
  void Fold()
  {
    const auto bytes = static_cast<std::size_t>(this->Next - this->Pending) * sizeof(Value);
    const Hash128 next = HashOf(this->Pending, bytes, this->Hash.Low);
    this->Hash = { next.Low, next.High ^ this->Hash.High * 3 };
    this->Next = this->Pending;
  }

  Hash128 Hash;
  Value Pending[8 * 64];
  Value* Next = this->Pending;
};

/// Values of an element.
template <class Value>
struct Span
{
  Value Low;
  Value High; ///< below Low where nothing is finite
};

ValueMask MaskOf(const MaskRange& over, const ValueRange& range)
{
  return range.Empty() ? ValueMask{ 0 } : MaskOfBins(over.BinOf(range.Low), over.BinOf(range.High));
}

/// @param total the range of all elements of the brick
/// @param spans of the elements of all bricks
template <class Value>
ValueMask MaskOfBrick(
  const MaskRange& over, const HexBrick& brick, const ValueRange& total, const Span<Value>* spans)
{
  if (total.Empty() || over.BinOf(total.High) - over.BinOf(total.Low) <= 1)
  {
    return MaskOf(over, total);
  }
  ValueMask mask = 0;
  for (std::int64_t leaf = brick.FirstLeaf; leaf < brick.EndLeaf; ++leaf)
  {
    const Span<Value>& span = spans[Index(leaf)];
    mask |= MaskOf(over, { span.Low, span.High });
  }
  return mask;
}

/// Ranges, then masks over the range of all. The elements are read once: what they span is kept in
/// between.
template <class Value>
HexBrickSummary Summarize(const HexBricks& bricks, const NodalField& values, ThreadPool& pool)
{
  const std::vector<HexBrick>& list = bricks.List();
  const auto count = static_cast<std::int64_t>(list.size());
  std::vector<Hash128> contents(list.size());
  std::vector<ValueRange> ranges(list.size());
  std::vector<ValueMask> masks(list.size());
  std::vector<std::uint8_t> specials(list.size());
  // Not set to zero, which would be one thread's work.
  const std::unique_ptr<Span<Value>[]> spans(new Span<Value>[Index(bricks.Tree().LeafCount())]);
  pool.ParallelFor(count,
    [&](std::int64_t number)
    {
      ValueRange total;
      bool special = false;
      const HexBrick& brick = list[Index(number)];
      CornersHash<Value> content(brick.Leaves);
      values.ForCorners(brick.FirstLeaf, brick.EndLeaf,
        [&](std::int64_t leaf, const double(&corners)[8])
        {
          const ValueRange range = RangeOfElement(corners, special);
          spans[Index(leaf)] = { static_cast<Value>(range.Low), static_cast<Value>(range.High) };
          total.Include(range);
          content.Add(corners);
        });
      contents[Index(number)] = content.Get();
      ranges[Index(number)] = total;
      specials[Index(number)] = special ? 1 : 0;
    });
  ValueRange all;
  for (const ValueRange& range : ranges)
  {
    all.Include(range);
  }
  HexBrickSummary summary;
  summary.Over = all.Empty() ? MaskRange{} : MaskRange{ all.Low, all.High };
  pool.ParallelFor(count,
    [&](std::int64_t number)
    {
      masks[Index(number)] =
        MaskOfBrick(summary.Over, list[Index(number)], ranges[Index(number)], spans.get());
    });
  summary.Contents = std::move(contents);
  summary.Ranges = std::move(ranges);
  summary.Masks = std::move(masks);
  summary.Special = std::move(specials);
  return summary;
}

} // namespace

HexBrickSummary HexBrickSummary::Of(
  const HexBricks& bricks, const NodalField& values, ThreadPool& pool)
{
  return values.Type() == ScalarType::Float32 ? Summarize<float>(bricks, values, pool)
                                              : Summarize<double>(bricks, values, pool);
}

// The largest types come first, so that all are aligned.
std::size_t HexBrickSummary::PackedBytes(std::size_t bricks)
{
  return sizeof(MaskRange) +
         bricks * (sizeof(Hash128) + sizeof(ValueRange) + sizeof(ValueMask) + 1);
}

void HexBrickSummary::WriteTo(char* to) const
{
  const auto put = [&to](const void* from, std::size_t bytes)
  {
    if (bytes > 0)
    {
      std::memcpy(to, from, bytes);
    }
    to += bytes;
  };
  put(&this->Over, sizeof(this->Over));
  put(this->Contents.data(), this->Contents.Bytes());
  put(this->Ranges.data(), this->Ranges.Bytes());
  put(this->Masks.data(), this->Masks.Bytes());
  put(this->Special.data(), this->Special.Bytes());
}

HexBrickSummary HexBrickSummary::Read(std::size_t bricks, const std::shared_ptr<const char>& memory)
{
  const char* from = memory.get();
  HexBrickSummary summary;
  std::memcpy(&summary.Over, from, sizeof(summary.Over));
  from += sizeof(summary.Over);
  summary.Contents = { reinterpret_cast<const Hash128*>(from), bricks, memory };
  from += summary.Contents.Bytes();
  summary.Ranges = { reinterpret_cast<const ValueRange*>(from), bricks, memory };
  from += summary.Ranges.Bytes();
  summary.Masks = { reinterpret_cast<const ValueMask*>(from), bricks, memory };
  from += summary.Masks.Bytes();
  summary.Special = { reinterpret_cast<const std::uint8_t*>(from), bricks, memory };
  return summary;
}

} // namespace banyan
