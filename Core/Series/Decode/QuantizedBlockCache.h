// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Decode_QuantizedBlockCache_h
#define banyan_Series_Decode_QuantizedBlockCache_h

#include "Series/Decode/QuantizedBlock.h"

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace banyan
{

/// Decoded boxes (lattice numbers) that other steps and finer blocks are predicted from, kept
/// within a byte budget. What goes out is found as by the hand of a clock, which spares once what
/// was used since it came by. Thread-safe.
class QuantizedBlockCache
{
public:
  using Box = std::shared_ptr<const QuantizedBlock>;

  /// Names a box of an open series.
  struct Key
  {
    std::uint64_t Series = 0;
    std::uint64_t Block = 0;
    std::uint32_t Step = 0;
    std::uint16_t Component = 0;
    std::uint16_t Plane = 0;
    friend bool operator==(const Key& a, const Key& b)
    {
      return a.Series == b.Series && a.Block == b.Block && a.Step == b.Step &&
             a.Component == b.Component && a.Plane == b.Plane;
    }
  };

  explicit QuantizedBlockCache(std::uint64_t budgetBytes);
  ~QuantizedBlockCache();
  QuantizedBlockCache(const QuantizedBlockCache&) = delete;
  QuantizedBlockCache& operator=(const QuantizedBlockCache&) = delete;

  /// Null when it is not there.
  Box Find(const Key& key);
  /// @param lowPriority whether no other step is predicted from it: where there is no room such
  /// boxes go first, the oldest ones before others, until they take about a sixteenth of the budget
  void Add(const Key& key, const Box& box, bool lowPriority = false);
  /// Where the numbers of a box lie, or null: to ask the processor's caches for them. They may be
  /// gone at any time. Takes part of the time of Find, which counts who holds a box and waits for
  /// its memory.
  const void* AddressOf(const Key& key);
  /// Forgets the boxes of a series.
  void Forget(std::uint64_t series);
  /// Forgets the boxes of all series and planes, and the room that their names take, or the boxes
  /// of the finest planes only: to measure what decoding takes.
  void ForgetAll();
  void ForgetFinest();

  std::uint64_t BudgetBytes() const { return this->Budget; }
  std::uint64_t Bytes() const;

private:
  struct Kept
  {
    Key Name;
    Box Numbers;                  ///< null: the place is free
    const void* Memory = nullptr; ///< where they lie
    std::int32_t Next = -1;       ///< entry of the same bucket
    bool Used = false;            ///< since the hand of the clock came by
    bool LowPriority = false;
    std::int32_t Newer = -1; ///< entry of the next box of low priority
    std::int32_t Older = -1; ///< of the one before
  };
  /// Shards have locks of their own, so that threads seldom wait for each other. Entries stay where
  /// they are: to find one takes two lines of the cache, and these hold some blocks that follow
  /// each other.
  struct Shard
  {
    mutable std::mutex Mutex;
    std::vector<Kept> Entries;
    std::vector<std::int32_t> Free;
    std::vector<std::int32_t> Buckets; ///< first entries; -1: none. A power of two of them
    std::size_t Hand = 0;
    std::int32_t NewestBrief = -1;
    std::int32_t OldestBrief = -1;
    std::uint64_t BriefBytes = 0; ///< part of Bytes
    std::uint64_t Bytes = 0;
  };
  static constexpr std::size_t ShardCount = 16;

  static constexpr std::size_t BlocksTogether = 8;
  /// One part of so many is for boxes of low priority in any case: of 128 MiB a layer of blocks of
  /// 384^3 samples.
  static constexpr std::uint64_t BriefPart = 16;

  static std::size_t HashOf(const Key& key);
  static std::size_t ShardOf(std::size_t hash) { return hash / BlocksTogether % ShardCount; }
  static std::int32_t& BucketOf(Shard& shard, std::size_t hash);
  static std::int32_t EntryOf(Shard& shard, std::size_t hash, const Key& key);
  template <class Body>
  void Look(const Key& key, const Body& body);
  static void Grow(Shard& shard);
  static void Remove(Shard& shard, std::int32_t entry);
  template <class Which>
  void RemoveThose(const Which& which);
  static void LinkBrief(Shard& shard, std::int32_t entry);
  static void UnlinkBrief(Shard& shard, std::int32_t entry);
  void Shrink(Shard& shard);

  Shard Shards[ShardCount];
  const std::uint64_t Budget;
};

} // namespace banyan

#endif
