// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Decode/BlockAllocator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <random>
#include <thread>
#include <vector>

namespace banyan
{
namespace
{

constexpr std::size_t Sizes[] = { 1, 64, 1458, 9826, 71874, BlockAllocator::MostBytes,
  BlockAllocator::MostBytes + 1 };

struct Piece
{
  unsigned char* At;
  std::size_t Bytes;
  unsigned char Mark;
};

/// Takes and gives pieces of some sizes in any order; each must hold what was written to it.
void TakeAndGive(unsigned seed, int times)
{
  std::mt19937 random(seed);
  std::vector<Piece> pieces;
  const auto give = [&](std::size_t i)
  {
    const Piece piece = pieces[i];
    ASSERT_TRUE(std::all_of(
      piece.At, piece.At + piece.Bytes, [&](unsigned char byte) { return byte == piece.Mark; }));
    BlockAllocator::Free(piece.At, piece.Bytes);
    pieces[i] = pieces.back();
    pieces.pop_back();
  };
  for (int i = 0; i < times; ++i)
  {
    if (!pieces.empty() && random() % 5 < 2)
    {
      give(random() % pieces.size());
      continue;
    }
    const std::size_t bytes = Sizes[random() % std::size(Sizes)];
    auto* const at = static_cast<unsigned char*>(BlockAllocator::Allocate(bytes));
    ASSERT_EQ(reinterpret_cast<std::uintptr_t>(at) % 64, 0u);
    pieces.push_back({ at, bytes, static_cast<unsigned char>(random()) });
    std::memset(at, pieces.back().Mark, bytes);
  }
  while (!pieces.empty())
  {
    give(pieces.size() - 1);
  }
}

/// There may be so many slabs beside those that there are.
class MoreSlabs
{
public:
  explicit MoreSlabs(std::size_t count)
  {
    BlockAllocator::KeepAtMost(0); // empty ones go
    this->Before = BlockAllocator::BytesOfSlabs();
    BlockAllocator::KeepAtMost(this->Before + count * BlockAllocator::SlabBytes);
  }
  ~MoreSlabs() { BlockAllocator::KeepAtMost(128 << 20); }
  std::size_t Bytes() const { return BlockAllocator::BytesOfSlabs() - this->Before; }

private:
  std::size_t Before = 0;
};

void TakeAndGiveInThreads()
{
  std::vector<std::thread> threads;
  for (unsigned seed = 0; seed < 3; ++seed)
  {
    threads.emplace_back([seed] { TakeAndGive(seed, 3000); });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
}

TEST(BlockAllocator, PiecesDoNotMeetAndSlabsAreGivenBack)
{
  for (const std::size_t count : { 0, 7, 1000 })
  {
    const MoreSlabs slabs(count);
    TakeAndGiveInThreads();
    EXPECT_LE(slabs.Bytes(), std::max(count, BlockAllocator::FewSlabs) * BlockAllocator::SlabBytes);
    BlockAllocator::KeepAtMost(0);
    EXPECT_EQ(slabs.Bytes(), 0u);
  }
}

TEST(BlockAllocator, ASlabIsFilledBeforeTheNextOneIsTaken)
{
#ifdef BANYAN_HAS_ADDRESS_SANITIZER
  GTEST_SKIP() << "each piece has memory of its own";
#endif
  const MoreSlabs slabs(100);
  constexpr std::size_t bytes = 9856;
  std::vector<void*> pieces;
  for (int round = 0; round < 3; ++round)
  {
    while (pieces.size() < 2 * (BlockAllocator::SlabBytes / bytes - 1))
    {
      pieces.push_back(BlockAllocator::Allocate(bytes));
    }
    EXPECT_EQ(slabs.Bytes(), 2 * BlockAllocator::SlabBytes);
    std::shuffle(pieces.begin(), pieces.end(), std::mt19937(7));
    while (pieces.size() > 100)
    {
      BlockAllocator::Free(pieces.back(), bytes);
      pieces.pop_back();
    }
  }
  for (void* piece : pieces)
  {
    BlockAllocator::Free(piece, bytes);
  }
}

TEST(BlockAllocator, SlabsAreNotMoreThanTheLimitAndAreKept)
{
#ifdef BANYAN_HAS_ADDRESS_SANITIZER
  GTEST_SKIP() << "each piece has memory of its own";
#endif
  const MoreSlabs slabs(5);
  constexpr std::size_t limit = 5 * BlockAllocator::SlabBytes;
  constexpr std::size_t bytes = BlockAllocator::MostBytes;
  std::vector<void*> pieces;
  for (int i = 0; i < 50; ++i)
  {
    pieces.push_back(BlockAllocator::Allocate(bytes));
  }
  EXPECT_EQ(slabs.Bytes(), limit);
  for (void* piece : pieces)
  {
    BlockAllocator::Free(piece, bytes);
  }
  EXPECT_EQ(slabs.Bytes(), limit);
  // They do for boxes of any size.
  void* const other = BlockAllocator::Allocate(100);
  EXPECT_EQ(slabs.Bytes(), limit);
  BlockAllocator::Free(other, 100);
}

TEST(BlockAllocator, ALowerLimitHoldsWhenSlabsAreEmpty)
{
#ifdef BANYAN_HAS_ADDRESS_SANITIZER
  GTEST_SKIP() << "each piece has memory of its own";
#endif
  const MoreSlabs slabs(3);
  void* const piece = BlockAllocator::Allocate(100);
  EXPECT_EQ(slabs.Bytes(), BlockAllocator::SlabBytes);
  BlockAllocator::KeepAtMost(0);
  EXPECT_EQ(slabs.Bytes(), BlockAllocator::SlabBytes);
  BlockAllocator::Free(piece, 100);
  EXPECT_EQ(slabs.Bytes(), 0u);
}

} // namespace
} // namespace banyan
