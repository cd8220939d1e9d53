// SPDX-License-Identifier: BSD-3-Clause
#include "Base/RecycledMemory.h"

#include <gtest/gtest.h>

#include <cstring>
#include <thread>
#include <vector>

namespace
{

using namespace banyan;

constexpr std::size_t Picture = std::size_t{ 16 } << 20;

TEST(RecycledMemory, ThePictureAfterFindsTheMemoryOfTheOneBefore)
{
  LargeMemory::Trim();
  void* const first = LargeMemory::Allocate(Picture);
  std::memset(first, 1, Picture);
  LargeMemory::Free(first, Picture);
  EXPECT_GE(LargeMemory::KeptBytes(), Picture);
  // A little smaller will do.
  void* const second = LargeMemory::Allocate(Picture - 4096);
  EXPECT_EQ(second, first);
  EXPECT_EQ(LargeMemory::KeptBytes(), 0u);
  // Much smaller would waste it.
  LargeMemory::Free(second, Picture - 4096);
  void* const small = LargeMemory::Allocate(Picture / 2);
  EXPECT_NE(small, first);
  LargeMemory::Free(small, Picture / 2);
  LargeMemory::Trim();
  EXPECT_EQ(LargeMemory::KeptBytes(), 0u);
}

TEST(RecycledMemory, SmallPiecesAreNotKept)
{
  LargeMemory::Trim();
  {
    const std::vector<float, RecycledMemory<float>> some(1000, 1.0f);
  }
  EXPECT_EQ(LargeMemory::KeptBytes(), 0u);
}

TEST(RecycledMemory, IsKeptFromTheSizeOnThatItsOwnerSays)
{
  LargeMemory::Trim();
  constexpr std::size_t floats = LargeMemory::Smallest / sizeof(float);
  {
    const std::vector<float, RecycledMemory<float>> picture(floats);
  }
  EXPECT_EQ(LargeMemory::KeptBytes(), 0u);
  {
    const std::vector<float, RecycledMemory<float, LargeMemory::Smallest>> brick(floats);
  }
  EXPECT_EQ(LargeMemory::KeptBytes(), LargeMemory::Smallest);
  LargeMemory::Trim();
}

// Otherwise memory of sizes that nobody asks for any more would fill the room of others.
TEST(RecycledMemory, WhatLiesLongestMakesRoom)
{
  LargeMemory::Trim();
  constexpr std::size_t piece = std::size_t{ 1 } << 20;
  std::vector<void*> old;
  for (std::size_t i = 0; i < LargeMemory::MostKeptBytes / piece; ++i)
  {
    old.push_back(LargeMemory::Allocate(piece));
  }
  for (void* memory : old)
  {
    LargeMemory::Free(memory, piece);
  }
  void* const picture = LargeMemory::Allocate(Picture);
  LargeMemory::Free(picture, Picture);
  EXPECT_LE(LargeMemory::KeptBytes(), LargeMemory::MostKeptBytes);
  // The system, too, may give the same memory again: then none comes from what is kept.
  const std::size_t kept = LargeMemory::KeptBytes();
  EXPECT_EQ(LargeMemory::Allocate(Picture), picture);
  EXPECT_EQ(LargeMemory::KeptBytes(), kept - Picture);
  LargeMemory::Free(picture, Picture);
  LargeMemory::Trim();
}

TEST(RecycledMemory, KeepsNoMoreThanItMay)
{
  LargeMemory::Trim();
  std::vector<void*> pieces;
  for (int i = 0; i < 20; ++i)
  {
    pieces.push_back(LargeMemory::Allocate(Picture + static_cast<std::size_t>(i) * 100));
  }
  for (int i = 0; i < 20; ++i)
  {
    LargeMemory::Free(
      pieces[static_cast<std::size_t>(i)], Picture + static_cast<std::size_t>(i) * 100);
    EXPECT_LE(LargeMemory::KeptBytes(), LargeMemory::MostKeptBytes);
  }
  EXPECT_GT(LargeMemory::KeptBytes(), LargeMemory::MostKeptBytes / 2);
  LargeMemory::Trim();
}

TEST(RecycledMemory, EverySizeHoldsWhatItIsAskedFor)
{
  for (std::size_t bytes = 1; bytes < (std::size_t{ 1 } << 24); bytes += bytes / 7 + 1)
  {
    auto* const memory = static_cast<char*>(LargeMemory::Allocate(bytes));
    memory[0] = memory[bytes - 1] = 7; // a sanitizer would see it
    LargeMemory::Free(memory, bytes);
  }
  EXPECT_THROW(LargeMemory::Allocate(~std::size_t{ 0 }), std::bad_alloc);
  LargeMemory::Trim();
}

TEST(RecycledMemory, ThreadsNeverShareAPiece)
{
  LargeMemory::Trim();
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t)
  {
    threads.emplace_back(
      [t]
      {
        for (int i = 0; i < 200; ++i)
        {
          const std::size_t bytes =
            LargeMemory::Smallest + static_cast<std::size_t>(i % 5) * 100000;
          auto* const memory = static_cast<unsigned char*>(LargeMemory::Allocate(bytes));
          memory[0] = memory[bytes - 1] = static_cast<unsigned char>(t);
          std::this_thread::yield();
          EXPECT_EQ(memory[0], t);
          EXPECT_EQ(memory[bytes - 1], t);
          LargeMemory::Free(memory, bytes);
        }
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  LargeMemory::Trim();
}

} // namespace
