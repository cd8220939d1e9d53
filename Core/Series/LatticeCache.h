#ifndef banyan_Series_LatticeCache_h
#define banyan_Series_LatticeCache_h

#include "Series/LatticeBox.h"

#include <atomic>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

namespace banyan
{

/// Decoded boxes (lattice numbers) that other steps and finer blocks are predicted from, kept within
/// a byte budget, least recently used out first. One for the process. Thread-safe.
class LatticeCache
{
public:
  using Box = std::shared_ptr<const LatticeBox>;

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

  static LatticeCache& Process();

  /// Null when it is not there.
  Box Find(const Key& key);
  void Add(const Key& key, const Box& box);
  /// Forgets the boxes of a series.
  void Forget(std::uint64_t series);

  /// Takes effect at once. Default 128 MiB, or a quarter of BANYAN_CACHE_MB; a new budget of the
  /// process's BrickCache sets it to a quarter of that.
  void SetBudgetBytes(std::uint64_t bytes);
  std::uint64_t BudgetBytes() const { return this->Budget; }
  std::uint64_t Bytes() const;

private:
  LatticeCache();

  struct KeyHash
  {
    std::size_t operator()(const Key& key) const;
  };
  struct Kept
  {
    Key Name;
    Box Numbers;
  };
  /// Shards have locks of their own, so that threads seldom wait for each other.
  struct Shard
  {
    mutable std::mutex Mutex;
    std::list<Kept> Recent; ///< most recently used first
    std::unordered_map<Key, std::list<Kept>::iterator, KeyHash> Places;
    std::uint64_t Bytes = 0;
  };
  static constexpr std::size_t ShardCount = 16;

  Shard& ShardOf(const Key& key);
  void Shrink(Shard& shard);

  Shard Shards[ShardCount];
  std::atomic<std::uint64_t> Budget;
};

} // namespace banyan

#endif
