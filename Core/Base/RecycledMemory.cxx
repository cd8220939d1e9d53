#include "Base/RecycledMemory.h"

#include <map>
#include <mutex>
#include <new>

namespace banyan
{
namespace
{

/// Pieces that were given back, by what they hold.
struct Shelf
{
  std::mutex Mutex;
  std::multimap<std::size_t, void*> Pieces;
  std::size_t Bytes = 0;
};

/// Never destroyed: pictures may live as long as the process.
Shelf& TheShelf()
{
  static Shelf* const shelf = new Shelf;
  return *shelf;
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

void* LargeMemory::Take(std::size_t bytes)
{
  if (bytes < Smallest)
  {
    return ::operator new(bytes);
  }
  const std::size_t held = RoundedUp(bytes);
  if (held < bytes)
  {
    throw std::bad_alloc();
  }
  Shelf& shelf = TheShelf();
  {
    const std::lock_guard<std::mutex> lock(shelf.Mutex);
    const auto found = shelf.Pieces.find(held);
    if (found != shelf.Pieces.end())
    {
      void* const memory = found->second;
      shelf.Pieces.erase(found);
      shelf.Bytes -= held;
      return memory;
    }
  }
  return ::operator new(held);
}

void LargeMemory::Give(void* memory, std::size_t bytes) noexcept
{
  if (bytes >= Smallest)
  {
    const std::size_t held = RoundedUp(bytes);
    Shelf& shelf = TheShelf();
    const std::lock_guard<std::mutex> lock(shelf.Mutex);
    try
    {
      if (shelf.Bytes + held <= MostKeptBytes)
      {
        shelf.Pieces.emplace(held, memory);
        shelf.Bytes += held;
        return;
      }
    }
    catch (const std::bad_alloc&)
    {
    }
  }
  ::operator delete(memory);
}

std::size_t LargeMemory::KeptBytes()
{
  Shelf& shelf = TheShelf();
  const std::lock_guard<std::mutex> lock(shelf.Mutex);
  return shelf.Bytes;
}

void LargeMemory::LetGo() noexcept
{
  Shelf& shelf = TheShelf();
  const std::lock_guard<std::mutex> lock(shelf.Mutex);
  for (const auto& piece : shelf.Pieces)
  {
    ::operator delete(piece.second);
  }
  shelf.Pieces.clear();
  shelf.Bytes = 0;
}

} // namespace banyan
