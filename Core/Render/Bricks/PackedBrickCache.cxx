// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/PackedBrickCache.h"

#include "Series/Decode/CacheContext.h"

#include <algorithm>
#include <mutex>

namespace banyan
{
namespace
{

std::uint64_t BytesOf(const PackedBrick& packed)
{
  return packed.Bytes();
}

} // namespace

PackedBrickCache::PackedBrickCache()
  : PackedBrickCache(CacheContext::Process())
{
}

PackedBrickCache::PackedBrickCache(std::shared_ptr<CacheContext> caches)
  : Context(std::move(caches))
{
}

PackedBrickCache::~PackedBrickCache()
{
  this->SetHeld(0);
}

/// The caller has the lock, or is alone.
void PackedBrickCache::SetHeld(std::uint64_t bytes)
{
  this->Context->DrawingSources() += (bytes > 0 ? 1 : 0) - (this->HeldBytes > 0 ? 1 : 0);
  this->HeldBytes = bytes;
}

std::uint64_t PackedBrickCache::ShareBytes() const
{
  const std::shared_lock<std::shared_mutex> lock(this->Mutex);
  const int others = this->Context->DrawingSources() - (this->HeldBytes > 0 ? 1 : 0);
  return this->Context->DrawingBudgetBytes() / static_cast<std::uint64_t>(others + 1);
}

void PackedBrickCache::BeginPicture(std::uint64_t limitBytes, Picture kind)
{
  constexpr std::int64_t others = 2; // pictures that need not use what stays
  const std::lock_guard<std::shared_mutex> lock(this->Mutex);
  this->LimitBytes = limitBytes;
  this->Kind = kind;
  std::uint64_t room = limitBytes;
  if (kind == Picture::Passing)
  {
    room -= std::min(room, std::exchange(this->RefusedBytes, 0));
  }
  if (kind != Picture::Whole && this->HeldBytes <= room)
  {
    return;
  }
  for (auto item = this->Items.begin(); item != this->Items.end();)
  {
    const bool unused = item->second.UsedIn < this->Number - others;
    const bool old = unused && item->second.UsedInWhole < this->WholeNumber - others;
    if (old || this->HeldBytes > limitBytes || (unused && this->HeldBytes > room))
    {
      this->SetHeld(this->HeldBytes - BytesOf(*item->second.Packed));
      item = this->Items.erase(item);
    }
    else
    {
      ++item;
    }
  }
}

void PackedBrickCache::EndPicture()
{
  const std::lock_guard<std::shared_mutex> lock(this->Mutex);
  this->Number += this->Kind == Picture::Part ? 0 : 1;
  this->WholeNumber += this->Kind == Picture::Whole ? 1 : 0;
}

void PackedBrickCache::LetGoOf(const std::function<bool(std::int64_t, const PackedBrick&)>& stale)
{
  const std::lock_guard<std::shared_mutex> lock(this->Mutex);
  this->Groups.clear();
  for (auto item = this->Items.begin(); item != this->Items.end();)
  {
    const PackedBrick& packed = *item->second.Packed;
    if (stale(item->first, packed))
    {
      this->SetHeld(this->HeldBytes - BytesOf(packed));
      item = this->Items.erase(item);
    }
    else
    {
      ++item;
    }
  }
}

void PackedBrickCache::Clear()
{
  this->LetGoOf([](std::int64_t, const PackedBrick&) { return true; });
}

/// The caller has the lock.
void PackedBrickCache::Use(const Item& item) const
{
  item.UsedIn.store(this->Number, std::memory_order_relaxed);
  if (this->Kind != Picture::Passing)
  {
    item.UsedInWhole.store(this->WholeNumber, std::memory_order_relaxed);
  }
}

/// The caller has the lock. Notes that the brick is used.
const PackedBrickCache::Item* PackedBrickCache::FindHere(const Wanted& wanted) const
{
  const auto item = this->Items.find(wanted.Brick);
  if (item == this->Items.end())
  {
    return nullptr;
  }
  const PackedBrick& packed = *item->second.Packed;
  if (packed.Cells() != wanted.Cells || packed.HasGradients() != wanted.Gradients ||
      (packed.Relative() && packed.Low() != wanted.Low))
  {
    return nullptr;
  }
  this->Use(item->second);
  return &item->second;
}

void PackedBrickCache::Find(
  const Wanted* wanted, std::size_t count, std::uint64_t visible, Found* found) const
{
  const std::shared_lock<std::shared_mutex> lock(this->Mutex);
  for (std::size_t i = 0; i < count; ++i)
  {
    const Item* const item = wanted[i].Brick < 0 ? nullptr : this->FindHere(wanted[i]);
    if (item)
    {
      found[i].Packed = item->Packed;
      if (item->VisibleUnder == visible)
      {
        found[i].Visibility = item->Visibility;
      }
    }
  }
}

void PackedBrickCache::Keep(std::int64_t brick, const Pointer& packed)
{
  const std::uint64_t bytes = BytesOf(*packed);
  const std::lock_guard<std::shared_mutex> lock(this->Mutex);
  const auto item = this->Items.find(brick);
  if (item != this->Items.end())
  {
    this->SetHeld(this->HeldBytes - BytesOf(*item->second.Packed));
    this->Items.erase(item);
  }
  if (this->HeldBytes + bytes <= this->LimitBytes)
  {
    this->SetHeld(this->HeldBytes + bytes);
    this->Use(this->Items.try_emplace(brick, packed).first->second);
  }
  else if (this->Kind == Picture::Passing)
  {
    this->RefusedBytes += bytes;
  }
}

void PackedBrickCache::KeepVisibility(
  std::int64_t brick, std::uint64_t visible, const BrickVisibility& visibility)
{
  const std::lock_guard<std::shared_mutex> lock(this->Mutex);
  const auto item = this->Items.find(brick);
  if (item != this->Items.end())
  {
    item->second.Visibility = visibility;
    item->second.VisibleUnder = visible;
  }
}

std::shared_ptr<KnownGroups> PackedBrickCache::GroupsOf(
  int level, std::uint64_t visible, std::int64_t count, std::uint64_t bytesAreOf)
{
  const std::lock_guard<std::shared_mutex> lock(this->Mutex);
  auto& [number, groups] = this->Groups[level];
  // Zones that grow or shrink may have had other groups.
  if (!groups || number != visible || groups->Count() != count ||
      (bytesAreOf != 0 && groups->BytesAreOf() != bytesAreOf))
  {
    number = visible;
    groups = std::make_shared<KnownGroups>(count, bytesAreOf);
  }
  return groups;
}

std::uint64_t PackedBrickCache::Bytes() const
{
  const std::shared_lock<std::shared_mutex> lock(this->Mutex);
  return this->HeldBytes;
}

} // namespace banyan
