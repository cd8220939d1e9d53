#include "Render/KeptBricks.h"

namespace banyan
{

void KeptBricks::BeginPicture(std::uint64_t limitBytes)
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  this->LimitBytes = limitBytes;
  ++this->Picture;
  for (auto item = this->Items.begin(); item != this->Items.end();)
  {
    const bool old = item->second.UsedIn < this->Picture - 2;
    if (old || this->HeldBytes > limitBytes)
    {
      this->HeldBytes -= PackedBrick::BytesFor(item->second.Packed->Cells());
      item = this->Items.erase(item);
    }
    else
    {
      ++item;
    }
  }
}

KeptBricks::Pointer KeptBricks::Find(std::int64_t brick, const Box& cells, double low)
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  const auto item = this->Items.find(brick);
  if (item == this->Items.end() || item->second.Packed->Cells() != cells ||
      (item->second.Packed->Relative() && item->second.Packed->Low() != low))
  {
    return nullptr;
  }
  item->second.UsedIn = this->Picture;
  return item->second.Packed;
}

void KeptBricks::Keep(std::int64_t brick, const Pointer& packed)
{
  const std::uint64_t bytes = PackedBrick::BytesFor(packed->Cells());
  const std::lock_guard<std::mutex> lock(this->Mutex);
  const auto item = this->Items.find(brick);
  if (item != this->Items.end())
  {
    this->HeldBytes -= PackedBrick::BytesFor(item->second.Packed->Cells());
    this->Items.erase(item);
  }
  if (this->HeldBytes + bytes <= this->LimitBytes)
  {
    this->HeldBytes += bytes;
    this->Items[brick] = { packed, this->Picture };
  }
}

std::uint64_t KeptBricks::Bytes() const
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  return this->HeldBytes;
}

} // namespace banyan
