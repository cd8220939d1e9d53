// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Papers/PaperOctree.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace banyan
{
namespace
{

using Codes = std::vector<std::uint16_t>;

std::size_t Count(const glm::ivec3& samples)
{
  return static_cast<std::size_t>(Box{ glm::ivec3(0), samples }.Count());
}

/// Blocks of equal codes with some noise, so that nodes of all sizes fuse.
Codes BlocksOf(const glm::ivec3& samples, unsigned seed, unsigned values)
{
  std::mt19937 random(seed);
  Codes codes;
  for (int z = 0; z < samples.z; ++z)
  {
    for (int y = 0; y < samples.y; ++y)
    {
      for (int x = 0; x < samples.x; ++x)
      {
        const unsigned block = static_cast<unsigned>(x / 4 + 3 * (y / 8) + 7 * (z / 2));
        codes.push_back(
          static_cast<std::uint16_t>((random() % 40 == 0 ? random() : block) % values));
      }
    }
  }
  return codes;
}

Codes Changed(Codes codes, unsigned seed, unsigned values, unsigned oneIn)
{
  std::mt19937 random(seed);
  for (std::size_t i = 0; i < codes.size(); ++i)
  {
    // Changes stay together, so that whole subtrees remain.
    if (i / 16 % oneIn == 0 && random() % 2 == 0)
    {
      codes[i] = static_cast<std::uint16_t>(random() % values);
    }
  }
  return codes;
}

/// Encodes, checks that the sizes said are those of the stream, and decodes.
PaperOctreeCounts RoundTripOctree(
  const Codes& codes, const Codes* previous, const glm::ivec3& samples, int bits)
{
  const std::uint16_t* before = previous ? previous->data() : nullptr;
  const PaperOctreeStep step = EncodePaperOctree(codes.data(), before, samples, bits);
  EXPECT_EQ(step.Stream.size(), (step.Counts.Bits() + 7) / 8);
  Codes decoded(codes.size(), 12345);
  DecodePaperOctree(step.Stream, before, samples, bits, decoded.data());
  EXPECT_EQ(decoded, codes);
  if (previous)
  {
    Codes inPlace = *previous;
    DecodePaperOctree(step.Stream, inPlace.data(), samples, bits, inPlace.data());
    EXPECT_EQ(inPlace, codes);
  }
  return step.Counts;
}

const std::vector<glm::ivec3> Sizes = { { 1, 1, 1 }, { 2, 2, 2 }, { 1, 2, 1 }, { 3, 1, 5 },
  { 8, 8, 8 }, { 17, 16, 15 }, { 1, 40, 9 }, { 33, 7, 2 } };

TEST(PaperOctree, DecodesToTheCodesOfEveryStep)
{
  for (const glm::ivec3& samples : Sizes)
  {
    for (const int bits : { 1, 3, 8, 12, 16 })
    {
      Codes previous;
      for (unsigned step = 0; step < 4; ++step)
      {
        const Codes codes =
          step == 0 ? BlocksOf(samples, 5, 1u << bits) : Changed(previous, step, 1u << bits, step);
        RoundTripOctree(codes, step == 0 ? nullptr : &previous, samples, bits);
        previous = codes;
      }
    }
  }
}

TEST(PaperOctree, EqualCodesTakeOneMacroVoxelAndThenNothing)
{
  const glm::ivec3 samples(32);
  const Codes codes(Count(samples), 77);
  PaperOctreeCounts counts = RoundTripOctree(codes, nullptr, samples, 8);
  EXPECT_EQ(counts.MacroVoxels, (CountsBySize{ 0, 0, 0, 0, 0, 1 }));
  EXPECT_EQ(counts.MergedSubtrees, (CountsBySize{ 0, 0, 0, 0, 0, 0 }));
  EXPECT_EQ(counts.CodeBits, 8u);
  EXPECT_EQ(counts.TagBits, 1u);
  counts = RoundTripOctree(codes, &codes, samples, 8);
  EXPECT_EQ(counts.MergedSubtrees, (CountsBySize{ 0, 0, 0, 0, 0, 1 }));
  EXPECT_EQ(counts.CodeBits, 0u);
  EXPECT_EQ(counts.TagBits, 2u);
}

TEST(PaperOctree, OneVoxelSplitsItsAncestors)
{
  const glm::ivec3 samples(8);
  Codes codes(Count(samples), 3);
  const Codes before = codes;
  codes[0] = 4;
  // By itself: root and one node of 4^3 with children, one node of 2^3 with 8 voxels; 7 macro
  // voxels each of 4^3 and 2^3.
  PaperOctreeCounts counts = RoundTripOctree(codes, nullptr, samples, 8);
  EXPECT_EQ(counts.MacroVoxels, (CountsBySize{ 8, 7, 7, 0 }));
  EXPECT_EQ(counts.CodeBits, 8u * (8 + 7 + 7));
  EXPECT_EQ(counts.TagBits, 3u + 7 + 7);
  // After the step before: the same nodes are "as before" (2 bits each), and of the last node's
  // voxels one is coded, behind a tag of 2 bits and a mask of 8.
  counts = RoundTripOctree(codes, &before, samples, 8);
  EXPECT_EQ(counts.MacroVoxels, (CountsBySize{ 8, 7, 7, 0 }));
  EXPECT_EQ(counts.MergedSubtrees, (CountsBySize{ 7, 7, 7, 0 }));
  EXPECT_EQ(counts.CodeBits, 8u);
  EXPECT_EQ(counts.TagBits, 2u + 2 * 14 + 2 + 8);
}

TEST(PaperOctree, StreamsAreAsDocumented)
{
  // Voxels 1, 2 of 2 bits: tag 0, then the codes, from the lowest bit of the byte on.
  const Codes codes{ 1, 2 };
  EXPECT_EQ(EncodePaperOctree(codes.data(), nullptr, { 2, 1, 1 }, 2).Stream, (Bytes{ 0b10010 }));
  // The second has changed: tag "10", mask "10", code 3.
  const Codes next{ 1, 3 };
  EXPECT_EQ(
    EncodePaperOctree(next.data(), codes.data(), { 2, 1, 1 }, 2).Stream, (Bytes{ 0b110101 }));
  // Both: tag "00", codes 0 and 3.
  const Codes both{ 0, 3 };
  EXPECT_EQ(
    EncodePaperOctree(both.data(), codes.data(), { 2, 1, 1 }, 2).Stream, (Bytes{ 0b110000 }));
  // A macro voxel of code 2, tag "11"; and nothing new, tag "01".
  const Codes fused{ 2, 2 };
  EXPECT_EQ(
    EncodePaperOctree(fused.data(), codes.data(), { 2, 1, 1 }, 2).Stream, (Bytes{ 0b1011 }));
  EXPECT_EQ(EncodePaperOctree(fused.data(), fused.data(), { 2, 1, 1 }, 2).Stream, (Bytes{ 0b10 }));
}

/// Whether all voxels below a node fulfil something, by position and nothing else.
template <class Test>
bool AllBelow(const glm::ivec3& samples, std::size_t level, const glm::ivec3& voxel, Test&& test)
{
  const int edge = 1 << level;
  const Box box =
    Intersection({ voxel / edge * edge, voxel / edge * edge + edge }, { glm::ivec3(0), samples });
  bool all = true;
  for (int z = box.Lo.z; z < box.Hi.z; ++z)
  {
    for (int y = box.Lo.y; y < box.Hi.y; ++y)
    {
      for (int x = box.Lo.x; x < box.Hi.x; ++x)
      {
        all = all && test(static_cast<std::size_t>((z * samples.y + y) * samples.x + x));
      }
    }
  }
  return all;
}

/// The greatest nodes whose voxels pass a test, counted by their first voxel.
template <class Make>
CountsBySize Greatest(const glm::ivec3& samples, std::size_t levels, Make&& testFor)
{
  CountsBySize counts(levels, 0);
  std::size_t i = 0;
  for (int z = 0; z < samples.z; ++z)
  {
    for (int y = 0; y < samples.y; ++y)
    {
      for (int x = 0; x < samples.x; ++x, ++i)
      {
        const glm::ivec3 voxel(x, y, z);
        for (std::size_t l = levels; l-- > 0;)
        {
          if (AllBelow(samples, l, voxel, testFor(i)))
          {
            const int edge = 1 << l;
            counts[l] += x % edge == 0 && y % edge == 0 && z % edge == 0 ? 1 : 0;
            break;
          }
        }
      }
    }
  }
  return counts;
}

TEST(PaperOctree, CountsBySizeAreThoseOfASlowSearch)
{
  for (const glm::ivec3& samples : Sizes)
  {
    const Codes before = BlocksOf(samples, 2, 3);
    const Codes codes = Changed(before, 4, 3, 3);
    const PaperOctreeCounts counts = RoundTripOctree(codes, &before, samples, 2);
    const std::size_t levels = counts.MacroVoxels.size();
    EXPECT_EQ(counts.MacroVoxels,
      Greatest(samples, levels,
        [&](std::size_t i)
        { return [&codes, i](std::size_t other) { return codes[other] == codes[i]; }; }));
    EXPECT_EQ(counts.MergedSubtrees,
      Greatest(samples, levels,
        [&](std::size_t)
        { return [&](std::size_t other) { return codes[other] == before[other]; }; }));
  }
}

TEST(PaperOctree, RefusesWhatDoesNotFit)
{
  const Codes codes{ 1, 4 };
  EXPECT_THROW(EncodePaperOctree(codes.data(), nullptr, { 2, 1, 1 }, 2), Error);
  EXPECT_THROW(EncodePaperOctree(codes.data(), nullptr, { 2, 1, 1 }, 17), Error);
  EXPECT_THROW(EncodePaperOctree(codes.data(), nullptr, { 2, 1, 1 }, 0), Error);
  EXPECT_THROW(EncodePaperOctree(codes.data(), nullptr, { 2, 0, 1 }, 8), Error);
}

TEST(PaperOctree, DamagedStreamsThrowOrGiveCodes)
{
  const glm::ivec3 samples(9, 8, 7);
  const Codes before = BlocksOf(samples, 2, 256);
  const Codes codes = Changed(before, 4, 256, 3);
  const Bytes stream = EncodePaperOctree(codes.data(), before.data(), samples, 8).Stream;
  Codes decoded(codes.size());
  const auto decode = [&](const Bytes& bytes)
  { DecodePaperOctree(bytes, before.data(), samples, 8, decoded.data()); };
  for (const std::size_t length : { std::size_t{ 0 }, std::size_t{ 1 }, stream.size() - 1 })
  {
    EXPECT_THROW(decode({ stream.begin(), stream.begin() + static_cast<long>(length) }), Error);
  }
  Bytes longer = stream;
  longer.push_back(0);
  EXPECT_THROW(decode(longer), Error);
  std::mt19937 random(1);
  int refused = 0;
  for (int trial = 0; trial < 300; ++trial)
  {
    Bytes damaged = stream;
    damaged[random() % damaged.size()] ^= static_cast<std::uint8_t>(1 + random() % 255);
    try
    {
      decode(damaged);
    }
    catch (const Error&)
    {
      ++refused;
    }
  }
  EXPECT_GT(refused, 0);
}

TEST(PaperOctree, SavedShareIsThatOfTable2)
{
  EXPECT_DOUBLE_EQ(SavedShare(800, 100, 8), 0.0);
  EXPECT_DOUBLE_EQ(SavedShare(200, 100, 8), 0.75);
  EXPECT_DOUBLE_EQ(SavedShare(1600, 100, 8), -1.0);
  EXPECT_DOUBLE_EQ(SavedShare(800, 100, 32), 0.75);
}

} // namespace
} // namespace banyan
