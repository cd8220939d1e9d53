// SPDX-License-Identifier: BSD-3-Clause
#include "Base/RecycledMemory.h"

#include <sys/mman.h>

#include <cstdlib>
#include <mutex>
#include <new>
#include <vector>

namespace banyan
{
namespace
{

struct Piece
{
  void* Memory;
  std::size_t Bytes;
};

/// Pieces that were given back.
class Shelf
{
public:
  /// @return null where there is none of this size
  void* Take(std::size_t bytes)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    // Memory that was given last is asked for next, as a rule.
    for (std::size_t i = this->OldestFirst.size(); i-- > 0;)
    {
      if (this->OldestFirst[i].Bytes == bytes)
      {
        return this->Remove(i);
      }
    }
    return nullptr;
  }

  /// Keeps the memory; pieces that lie longest make room. @return false if it is not kept
  bool Keep(void* memory, std::size_t bytes) noexcept
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    if (bytes > LargeMemory::MostKeptBytes)
    {
      return false;
    }
    try
    {
      this->OldestFirst.push_back({ memory, bytes });
    }
    catch (const std::bad_alloc&)
    {
      return false;
    }
    this->Held += bytes;
    this->Shrink(LargeMemory::MostKeptBytes);
    return true;
  }

  void Clear() noexcept
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Shrink(0);
  }

  std::size_t Bytes()
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    return this->Held;
  }

private:
  void* Remove(std::size_t number) noexcept
  {
    const Piece piece = this->OldestFirst[number];
    this->OldestFirst.erase(this->OldestFirst.begin() + static_cast<std::ptrdiff_t>(number));
    this->Held -= piece.Bytes;
    return piece.Memory;
  }

  void Shrink(std::size_t most) noexcept
  {
    while (this->Held > most)
    {
      std::free(this->Remove(0));
    }
  }

  std::mutex Mutex;
  std::vector<Piece> OldestFirst; ///< at most 2048
  std::size_t Held = 0;
};

/// Never destroyed: pictures may live as long as the process.
Shelf& TheShelf()
{
  static Shelf* const shelf = new Shelf;
  return *shelf;
}

/// From the system, which clears a large page faster than as many small ones.
/// Throws std::bad_alloc.
void* NewMemory(std::size_t bytes)
{
  constexpr std::size_t largePage = std::size_t{ 2 } << 20;
  void* memory = nullptr;
  // std::aligned_alloc wants a size that is a multiple of the alignment.
  if (::posix_memalign(&memory, bytes < largePage ? std::size_t{ 64 } : largePage, bytes) != 0)
  {
    throw std::bad_alloc();
  }
#ifdef MADV_HUGEPAGE
  if (bytes >= largePage)
  {
    ::madvise(memory, bytes, MADV_HUGEPAGE); // where the system has none, nothing is lost
  }
#endif
  return memory;
}

/// Sixteen sizes for each power of two: pictures of nearly one size take each other's memory.
std::size_t RoundedUp(std::size_t bytes)
{
  std::size_t unit = LargeMemory::Smallest / 16;
  while (bytes / unit >= 32)
  {
    unit *= 2;
  }
  return (bytes + unit - 1) / unit * unit;
}

} // namespace

void* LargeMemory::Allocate(std::size_t bytes)
{
  if (bytes < Smallest)
  {
    return NewMemory((bytes + 63) / 64 * 64);
  }
  const std::size_t held = RoundedUp(bytes);
  if (held < bytes)
  {
    throw std::bad_alloc();
  }
  void* const memory = TheShelf().Take(held);
  return memory ? memory : NewMemory(held);
}

void LargeMemory::Free(void* memory, std::size_t bytes) noexcept
{
  if (bytes < Smallest || !TheShelf().Keep(memory, RoundedUp(bytes)))
  {
    std::free(memory);
  }
}

std::size_t LargeMemory::KeptBytes()
{
  return TheShelf().Bytes();
}

void LargeMemory::Trim() noexcept
{
  TheShelf().Clear();
}

} // namespace banyan
