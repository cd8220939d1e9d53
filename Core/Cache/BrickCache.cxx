// SPDX-License-Identifier: BSD-3-Clause
#include "Cache/BrickCache.h"

#include "Base/Error.h"
#include "Base/Timer.h"
#include "Series/Decode/CacheContext.h"

#include <algorithm>
#include <condition_variable>
#include <list>
#include <mutex>
#include <unordered_map>

namespace banyan
{
namespace
{

/// Identifies a decoded brick. Its place belongs to it, because `BrickValues` says it.
struct Key
{
  PayloadIdentity Identity;
  ScalarType Type = ScalarType::Float32;
  Box Samples;

  friend bool operator==(const Key& a, const Key& b)
  {
    return a.Identity == b.Identity && a.Type == b.Type && a.Samples == b.Samples;
  }
};

struct KeyHash
{
  std::size_t operator()(const Key& key) const
  {
    const glm::ivec3& lo = key.Samples.Lo;
    std::uint64_t hash = key.Identity.Low;
    for (const int part : { lo.x, lo.y, lo.z })
    {
      hash = (hash ^ static_cast<std::uint64_t>(part)) * 0x9e3779b97f4a7c15u;
    }
    return static_cast<std::size_t>(hash ^ hash >> 32);
  }
};

/// Memory of a brick beside its values: list node, map node, control block.
constexpr std::uint64_t OverheadBytes = 256;

std::uint64_t CostOf(const BrickValues& brick)
{
  return brick.Bytes.size() + OverheadBytes;
}

BrickNode NodeOf(const SeriesFile& series, const FieldKey& field, std::int64_t brick)
{
  const auto nodes = series.Nodes(field);
  if (brick < 0 || brick >= static_cast<std::int64_t>(nodes->size()))
  {
    throw Error("The level has no brick number " + std::to_string(brick), { series.Path() });
  }
  return (*nodes)[static_cast<std::size_t>(brick)];
}

Key KeyOf(
  const SeriesFile& series, const FieldKey& field, const BrickNode& node, std::int64_t brick)
{
  return { node.Identity, series.Index().Arrays[static_cast<std::size_t>(field.Array)].Type,
    series.Layout(field.Level).SamplesOf(brick) };
}

std::shared_ptr<const BrickValues> Decode(
  const SeriesFile& series, const FieldKey& field, std::int64_t brick, const Key& key)
{
  auto values = std::make_shared<BrickValues>();
  values->Type = key.Type;
  values->Samples = key.Samples;
  values->Bytes.resize(static_cast<std::size_t>(key.Samples.Count()) * SizeOf(key.Type));
  series.DecodeBrick(field, brick, values->Bytes.data());
  return values;
}

} // namespace

struct BrickCache::Internals
{
  using Pointer = std::shared_ptr<const BrickValues>;
  struct Item
  {
    Key Name;
    Pointer Brick;
    bool Ahead = false; ///< decoded before anybody asked, and not asked for yet
  };
  using Order = std::list<Item>; ///< most recently used first

  /// A brick that some thread is decoding.
  struct Pending
  {
    Timer Began;
    bool Done = false;
    bool Ahead = false; ///< nobody asked for it: somebody who does need not wait for it
    Pointer Result;     ///< null after Done: decoding failed
  };

  std::uint64_t Budget = 0;
  Statistics Numbers;
  AheadStatistics Ahead;
  Order Bricks;
  std::unordered_map<Key, Order::iterator, KeyHash> Places;
  std::unordered_map<Key, std::shared_ptr<Pending>, KeyHash> Decoding;
  mutable std::mutex Mutex;
  std::condition_variable Decoded;

  std::uint64_t Reserved = 0; ///< of the budget, by others

  std::uint64_t Limit() const { return this->Budget - std::min(this->Budget, this->Reserved); }

  void EvictDownTo(std::uint64_t bytes)
  {
    while (this->Numbers.Bytes > bytes)
    {
      this->Numbers.Bytes -= CostOf(*this->Bricks.back().Brick);
      this->Places.erase(this->Bricks.back().Name);
      this->Bricks.pop_back();
      ++this->Numbers.Evictions;
    }
  }

  void Keep(const Key& key, const Pointer& brick, bool ahead)
  {
    const std::uint64_t cost = CostOf(*brick);
    if (cost > this->Limit())
    {
      return;
    }
    this->EvictDownTo(this->Limit() - cost); // before adding: the budget is never exceeded
    this->Bricks.push_front({ key, brick, ahead });
    this->Places[key] = this->Bricks.begin();
    this->Numbers.Bytes += cost;
    this->Numbers.PeakBytes = std::max(this->Numbers.PeakBytes, this->Numbers.Bytes);
  }

  /// A brick that is held, for somebody who asked for it.
  Pointer Hit(Order::iterator place)
  {
    this->Bricks.splice(this->Bricks.begin(), this->Bricks, place);
    ++this->Numbers.Hits;
    this->Ahead.Hits += place->Ahead ? 1 : 0;
    place->Ahead = false;
    return place->Brick;
  }

  /// Null when the brick is not held.
  Pointer Find(const Key& key)
  {
    std::lock_guard<std::mutex> lock(this->Mutex);
    const auto place = this->Places.find(key);
    return place == this->Places.end() ? nullptr : this->Hit(place->second);
  }

