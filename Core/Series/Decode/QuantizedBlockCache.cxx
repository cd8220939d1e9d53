// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Decode/QuantizedBlockCache.h"

#include "Base/Hash.h"

#include <algorithm>

namespace banyan
{
namespace
{

std::uint64_t BytesOf(const QuantizedBlockCache::Box& box)
{
  return box->Bytes() + 180; // with what is kept beside it
}

/// All caches of the process share the slabs.
/// @param bytes more than before
void ChangeSlabs(std::int64_t bytes)
{
  static std::mutex mutex;
  static std::uint64_t all = 0;
  std::lock_guard<std::mutex> lock(mutex);
  all += static_cast<std::uint64_t>(bytes);
  BlockAllocator::KeepAtMost(all);
}

} // namespace

QuantizedBlockCache::QuantizedBlockCache(std::uint64_t budgetBytes)
  : Budget(budgetBytes)
{
  ChangeSlabs(static_cast<std::int64_t>(budgetBytes));
}

QuantizedBlockCache::~QuantizedBlockCache()
{
  this->ForgetAll();
  ChangeSlabs(-static_cast<std::int64_t>(this->Budget));
}

/// The lowest bits are the block's: blocks that follow each other have buckets that do.
std::size_t QuantizedBlockCache::HashOf(const Key& key)
{
  std::uint64_t hash = key.Series * 0x9e3779b97f4a7c15ull + key.Block / BlocksTogether;
  hash = (hash ^ (hash >> 29)) * 0xbf58476d1ce4e5b9ull;
  hash += (std::uint64_t{ key.Step } << 32) | (std::uint64_t{ key.Component } << 16) | key.Plane;
  hash = (hash ^ (hash >> 32)) * 0x94d049bb133111ebull;
  hash ^= hash >> 31;
  return static_cast<std::size_t>(hash * BlocksTogether + key.Block % BlocksTogether);
}

std::int32_t& QuantizedBlockCache::BucketOf(Shard& shard, std::size_t hash)
{
  const std::size_t bucket =
    hash / (BlocksTogether * ShardCount) * BlocksTogether + hash % BlocksTogether;
  return shard.Buckets[bucket & (shard.Buckets.size() - 1)];
}

/// -1: it is not there.
std::int32_t QuantizedBlockCache::EntryOf(Shard& shard, std::size_t hash, const Key& key)
{
  std::int32_t entry = shard.Buckets.empty() ? -1 : BucketOf(shard, hash);
  while (entry >= 0 && !(shard.Entries[static_cast<std::size_t>(entry)].Name == key))
  {
    entry = shard.Entries[static_cast<std::size_t>(entry)].Next;
  }
  return entry;
}

/// @param body called as body(Kept&), while nobody changes it, if the box is there
template <class Body>
void QuantizedBlockCache::Look(const Key& key, const Body& body)
{
  const std::size_t hash = HashOf(key);
  Shard& shard = this->Shards[ShardOf(hash)];
  std::lock_guard<std::mutex> lock(shard.Mutex);
  const std::int32_t found = EntryOf(shard, hash, key);
  if (found >= 0)
  {
    body(shard.Entries[static_cast<std::size_t>(found)]);
  }
}

QuantizedBlockCache::Box QuantizedBlockCache::Find(const Key& key)
{
  Box box;
  this->Look(key,
    [&](Kept& kept)
    {
      kept.Used = true;
      box = kept.Numbers;
    });
  return box;
}

const void* QuantizedBlockCache::AddressOf(const Key& key)
{
  const void* memory = nullptr;
  this->Look(key,
    [&](Kept& kept)
    {
      __builtin_prefetch(kept.Numbers.get()); // how many hold it
      memory = kept.Memory;
    });
  return memory;
}

void QuantizedBlockCache::Add(const Key& key, const Box& box, bool lowPriority)
{
  const std::size_t hash = HashOf(key);
  Shard& shard = this->Shards[ShardOf(hash)];
  std::lock_guard<std::mutex> lock(shard.Mutex);
  if (EntryOf(shard, hash, key) >= 0)
  {
    return; // another thread was faster
  }
  if (shard.Free.empty())
  {
    Grow(shard);
  }
  const std::int32_t entry = shard.Free.back();
  shard.Free.pop_back();
  std::int32_t& bucket = BucketOf(shard, hash);
  shard.Entries[static_cast<std::size_t>(entry)] = { key, box, box->Memory(), bucket, false,
    lowPriority };
  bucket = entry;
  shard.Bytes += BytesOf(box);
  if (lowPriority)
  {
    LinkBrief(shard, entry);
  }
  this->Shrink(shard);
}

void QuantizedBlockCache::LinkBrief(Shard& shard, std::int32_t entry)
{
  Kept& kept = shard.Entries[static_cast<std::size_t>(entry)];
  kept.Older = shard.NewestBrief;
  std::int32_t& before =
    kept.Older < 0 ? shard.OldestBrief : shard.Entries[static_cast<std::size_t>(kept.Older)].Newer;
  before = entry;
  shard.NewestBrief = entry;
  shard.BriefBytes += BytesOf(kept.Numbers);
}

void QuantizedBlockCache::UnlinkBrief(Shard& shard, std::int32_t entry)
{
  const Kept& kept = shard.Entries[static_cast<std::size_t>(entry)];
  std::int32_t& before =
    kept.Older < 0 ? shard.OldestBrief : shard.Entries[static_cast<std::size_t>(kept.Older)].Newer;
  std::int32_t& after =
    kept.Newer < 0 ? shard.NewestBrief : shard.Entries[static_cast<std::size_t>(kept.Newer)].Older;
  before = kept.Newer;
  after = kept.Older;
  shard.BriefBytes -= BytesOf(kept.Numbers);
}

/// Makes room for twice as many boxes.
void QuantizedBlockCache::Grow(Shard& shard)
{
  const std::size_t before = shard.Entries.size();
  const std::size_t after = std::max<std::size_t>(64, 2 * before);
  shard.Entries.resize(after);
  shard.Buckets.assign(after, -1);
  for (std::size_t i = 0; i < after; ++i)
  {
    Kept& kept = shard.Entries[i];
    if (kept.Numbers)
    {
      std::int32_t& bucket = BucketOf(shard, HashOf(kept.Name));
      kept.Next = bucket;
      bucket = static_cast<std::int32_t>(i);
    }
    else
    {
      shard.Free.push_back(static_cast<std::int32_t>(i));
    }
  }
}

void QuantizedBlockCache::Remove(Shard& shard, std::int32_t entry)
{
  Kept& kept = shard.Entries[static_cast<std::size_t>(entry)];
  std::int32_t* link = &BucketOf(shard, HashOf(kept.Name));
  while (*link != entry)
  {
    link = &shard.Entries[static_cast<std::size_t>(*link)].Next;
  }
  *link = kept.Next;
  if (kept.LowPriority)
  {
    UnlinkBrief(shard, entry);
  }
  shard.Bytes -= BytesOf(kept.Numbers);
  kept = {};
  shard.Free.push_back(entry);
}

void QuantizedBlockCache::Shrink(Shard& shard)
{
  const std::uint64_t budget = this->Budget / ShardCount;
  while (shard.Bytes > budget)
  {
    // The newest one is needed by the next block, however large it is.
    if (shard.BriefBytes > budget / BriefPart && shard.OldestBrief != shard.NewestBrief)
    {
      Remove(shard, shard.OldestBrief);
      continue;
    }
    shard.Hand = shard.Hand + 1 < shard.Entries.size() ? shard.Hand + 1 : 0;
    Kept& kept = shard.Entries[shard.Hand];
    if (kept.Numbers && !kept.Used)
    {
      Remove(shard, static_cast<std::int32_t>(shard.Hand));
    }
    kept.Used = false;
  }
}

/// @param which called as bool(const Key&), while nobody changes the boxes
template <class Which>
void QuantizedBlockCache::RemoveThose(const Which& which)
{
  for (Shard& shard : this->Shards)
  {
    std::lock_guard<std::mutex> lock(shard.Mutex);
    for (std::size_t i = 0; i < shard.Entries.size(); ++i)
    {
      if (shard.Entries[i].Numbers && which(shard.Entries[i].Name))
      {
        Remove(shard, static_cast<std::int32_t>(i));
      }
    }
  }
}

void QuantizedBlockCache::Forget(std::uint64_t series)
{
  this->RemoveThose([series](const Key& key) { return key.Series == series; });
}

void QuantizedBlockCache::ForgetAll()
{
  for (Shard& shard : this->Shards)
  {
    std::lock_guard<std::mutex> lock(shard.Mutex);
    shard.Entries.clear();
    shard.Free.clear();
    shard.Buckets.clear();
    shard.Hand = 0;
    shard.NewestBrief = shard.OldestBrief = -1;
    shard.Bytes = shard.BriefBytes = 0;
  }
}

void QuantizedBlockCache::ForgetFinest()
{
  this->RemoveThose([](const Key& key) { return key.Plane == 0; });
}

std::uint64_t QuantizedBlockCache::Bytes() const
{
  std::uint64_t bytes = 0;
  for (const Shard& shard : this->Shards)
  {
    std::lock_guard<std::mutex> lock(shard.Mutex);
    bytes += shard.Bytes;
  }
  return bytes;
}

} // namespace banyan
