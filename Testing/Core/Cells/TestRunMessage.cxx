// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Render/Cells/RunMessage.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{

using namespace banyan;

RayRun MakeRun(std::uint16_t pixel, std::int64_t first, std::int64_t last)
{
  RayRun run;
  run.Pixel = pixel;
  run.First = first;
  run.Last = last;
  run.Color[0] = 0.25f;
  run.Color[2] = 0.5f;
  run.Transmittance = 0.125f;
  return run;
}

TileRuns MakeTile()
{
  TileRuns tile;
  tile.Position = { 3, 70 };
  tile.Runs = { MakeRun(0, -1, -1), MakeRun(0, 5, 1000), MakeRun(1023, 1LL << 40, 1LL << 41) };
  RayRun nothing;
  nothing.Pixel = 1023;
  nothing.First = nothing.Last = (1LL << 41) + 2;
  tile.Runs.push_back(nothing);
  RawInterval claimed;
  claimed.Pixel = 7;
  claimed.Number = 12;
  claimed.Claimed = true;
  claimed.Value = -3.5f;
  claimed.Key = { 0xfedcba9876543210, 0x123456789 };
  RawInterval crossed;
  crossed.Pixel = 7;
  crossed.Number = 13;
  crossed.Length = 0.25f;
  crossed.Crossed = { 0.125f, 1.5f, 0.0f, 3.0f, -2.0f, 1.0f, -0.0625f, -1.0f };
  RawInterval both = claimed;
  both.Pixel = 900;
  both.Cosine = 0.75f;
  both.Crossed = { 0.125f, 1.5f, 0.5f, 1.0f, 0.0f, 1.0f, 0.0625f, 1.0f };
  tile.Raw = { claimed, crossed, both };
  return tile;
}

void ExpectSame(const TileRuns& a, const TileRuns& b)
{
  EXPECT_EQ(a.Position, b.Position);
  ASSERT_EQ(a.Runs.size(), b.Runs.size());
  for (std::size_t i = 0; i < a.Runs.size(); ++i)
  {
    EXPECT_EQ(a.Runs[i].Pixel, b.Runs[i].Pixel);
    EXPECT_EQ(a.Runs[i].First, b.Runs[i].First);
    EXPECT_EQ(a.Runs[i].Last, b.Runs[i].Last);
    EXPECT_TRUE(std::equal(a.Runs[i].Color, a.Runs[i].Color + 3, b.Runs[i].Color));
    EXPECT_EQ(a.Runs[i].Transmittance, b.Runs[i].Transmittance);
  }
  ASSERT_EQ(a.Raw.size(), b.Raw.size());
  for (std::size_t i = 0; i < a.Raw.size(); ++i)
  {
    const RawInterval& p = a.Raw[i];
    const RawInterval& q = b.Raw[i];
    EXPECT_EQ(p.Pixel, q.Pixel);
    EXPECT_EQ(p.Number, q.Number);
    EXPECT_EQ(p.Claimed, q.Claimed);
    EXPECT_EQ(p.Length, q.Length);
    EXPECT_EQ(p.Value, q.Value);
    EXPECT_EQ(p.Cosine, q.Cosine);
    EXPECT_TRUE(p.Key == q.Key);
    EXPECT_EQ(p.Crossed.Change, q.Crossed.Change);
    EXPECT_EQ(p.Crossed.AtBorder, q.Crossed.AtBorder);
    EXPECT_EQ(p.Crossed.CosineAtBorder, q.Crossed.CosineAtBorder);
    EXPECT_EQ(p.Crossed.Count, q.Crossed.Count);
    EXPECT_EQ(p.Crossed.Before, q.Crossed.Before);
    EXPECT_EQ(p.Crossed.Behind, q.Crossed.Behind);
    EXPECT_EQ(p.Crossed.Nearest, q.Crossed.Nearest);
    EXPECT_EQ(p.Crossed.NearestEnters, q.Crossed.NearestEnters);
  }
}

TEST(RunMessage, RoundTrip)
{
  const TileRuns tile = MakeTile();
  TileRuns other = tile;
  other.Position = { 0, 0 };
  other.Runs.clear();
  Bytes message;
  PutRuns(message, tile);
  PutRuns(message, TileRuns());
  PutRuns(message, other);
  EXPECT_LT(message.size(), 350u);
  const std::vector<TileRuns> tiles = TakeRuns(message.data(), message.size());
  ASSERT_EQ(tiles.size(), 2u); // what has nothing takes no bytes
  ExpectSame(tiles[0], tile);
  ExpectSame(tiles[1], other);
}

TEST(RunMessage, Asked)
{
  AskedTile asked;
  asked.Position = { 5, 6 };
  asked.Intervals = { { 4, 4, 0 }, { 9, 100, 0 }, { -1, 2, 1023 } };
  Bytes message;
  PutAsked(message, asked);
  const std::vector<AskedTile> tiles = TakeAsked(message.data(), message.size());
  ASSERT_EQ(tiles.size(), 1u);
  EXPECT_EQ(tiles[0].Position, asked.Position);
  ASSERT_EQ(tiles[0].Intervals.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i)
  {
    EXPECT_EQ(tiles[0].Intervals[i].Pixel, asked.Intervals[i].Pixel);
    EXPECT_EQ(tiles[0].Intervals[i].First, asked.Intervals[i].First);
    EXPECT_EQ(tiles[0].Intervals[i].Last, asked.Intervals[i].Last);
  }
}

TEST(RunMessage, CutOffAnywhere)
{
  Bytes message;
  PutRuns(message, MakeTile());
  for (std::size_t size = 1; size < message.size(); ++size)
  {
    EXPECT_THROW(TakeRuns(message.data(), size), Error) << size;
  }
}

TEST(RunMessage, PixelsOutsideAndNumbersThatAreNone)
{
  TileRuns tile = MakeTile();
  tile.Raw.back().Pixel = RayTile::Slots;
  Bytes message;
  PutRuns(message, tile);
  EXPECT_THROW(TakeRuns(message.data(), message.size()), Error);
  for (const float bad : { std::numeric_limits<float>::infinity(), std::nanf("") })
  {
    tile = MakeTile();
    tile.Raw.front().Value = bad;
    message.clear();
    PutRuns(message, tile);
    EXPECT_THROW(TakeRuns(message.data(), message.size()), Error);
    tile = MakeTile();
    tile.Runs.front().Color[1] = bad;
    message.clear();
    PutRuns(message, tile);
    EXPECT_THROW(TakeRuns(message.data(), message.size()), Error);
  }
}

} // namespace
