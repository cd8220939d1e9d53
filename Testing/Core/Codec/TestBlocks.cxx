// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/CodecTesting.h"

#include "Base/Error.h"

#include <glm/vector_relational.hpp>

namespace banyan::testing
{
namespace
{

std::vector<block::Mode> AllModes()
{
  std::vector<block::Mode> modes;
  for (int mode = 0; mode < block::ModeCount; ++mode)
  {
    modes.push_back(block::ModeOf(mode));
  }
  return modes;
}

/// Boxes of neighbours at hand save work, and change nothing.
void ExpectDecodesWithNeighbours(const EncodedPlane& encoded, const glm::ivec3& block,
  const Box3& box, const std::vector<std::int32_t>& expected)
{
  for (int some = 1; some < 8; ++some)
  {
    NeighbourBoxes neighbours;
    for (int a = 0; a < 3; ++a)
    {
      if ((some >> a & 1) != 0 && box.Code.Blocks[1 << a].Exists)
      {
        glm::ivec3 at = block;
        ++at[a];
        neighbours[static_cast<std::size_t>(a)] = BoxNumbers(encoded.Decoded, at);
      }
    }
    ASSERT_EQ(DecodeFast(encoded, box, neighbours), expected) << "with neighbours " << some;
  }
}

/// Both decoders give what the encoder said.
void ExpectDecodes(const EncodedPlane& encoded)
{
  for (std::int64_t i = 0; i < encoded.Plane.Target->BlockCount(); ++i)
  {
    const glm::ivec3 block = BlockAt(*encoded.Plane.Target, i);
    const Box3 box = MakeBox(encoded, block);
    const std::vector<std::int32_t> expected = BoxNumbers(encoded.Decoded, block);
    ASSERT_EQ(DecodeFast(encoded, box), expected) << "block " << i;
    ASSERT_EQ(DecodeSlow(encoded, box), expected) << "block " << i << ", the slow decoder";
    ExpectDecodesWithNeighbours(encoded, block, box, expected);
  }
}

/// What is coded is not further off than half a bin.
void ExpectClose(const EncodedPlane& encoded)
{
  const PlaneNumbers& target = *encoded.Plane.Target;
  for (int z = 0; z < target.Samples.z; ++z)
  {
    for (int y = 0; y < target.Samples.y; ++y)
    {
      for (int x = 0; x < target.Samples.x; ++x)
      {
        if (x % 4 == 0 && y % 4 == 0 && z % 4 == 0)
        {
          continue; // from the coarser plane
        }
        const glm::ivec3 p{ x, y, z };
        ASSERT_LE(std::abs(encoded.Decoded.At(p) - target.At(p)), encoded.Plane.FineBin / 2)
          << x << " " << y << " " << z;
      }
    }
  }
}

/// Only every kind of mode once.
std::vector<block::Mode> SomeModes()
{
  return { { block::Reference::None, block::Interpolation::Cubic },
    { block::Reference::Mean, block::Interpolation::Linear },
    { block::Reference::HalfMean, block::Interpolation::Cubic },
    { block::Reference::B, block::Interpolation::None } };
}

class Blocks : public ::testing::TestWithParam<int>
{
};

TEST_P(Blocks, AllSizesDecodeToWhatTheEncoderSaid)
{
  const int edge = GetParam();
  const std::vector<glm::ivec3> sizes = { { 1, 1, 1 }, { 2, 1, 1 }, { 2, 2, 2 }, { 1, 1, edge },
    { edge - 1, edge, edge + 1 }, { edge, edge + 1, 1 }, { edge + 1, edge - 1, 2 },
    { 2 * edge + 3, 1, edge + 2 }, { 1, 2 * edge, 3 }, { 13, 7, 19 }, { 67, 3, 5 } };
  for (const glm::ivec3& size : sizes)
  {
    const MixedPlanes planes(size, edge, 1);
    for (const bool references : { false, true })
    {
      SCOPED_TRACE(std::to_string(size.x) + " x " + std::to_string(size.y) + " x " +
                   std::to_string(size.z) + (references ? ", with references" : ""));
      const EncodedPlane encoded = EncodeWhole(planes.With(AllModes(), references));
      ExpectDecodes(encoded);
      ExpectClose(encoded);
    }
  }
}

TEST_P(Blocks, EveryModeDecodesToWhatTheEncoderSaid)
{
  const int edge = GetParam();
  const MixedPlanes planes({ edge + 3, edge + 1, edge + 2 }, edge, 2);
  for (const block::Mode& mode : AllModes())
  {
    SCOPED_TRACE("mode " + std::to_string(block::NumberOf(mode)));
    const EncodedPlane encoded = EncodeWhole(planes.With({ mode }, true));
    for (const BlockTokens& block : encoded.Blocks)
    {
      EXPECT_TRUE(block.Uniform || block.Same || block.Mode == block::NumberOf(mode));
    }
    ExpectDecodes(encoded);
    ExpectClose(encoded);
  }
}

TEST_P(Blocks, ArithmeticOf16BitsDecodesToWhatTheEncoderSaid)
{
  const int edge = GetParam();
  for (const glm::ivec3& size :
    { glm::ivec3{ edge + 3, edge + 1, 2 * edge }, glm::ivec3{ 5, 2 * edge, 3 } })
  {
    MixedPlanes planes(size, edge, 12);
    const EncodedPlane chosen = EncodeWhole(planes.NarrowWith(AllModes(), true));
    ExpectDecodes(chosen);
    for (const block::Mode& mode : SomeModes())
    {
      SCOPED_TRACE("mode " + std::to_string(block::NumberOf(mode)));
      ExpectDecodes(EncodeWhole(planes.NarrowWith({ mode }, true)));
    }
  }
}

TEST_P(Blocks, UniformAndSameBlocksMeetOthers)
{
  const int edge = GetParam();
  const glm::ivec3 size{ 2 * edge, edge + 5, edge + 5 };
  MixedPlanes planes(size, edge, 3);
  planes.Target = PlaneOf(size, edge,
    [edge](int x, int y, int z) {
      return x < edge && y < edge ? 77 : x >= edge && y >= edge ? z : MixedNumber(x, y, z, 3);
    });
  planes.A = PlaneOf(size, edge,
    [edge](int x, int y, int z)
    { return x >= edge && y >= edge ? z + (x + y + z) % 31 - 15 : MixedNumber(x, y, z, 4); });
  const EncodedPlane encoded = EncodeWhole(planes.With(AllModes(), true));
  const auto count = [&encoded](bool BlockTokens::*what)
  {
    return std::count_if(encoded.Blocks.begin(), encoded.Blocks.end(),
      [what](const BlockTokens& block) { return block.*what; });
  };
  EXPECT_GT(count(&BlockTokens::Uniform), 0);
  EXPECT_GT(count(&BlockTokens::Same), 0);
  EXPECT_LT(count(&BlockTokens::Uniform) + count(&BlockTokens::Same),
    static_cast<std::int64_t>(encoded.Blocks.size()));
  ExpectDecodes(encoded);
  ExpectClose(encoded);
}

TEST_P(Blocks, WhatIsAsPredictedTakesNoPayload)
{
  const int edge = GetParam();
  const auto plane = [edge](int scale, const glm::ivec3& samples)
  {
    return PlaneOf(
      samples, edge, [scale](int x, int y, int z) { return scale * (8 * x + 4 * y - 12 * z); });
  };
  const glm::ivec3 size{ edge + 1, edge + 1, edge + 1 };
  const PlaneNumbers target = plane(1, size);
  const PlaneNumbers coarser = plane(4, CoarserSamples(size));
  PlaneToEncode job;
  job.Target = &target;
  job.Coarser = &coarser;
  job.CoarseBin = job.FineBin = 3;
  job.Least = -100000;
  job.Greatest = 100000;
  job.CandidateModes = { block::Mode{} };
  const EncodedPlane encoded = EncodeWhole(job);
  EXPECT_TRUE(encoded.Payloads[0].empty());
  ExpectDecodes(encoded);
}

TEST_P(Blocks, ThreadsChangeNothing)
{
  const int edge = GetParam();
  const MixedPlanes planes({ edge + 3, 2 * edge, 9 }, edge, 4);
  const EncodedPlane one = EncodeWhole(planes.With(AllModes(), true), 1);
  const EncodedPlane seven = EncodeWhole(planes.With(AllModes(), true), 7);
  EXPECT_EQ(one.Payloads, seven.Payloads);
  EXPECT_TRUE(one.Decoded == seven.Decoded);
}

TEST_P(Blocks, EachIsToldOfOnceWhenItIsDecoded)
{
  const int edge = GetParam();
  const MixedPlanes planes({ edge + 3, 2 * edge, 9 }, edge, 4);
  const PlaneToEncode plane = planes.With(AllModes(), true);
  for (const int threads : { 1, 3 })
  {
    PlaneNumbers decoded(plane.Target->Samples, edge, false);
    std::vector<BlockTokens> blocks;
    std::vector<std::vector<std::int32_t>> seen(static_cast<std::size_t>(decoded.BlockCount()));
    ThreadPool pool(threads);
    const auto inside = [&](std::int64_t i) { return BoxNumbers(decoded, BlockAt(decoded, i)); };
    EncodePlane(plane, decoded, blocks, pool,
      [&](std::int64_t i)
      {
        EXPECT_TRUE(seen[static_cast<std::size_t>(i)].empty()) << "block " << i;
        seen[static_cast<std::size_t>(i)] = inside(i);
      });
    for (std::int64_t i = 0; i < decoded.BlockCount(); ++i)
    {
      EXPECT_EQ(seen[static_cast<std::size_t>(i)], inside(i)) << "block " << i;
    }
  }
}

TEST_P(Blocks, TrialsChangeWhatIsTaken)
{
  const MixedPlanes planes({ 35, 34, 33 }, GetParam(), 4);
  PlaneToEncode plane = planes.With(AllModes(), true);
  const EncodedPlane looked = EncodeWhole(plane);
  plane.Trials = 3;
  const EncodedPlane tried = EncodeWhole(plane);
  bool differs = false;
  for (std::size_t i = 0; i < looked.Blocks.size(); ++i)
  {
    differs = differs || tried.Blocks[i].Mode != looked.Blocks[i].Mode;
  }
  EXPECT_TRUE(differs || looked.Blocks.size() < 100) << "trials change nothing";
}

TEST_P(Blocks, NumbersMayBeMadeWhenABlockBegins)
{
  const int edge = GetParam();
  const MixedPlanes planes({ edge + 3, 2 * edge, 9 }, edge, 4);
  PlaneToEncode plane = planes.With(AllModes(), true);
  const PlaneNumbers& whole = *plane.Target;
  const EncodedPlane expected = EncodeWhole(plane);
  for (const int threads : { 1, 3 })
  {
    PlaneNumbers decoded(whole.Samples, edge, false), made(whole.Samples, edge, false);
    std::vector<BlockTokens> blocks;
    ThreadPool pool(threads);
    plane.Target = &made;
    EncodePlane(
      plane, decoded, blocks, pool, [](std::int64_t) {},
      [&](std::int64_t i)
      {
        const glm::ivec3 block = BlockAt(made, i), low = block * edge;
        const glm::ivec3 end = low + edge + glm::ivec3(glm::equal(block + 1, made.Blocks));
        for (int z = low.z; z < end.z; ++z)
        {
          for (int y = low.y; y < end.y; ++y)
          {
            const std::int64_t row = made.IndexOf({ low.x, y, z });
            std::copy_n(
              whole.Data<std::int32_t>() + row, end.x - low.x, made.Data<std::int32_t>() + row);
          }
        }
      });
    EXPECT_TRUE(decoded == expected.Decoded);
    for (std::size_t i = 0; i < blocks.size(); ++i)
    {
      EXPECT_EQ(blocks[i].Mode, expected.Blocks[i].Mode) << "block " << i;
      EXPECT_EQ(blocks[i].Tokens, expected.Blocks[i].Tokens) << "block " << i;
    }
  }
}

TEST_P(Blocks, NumbersMustBeKeptInAsManyBitsAsTheLatticeAsksFor)
{
  const MixedPlanes planes({ 9, 9, 9 }, GetParam(), 4);
  PlaneToEncode plane = planes.With(AllModes(), false);
  plane.Least = 0;
  plane.Greatest = 8000; // 16 bits: the numbers are in 32
  EXPECT_THROW((void)EncodeWhole(plane), Error);
}

/// Changes bytes, or a single bit, or nothing but leaves the mode to be changed.
void Damage(std::mt19937& random, int kind, std::vector<std::uint8_t>& payload)
{
  const std::size_t size = payload.size();
  if (kind == 0)
  {
    payload.resize(1 + random() % (2 * size + 2));
  }
  payload.resize(std::max<std::size_t>(1, payload.size()));
  for (int change = 0; change < (kind < 2 ? 3 : 0); ++change)
  {
    payload[random() % payload.size()] = static_cast<std::uint8_t>(random());
  }
  if (kind == 2)
  {
    payload[random() % payload.size()] ^= static_cast<std::uint8_t>(1u << random() % 8);
  }
}

/// Both decoders read what is damaged in the same way, or the fast one says so.
/// @return whether both could read it
bool ExpectDamageIsRead(const EncodedPlane& encoded, bool inBlockItself)
{
  const Box3 box = MakeBox(encoded, { 0, 0, 0 });
  std::vector<std::int32_t> fast, slow;
  try
  {
    fast = DecodeFast(encoded, box);
  }
  catch (const Error&)
  {
  }
  try
  {
    slow = DecodeSlow(encoded, box);
  }
  catch (const std::runtime_error&) // of neighbours it reads more than the other one
  {
  }
  for (const std::int32_t number : fast)
  {
    EXPECT_TRUE(number >= std::min(encoded.Plane.Least, -120000) && number <= 210000000);
  }
  if (inBlockItself)
  {
    EXPECT_EQ(fast.empty(), slow.empty());
  }
  if (!slow.empty())
  {
    EXPECT_EQ(fast, slow);
  }
  return !slow.empty();
}

TEST_P(Blocks, DamagedPayloadsGiveAnErrorOrWhatTheSlowDecoderReads)
{
  const int edge = GetParam();
  for (const bool narrow : { false, true })
  {
    MixedPlanes planes({ edge + 2, edge + 1, edge }, edge, 5);
    EncodedPlane encoded =
      EncodeWhole(narrow ? planes.NarrowWith(AllModes(), true) : planes.With(AllModes(), true));
    std::mt19937 random(7);
    int errors = 0;
    const int trials = edge == 32 ? 80 : 300;
    for (int trial = 0; trial < trials; ++trial)
    {
      SCOPED_TRACE("trial " + std::to_string(trial) + (narrow ? ", 16 bits" : ""));
      const std::size_t i = trial % 2 == 0 ? 0 : random() % encoded.Payloads.size();
      const std::vector<std::uint8_t> good = encoded.Payloads[i];
      const std::uint8_t mode = encoded.Blocks[i].Mode;
      Damage(random, trial / 2 % 4, encoded.Payloads[i]);
      encoded.Blocks[i].Mode = static_cast<std::uint8_t>(random() % block::ModeCount);
      errors += ExpectDamageIsRead(encoded, i == 0) ? 0 : 1;
      ASSERT_FALSE(HasFailure());
      encoded.Payloads[i] = good;
      encoded.Blocks[i].Mode = mode;
    }
    EXPECT_GT(errors, 0);
    EXPECT_LT(errors, trials);
  }
}

INSTANTIATE_TEST_SUITE_P(Edges, Blocks, ::testing::Values(16, 32));

TEST(BlockReferences, ThatAreNotThereAreAnError)
{
  const MixedPlanes planes({ 20, 20, 20 }, 16, 6);
  EncodedPlane encoded =
    EncodeWhole(planes.With({ { block::Reference::Mean, block::Interpolation::Cubic } }, true));
  Box3 box = MakeBox(encoded, { 0, 0, 0 });
  box.Code.B = nullptr;
  EXPECT_THROW(DecodeFast(encoded, box), Error);
  box.Code.A = nullptr;
  EXPECT_THROW(DecodeFast(encoded, box), Error);
  encoded = EncodeWhole(planes.With({ block::Mode{} }, false));
  box = MakeBox(encoded, { 0, 0, 0 });
  EXPECT_NO_THROW(DecodeFast(encoded, box));
  for (BlockCode& block : box.Code.Blocks)
  {
    block.Same = block.Exists;
  }
  EXPECT_THROW(DecodeFast(encoded, box), Error);
  EXPECT_THROW(DecodeSlow(encoded, box), Error);
}

TEST(BlockEdges, OtherThan16And32AreAnError)
{
  for (const int edge : { 4, 8, 64 })
  {
    const MixedPlanes planes({ 20, 20, 20 }, edge, 6);
    EXPECT_THROW((void)EncodeWhole(planes.With({ block::Mode{} }, false)), Error);
    std::vector<std::int32_t> box(static_cast<std::size_t>((edge + 1) * (edge + 1) * (edge + 1)));
    EXPECT_THROW(DecodeBox(edge, {}, BoxCode{}, box.data()), Error);
  }
}

} // namespace
} // namespace banyan::testing
