// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/FetchedBricks.h"

#include "Cache/BrickCache.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace banyan
{

FetchedBricks::FetchedBricks(BrickCache* sharesWith)
  : Shared(sharesWith)
{
}

FetchedBricks::~FetchedBricks()
{
  this->Clear();
}

void FetchedBricks::Change(std::int64_t bytes)
{
  this->HeldBytes += static_cast<std::uint64_t>(bytes);
  if (this->Shared)
  {
    this->Shared->Reserve(bytes);
  }
}

const SampledBox* FetchedBricks::Find(std::int64_t brick) const
{
  const auto item = this->Bricks.find(brick);
  return item == this->Bricks.end() ? nullptr : &item->second.Samples;
}

bool FetchedBricks::Has(std::int64_t brick, const Box& samples) const
{
  const SampledBox* const here = this->Find(brick);
  return here && here->Samples.Contains(samples);
}

void FetchedBricks::Keep(std::int64_t brick, const SampledBox& samples, std::uint64_t bytes)
{
  const auto item = this->Bricks.find(brick);
  const std::uint64_t before = item == this->Bricks.end() ? 0 : item->second.Bytes;
  this->Bricks[brick] = { samples, bytes, this->Frame };
  this->Change(static_cast<std::int64_t>(bytes) - static_cast<std::int64_t>(before));
}

void FetchedBricks::MakeRoom(std::uint64_t coming, std::uint64_t budgetBytes)
{
  if (this->HeldBytes + coming <= budgetBytes)
  {
    return;
  }
  std::vector<std::pair<std::int64_t, std::int64_t>> oldest; ///< when used, and number
  for (const auto& [brick, item] : this->Bricks)
  {
    if (item.UsedIn < this->Frame)
    {
      oldest.emplace_back(item.UsedIn, brick);
    }
  }
  std::sort(oldest.begin(), oldest.end());
  for (const auto& [used, brick] : oldest)
  {
    if (this->HeldBytes + coming <= budgetBytes)
    {
      return;
    }
    const auto item = this->Bricks.find(brick);
    const std::uint64_t bytes = item->second.Bytes;
    this->Bricks.erase(item);
    this->Change(-static_cast<std::int64_t>(bytes));
  }
}

void FetchedBricks::Clear()
{
  this->Bricks.clear();
  this->Change(-static_cast<std::int64_t>(this->HeldBytes));
}

} // namespace banyan
