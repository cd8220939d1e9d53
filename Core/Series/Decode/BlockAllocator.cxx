// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Decode/BlockAllocator.h"

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <new>
#include <unordered_set>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace banyan
{
namespace
{

constexpr std::size_t Line = 64;
// Sanitizers see what is read beyond a box only where it has memory of its own.
#ifdef BANYAN_HAS_ADDRESS_SANITIZER
constexpr std::size_t MostInSlabs = 0;
#else
constexpr std::size_t MostInSlabs = BlockAllocator::MostBytes;
#endif

std::size_t Rounded(std::size_t bytes)
{
  return (std::max<std::size_t>(bytes, 1) + Line - 1) / Line * Line;
}

/// Stands at the beginning of a slab.
struct Slab
{
  static constexpr std::size_t Words = 64;

  std::size_t Size = 0; ///< of a place
  std::size_t Places = 0;
  std::size_t Used = 0;
  std::size_t Index = 0;          ///< among those of its size that have room
  std::uint64_t Free[Words] = {}; ///< a bit for each place

  explicit Slab(std::size_t size)
    : Size(size)
    , Places(std::min((BlockAllocator::SlabBytes - First()) / size, 64 * Words))
  {
    for (std::size_t place = 0; place < this->Places; ++place)
    {
      this->Free[place / 64] |= std::uint64_t{ 1 } << place % 64;
    }
  }

  static std::size_t First() { return Rounded(sizeof(Slab)); }
  static Slab* Of(void* memory)
  {
    return reinterpret_cast<Slab*>(
      reinterpret_cast<std::uintptr_t>(memory) & ~(BlockAllocator::SlabBytes - 1));
  }

  /// There must be room.
  void* Take()
  {
    std::size_t word = 0;
    while (this->Free[word] == 0)
    {
      ++word;
    }
    const std::size_t place =
      64 * word + static_cast<std::size_t>(__builtin_ctzll(this->Free[word]));
    this->Free[word] &= this->Free[word] - 1;
    ++this->Used;
    return reinterpret_cast<char*>(this) + First() + place * this->Size;
  }
  void Give(void* memory)
  {
    const std::size_t place = static_cast<std::size_t>(static_cast<char*>(memory) -
                                                       reinterpret_cast<char*>(this) - First()) /
                              this->Size;
    this->Free[place / 64] |= std::uint64_t{ 1 } << place % 64;
    --this->Used;
  }
};

/// The slabs of one size that have room.
struct SlabsOfSize
{
  std::size_t Size;
  std::vector<Slab*> WithRoom;

  void Add(Slab* slab)
  {
    this->WithRoom.push_back(slab); // there is room: see NewSlab
    slab->Index = this->WithRoom.size() - 1;
  }
  void Remove(const Slab* slab)
  {
    this->WithRoom.back()->Index = slab->Index;
    this->WithRoom[slab->Index] = this->WithRoom.back();
    this->WithRoom.pop_back();
  }
};

struct AllSlabs
{
  std::mutex Mutex;
  std::vector<SlabsOfSize> Sizes;      ///< a handful
  std::vector<void*> Empty;            ///< memory of slabs
  std::unordered_set<const void*> All; ///< slabs, empty ones included
  std::size_t MostBytes = std::size_t{ 128 } << 20;

  SlabsOfSize& Of(std::size_t size)
  {
    for (SlabsOfSize& slabs : this->Sizes)
    {
      if (slabs.Size == size)
      {
        return slabs;
      }
    }
    this->Sizes.push_back({ size, {} });
    return this->Sizes.back();
  }

  bool MayHaveMore() const
  {
    return !this->Empty.empty() || this->All.size() < BlockAllocator::FewSlabs ||
           (this->All.size() + 1) * BlockAllocator::SlabBytes <= this->MostBytes;
  }

  /// MayHaveMore must be true.
  void NewSlab(SlabsOfSize& slabs)
  {
    // All slabs may have room, or be empty, one day: nothing is allocated where memory is given
    // back.
    slabs.WithRoom.reserve(this->All.size() + 1);
    this->Empty.reserve(this->All.size() + 1);
    if (this->Empty.empty())
    {
      void* const memory =
        ::operator new (BlockAllocator::SlabBytes, std::align_val_t{ BlockAllocator::SlabBytes });
#ifdef MADV_HUGEPAGE
      (void)madvise(memory, BlockAllocator::SlabBytes, MADV_HUGEPAGE); // small pages do as well
#endif
      this->Empty.push_back(memory);
      this->All.insert(memory);
    }
    slabs.Add(new (this->Empty.back()) Slab(slabs.Size));
    this->Empty.pop_back();
  }

  /// Gives empty slabs back where there are too many.
  void Shrink() noexcept
  {
    while (!this->Empty.empty() && this->All.size() * BlockAllocator::SlabBytes > this->MostBytes)
    {
      this->All.erase(this->Empty.back());
      ::operator delete (this->Empty.back(), std::align_val_t{ BlockAllocator::SlabBytes });
      this->Empty.pop_back();
    }
  }
};

AllSlabs& Slabs()
{
  // Never destroyed: boxes are given back while the process ends.
  static AllSlabs* all = new AllSlabs;
  return *all;
}

} // namespace

void* BlockAllocator::Allocate(std::size_t bytes)
{
  const std::size_t size = Rounded(bytes);
  if (size <= MostInSlabs)
  {
    AllSlabs& all = Slabs();
    std::lock_guard<std::mutex> lock(all.Mutex);
    SlabsOfSize& slabs = all.Of(size);
    if (slabs.WithRoom.empty() && all.MayHaveMore())
    {
      all.NewSlab(slabs);
    }
    if (!slabs.WithRoom.empty())
    {
      Slab* const slab = slabs.WithRoom.back();
      void* const memory = slab->Take();
      if (slab->Used == slab->Places)
      {
        slabs.Remove(slab);
      }
      return memory;
    }
  }
  return ::operator new (size, std::align_val_t{ Line });
}

void BlockAllocator::Free(void* memory, std::size_t bytes) noexcept
{
  const std::size_t size = Rounded(bytes);
  if (size <= MostInSlabs)
  {
    AllSlabs& all = Slabs();
    std::lock_guard<std::mutex> lock(all.Mutex);
    Slab* const slab = Slab::Of(memory);
    if (all.All.count(slab) != 0)
    {
      SlabsOfSize& slabs = all.Of(size);
      if (slab->Used == slab->Places)
      {
        slabs.Add(slab);
      }
      slab->Give(memory);
      if (slab->Used == 0)
      {
        slabs.Remove(slab);
        all.Empty.push_back(slab); // there is room: see NewSlab
        all.Shrink();
      }
      return;
    }
  }
  ::operator delete (memory, std::align_val_t{ Line });
}

void BlockAllocator::KeepAtMost(std::size_t bytes)
{
  AllSlabs& all = Slabs();
  std::lock_guard<std::mutex> lock(all.Mutex);
  all.MostBytes = bytes;
  all.Shrink();
}

std::size_t BlockAllocator::BytesOfSlabs()
{
  AllSlabs& all = Slabs();
  std::lock_guard<std::mutex> lock(all.Mutex);
  return all.All.size() * SlabBytes;
}

} // namespace banyan
