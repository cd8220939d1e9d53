#include "Series/LatticeCache.h"

#include "Series/Hash.h"

#include <cstdlib>

namespace banyan
{
namespace
{

constexpr std::uint64_t DefaultBudget = std::uint64_t{ 128 } << 20;

std::uint64_t BytesOf(const LatticeCache::Box& box)
{
  return box->Bytes() + 180; // with what list and map take
}

} // namespace

LatticeCache::LatticeCache()
  : Budget(DefaultBudget)
{
  const char* text = std::getenv("BANYAN_CACHE_MB");
  const long megabytes = text != nullptr ? std::strtol(text, nullptr, 10) : 0;
  if (megabytes > 0)
  {
    this->Budget = (static_cast<std::uint64_t>(megabytes) << 20) / 4;
  }
}

LatticeCache& LatticeCache::Process()
{
  // Never destroyed: series that are closed while the process ends still come here.
  static LatticeCache* cache = new LatticeCache;
  return *cache;
}

std::size_t LatticeCache::KeyHash::operator()(const Key& key) const
{
  std::uint64_t hash = key.Series * 0x9e3779b97f4a7c15ull + key.Block;
  hash = (hash ^ (hash >> 29)) * 0xbf58476d1ce4e5b9ull;
  hash += (std::uint64_t{ key.Step } << 32) | (std::uint64_t{ key.Component } << 16) | key.Plane;
  hash = (hash ^ (hash >> 32)) * 0x94d049bb133111ebull;
  return static_cast<std::size_t>(hash ^ (hash >> 31));
}

LatticeCache::Shard& LatticeCache::ShardOf(const Key& key)
{
  return this->Shards[KeyHash()(key) / 7 % ShardCount];
}

LatticeCache::Box LatticeCache::Find(const Key& key)
{
  Shard& shard = this->ShardOf(key);
  std::lock_guard<std::mutex> lock(shard.Mutex);
  const auto found = shard.Places.find(key);
  if (found == shard.Places.end())
  {
    return nullptr;
  }
  shard.Recent.splice(shard.Recent.begin(), shard.Recent, found->second);
  return found->second->Numbers;
}

void LatticeCache::Add(const Key& key, const Box& box)
{
  Shard& shard = this->ShardOf(key);
  std::lock_guard<std::mutex> lock(shard.Mutex);
  if (shard.Places.find(key) != shard.Places.end())
  {
    return; // another thread was faster
  }
  shard.Recent.push_front({ key, box });
  shard.Places[key] = shard.Recent.begin();
  shard.Bytes += BytesOf(box);
  this->Shrink(shard);
}

void LatticeCache::Shrink(Shard& shard)
{
  const std::uint64_t budget = this->Budget / ShardCount;
  while (shard.Bytes > budget && !shard.Recent.empty())
  {
    shard.Bytes -= BytesOf(shard.Recent.back().Numbers);
    shard.Places.erase(shard.Recent.back().Name);
    shard.Recent.pop_back();
  }
}

void LatticeCache::Forget(std::uint64_t series)
{
  for (Shard& shard : this->Shards)
  {
    std::lock_guard<std::mutex> lock(shard.Mutex);
    for (auto kept = shard.Recent.begin(); kept != shard.Recent.end();)
    {
      if (kept->Name.Series != series)
      {
        ++kept;
        continue;
      }
      shard.Bytes -= BytesOf(kept->Numbers);
      shard.Places.erase(kept->Name);
      kept = shard.Recent.erase(kept);
    }
  }
}

void LatticeCache::SetBudgetBytes(std::uint64_t bytes)
{
  this->Budget = bytes;
  for (Shard& shard : this->Shards)
  {
    std::lock_guard<std::mutex> lock(shard.Mutex);
    this->Shrink(shard);
  }
}

std::uint64_t LatticeCache::Bytes() const
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