  /// Waits for another thread's result or claims the decoding; null when claimed.
  Pointer FindOrClaim(const Key& key)
  {
    std::unique_lock<std::mutex> lock(this->Mutex);
    while (true)
    {
      const auto place = this->Places.find(key);
      if (place != this->Places.end())
      {
        return this->Hit(place->second);
      }
      if (this->Claim(key))
      {
        return nullptr;
      }
      if (this->Decoding[key]->Ahead)
      {
        // Threads that work ahead have low priority: decoding once more is quicker than to wait.
        this->Decoding[key] = std::make_shared<Pending>();
        ++this->Numbers.Misses;
        return nullptr;
      }
      const std::shared_ptr<Pending> pending = this->Decoding[key];
      const Timer timer;
      this->Decoded.wait(lock, [&pending] { return pending->Done; });
      this->Numbers.WaitSeconds += timer.Seconds();
      if (pending->Result)
      {
        ++this->Numbers.Hits; // even if the budget did not let it stay
        return pending->Result;
      }
    }
  }

  /// Under the lock. @return false when another thread is decoding the brick
  bool Claim(const Key& key)
  {
    if (this->Decoding.count(key) > 0)
    {
      return false;
    }
    this->Decoding[key] = std::make_shared<Pending>();
    ++this->Numbers.Misses;
    return true;
  }

  /// Claims a brick that is neither held nor being decoded; null when it is.
  std::shared_ptr<Pending> ClaimAhead(const Key& key)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    if (this->Places.count(key) > 0 || !this->Claim(key))
    {
      return nullptr;
    }
    std::shared_ptr<Pending> claim = this->Decoding[key];
    claim->Ahead = true;
    return claim;
  }

  /// Unless somebody has taken the claim over.
  void PublishAhead(const Key& key, const std::shared_ptr<Pending>& claim, const Pointer& brick)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Numbers.DecodeSeconds += claim->Began.Seconds();
    const auto decoding = this->Decoding.find(key);
    if (decoding == this->Decoding.end() || decoding->second != claim)
    {
      return;
    }
    this->Decoding.erase(decoding);
    if (brick)
    {
      this->Keep(key, brick, true);
      ++this->Ahead.Decoded;
    }
  }

  void Publish(const Key& key, const Pointer& brick)
  {
    {
      std::lock_guard<std::mutex> lock(this->Mutex);
      const auto decoding = this->Decoding.find(key);
      const double took = decoding->second->Began.Seconds();
      this->Numbers.DecodeSeconds += took;
      this->Numbers.WaitSeconds += took;
      decoding->second->Done = true;
      decoding->second->Result = brick;
      this->Decoding.erase(decoding);
      if (brick)
      {
        this->Keep(key, brick, false);
      }
    }
    this->Decoded.notify_all();
  }

  /// For the thread that claimed it.
  Pointer DecodeClaimed(
    const SeriesFile& series, const FieldKey& field, std::int64_t brick, const Key& key)
  {
    try
    {
      Pointer values = Decode(series, field, brick, key);
      this->Publish(key, values);
      return values;
    }
    catch (...)
    {
      this->Publish(key, nullptr);
      throw;
    }
  }
};

BrickCache::BrickCache(std::uint64_t budgetBytes)
  : Self(std::make_unique<Internals>())
{
  this->Self->Budget = budgetBytes;
}

BrickCache::~BrickCache() = default;

std::shared_ptr<const BrickValues> BrickCache::GetIfHeld(
  const SeriesFile& series, const FieldKey& field, const BrickNode& node, std::int64_t brick)
{
  return this->Self->Find(KeyOf(series, field, node, brick));
}

std::shared_ptr<const BrickValues> BrickCache::Get(
  const SeriesFile& series, const FieldKey& field, std::int64_t brick)
{
  const BrickNode node = NodeOf(series, field, brick);
  const Key key = KeyOf(series, field, node, brick);
  if (node.Uniform)
  {
    // Filling is quicker than remembering, and leaves the room to others.
    return Decode(series, field, brick, key);
  }
  const auto found = this->Self->FindOrClaim(key);
  return found ? found : this->Self->DecodeClaimed(series, field, brick, key);
}

std::uint64_t BrickCache::GetAhead(
  const SeriesFile& series, const FieldKey& field, std::int64_t brick)
{
  const BrickNode node = NodeOf(series, field, brick);
  const Key key = KeyOf(series, field, node, brick);
  const auto claim = node.Uniform ? nullptr : this->Self->ClaimAhead(key);
  if (!claim)
  {
    return 0;
  }
  try
  {
    const std::shared_ptr<const BrickValues> values = Decode(series, field, brick, key);
    this->Self->PublishAhead(key, claim, values);
    return CostOf(*values);
  }
  catch (...)
  {
    this->Self->PublishAhead(key, claim, nullptr);
    throw;
  }
}

BrickCache::AheadStatistics BrickCache::GetAheadStatistics() const
{
  std::lock_guard<std::mutex> lock(this->Self->Mutex);
  return this->Self->Ahead;
}

std::uint64_t BrickCache::Budget() const
{
  return this->Self->Budget;
}

void BrickCache::Reserve(std::int64_t change)
{
  std::lock_guard<std::mutex> lock(this->Self->Mutex);
  this->Self->Reserved += static_cast<std::uint64_t>(change);
  this->Self->EvictDownTo(this->Self->Limit());
}

void BrickCache::Clear()
{
  std::lock_guard<std::mutex> lock(this->Self->Mutex);
  this->Self->Bricks.clear();
  this->Self->Places.clear();
  this->Self->Numbers.Bytes = 0;
}

BrickCache::Statistics BrickCache::GetStatistics() const
{
  std::lock_guard<std::mutex> lock(this->Self->Mutex);
  return this->Self->Numbers;
}

BrickCache& BrickCache::Of(CacheContext& context)
{
  return context.Bricks<BrickCache>();
}

BrickCache& BrickCache::Of(const SeriesFile& series)
{
  return Of(*series.Caches());
}

} // namespace banyan
