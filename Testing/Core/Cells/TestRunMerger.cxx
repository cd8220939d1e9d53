// SPDX-License-Identifier: BSD-3-Clause
// Samples of a tile are dealt to ranks in any way: merged, they are those that one rank has.
#include "Base/ThreadPool.h"
#include "Cells/DrawnMesh.h"
#include "Render/Cells/CellCaster.h"
#include "Render/Cells/RunCollector.h"
#include "Render/Cells/RunMerger.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{

using namespace banyan;
using cellmeshes::DrawnMesh;
using cellmeshes::Numbers;

constexpr int Slabs = 2;
constexpr std::int64_t FirstNumber = 100;

/// A mesh whose cells own samples, and tables to blend with.
struct Tables
{
  explicit Tables(BlendMode mode, bool shaded)
    : Drawn(MakeMesh())
    , Pool(1)
  {
    this->Drawn.Scene.Blend.Mode = mode;
    this->Drawn.Scene.Shading.On = shaded;
    const CellMesh mesh = this->Drawn.Mesh->View();
    CellFacts facts = CheckCells(mesh, this->Pool);
    this->Cells = DrawnCells::OfPiece(mesh, facts, ExtentOf(mesh, facts, this->Pool), this->Pool);
    this->Source = std::make_unique<CellSource>(this->Drawn.Field, this->Pool);
    this->Caster = std::make_unique<CellCaster>(
      this->Drawn.Scene, *this->Source, *this->Source, nullptr, this->Pool, this->Statistics);
  }

  static DrawnMesh MakeMesh()
  {
    cellmeshes::OwnedCellMesh mesh = cellmeshes::Cube(4, cellmeshes::Cut::Hexahedra);
    cellmeshes::SetValues(mesh, scenes::Standard);
    return DrawnMesh(mesh);
  }

  SlabBlend Blend() const { return this->Caster->BlendOf(*this->Caster->Drawn().AnySampling); }

  DrawnMesh Drawn;
  ThreadPool Pool;
  RayStatistics Statistics;
  std::shared_ptr<const DrawnCells> Cells;
  std::unique_ptr<CellSource> Source;
  std::unique_ptr<CellCaster> Caster;
};

struct Claim
{
  int Rank;
  std::uint32_t Place;
  bool Contested;
  float Value;
  float Cosine;
};

struct Crossing
{
  int Rank;
  BorderCrossing Is;
  float Before; ///< part of the interval
};

struct Interval
{
  std::vector<Claim> Claims;
  std::vector<Crossing> Crossings;
};

/// How samples are dealt.
struct Deal
{
  int Ranks = 3;
  double Changes = 0.1;  ///< how often the rank changes along a ray
  double Gaps = 0.1;     ///< how often a sample is nobody's
  double Overlaps = 0.0; ///< how often another rank has it, too
  double Contested = 0.0;
  double Crossings = 0.1;
  bool Ends = true; ///< whether rays have heads and tails
};

/// The intervals of a tile's rays.
class DealtTile
{
public:
  DealtTile(const Deal& deal, std::uint64_t seed)
    : Of(deal)
  {
    Numbers numbers(seed);
    const auto often = [&](double part) { return numbers.Between(0.0, 1.0) < part; };
    this->Intervals.resize(RayTile::Slots * Rows);
    for (int slot = 0; slot < RayTile::Slots; ++slot)
    {
      this->Heads[slot] = deal.Ends && often(0.5) ? numbers.Between(0.1, 0.9) : 0.0;
      this->Tails[slot] = deal.Ends && often(0.5) ? numbers.Between(0.1, 0.9) : 0.0;
      int rank = static_cast<int>(numbers.Below(deal.Ranks));
      for (int row = 0; row < Rows; ++row)
      {
        rank = often(deal.Changes) ? static_cast<int>(numbers.Below(deal.Ranks)) : rank;
        Interval& interval = this->Intervals[slot * Rows + row];
        const auto claim = [&](int of)
        {
          interval.Claims.push_back({ of, static_cast<std::uint32_t>(8 * numbers.Below(8) + of),
            often(deal.Contested), static_cast<float>(numbers.Between(0.0, 1.0)),
            static_cast<float>(numbers.Between(0.0, 1.0)) });
        };
        if (!often(deal.Gaps))
        {
          claim(rank);
        }
        for (int other = 0; other < deal.Ranks; ++other)
        {
          if (other != rank && often(deal.Overlaps))
          {
            claim(other);
          }
        }
        while (often(deal.Crossings))
        {
          interval.Crossings.push_back({ static_cast<int>(numbers.Below(deal.Ranks)),
            { often(0.5), static_cast<float>(numbers.Between(0.0, 1.0)),
              static_cast<float>(numbers.Between(0.0, 1.0)) },
            static_cast<float>(numbers.Between(0.0, 1.0)) });
        }
      }
    }
  }

  /// Fills a slab with what one rank has, or all of them together.
  void Fill(int rank, int firstRow, SampleSlab& slab, SlabOwners& owners) const
  {
    for (int slot = 0; slot < RayTile::Slots; ++slot)
    {
      for (int row = 0; row < SampleSlab::Rows; ++row)
      {
        const Interval& interval = this->Intervals[slot * Rows + firstRow + row];
        const int index = SampleSlab::IndexOf(slot, row);
        const Claim* last = nullptr;
        for (const Claim& claim : interval.Claims)
        {
          const bool has = rank < 0 || claim.Rank == rank;
          last = has && (!last || claim.Place > last->Place) ? &claim : last;
        }
        if (last)
        {
          slab.Value[index] = last->Value;
          slab.Cosine[index] = last->Cosine;
          owners.Of[index] = last->Place | (last->Contested ? SlabOwners::Contested : 0);
          slab.Marks[slot / SampleSlab::Lanes] |= std::uint64_t{ 1 } << row;
        }
        const float length = this->LengthOf(slot, firstRow + row);
        for (const Crossing& crossing : interval.Crossings)
        {
          if (rank < 0 || crossing.Rank == rank)
          {
            slab.Cross(slot, row, crossing.Is, crossing.Before * length, length);
          }
        }
      }
    }
  }

  /// Rays that go along the rows.
  void Open(RayTile& rays, TileRows& rows, float limit) const
  {
    rays.Rect = { { 0, 0 }, { RayTile::Edge, RayTile::Edge } };
    rays.TransmittanceLimit = limit;
    rays.ActiveRays = RayTile::Slots;
    rows.FirstNumber = FirstNumber;
    rows.Count = Rows;
    rows.AnyEnds = this->Of.Ends;
    for (int slot = 0; slot < RayTile::Slots; ++slot)
    {
      rays.SetPixel(slot, { 0.0f, 0.0f, 0.0f, 1.0f });
      rays.Head.Fraction[slot] = static_cast<float>(this->Heads[slot]);
      rays.Tail.Fraction[slot] = static_cast<float>(this->Tails[slot]);
      rows.Head[slot] = this->Heads[slot] > 0.0 ? 0 : TileRows::None;
      rows.Tail[slot] = this->Tails[slot] > 0.0 ? Rows - 1 : TileRows::None;
    }
  }

  /// What one rank draws.
  TileRuns RunsOf(int rank, const Tables& tables, const AskedTile* asked, float limit = -1.0f) const
  {
    TileRuns found;
    const auto room = std::make_unique<Room>();
    this->Open(room->Rays, room->Rows, limit);
    room->Collector.Begin(room->Rows, asked);
    for (int slab = 0; slab < Slabs; ++slab)
    {
      const int firstRow = slab * SampleSlab::Rows;
      this->Fill(rank, firstRow, room->Slab, room->Owners);
      BlendSlabInRuns(room->Slab, room->Rows, firstRow, tables.Blend(), room->Rays, room->Owners,
        room->Collector);
    }
    room->Collector.Finish(room->Rays, *tables.Cells, found);
    return found;
  }

  /// What one rank draws that has all.
  TilePixels Whole(const Tables& tables, float limit = -1.0f) const
  {
    const auto room = std::make_unique<Room>();
    this->Open(room->Rays, room->Rows, limit);
    for (int slab = 0; slab < Slabs; ++slab)
    {
      const int firstRow = slab * SampleSlab::Rows;
      this->Fill(-1, firstRow, room->Slab, room->Owners);
      BlendSlab(room->Slab, room->Rows, firstRow, tables.Blend(), room->Rays);
    }
    TilePixels pixels;
    for (int slot = 0; slot < RayTile::Slots; ++slot)
    {
      const glm::vec4 pixel = room->Rays.PixelOf(slot);
      pixels[TileRuns::PixelAt(room->Rays.PixelAt(slot))] = { pixel.r, pixel.g, pixel.b,
        1.0f - pixel.a };
    }
    return pixels;
  }

  /// The intervals of a ray that a rank has anything of.
  std::vector<std::int64_t> NumbersOf(int rank, int slot) const
  {
    std::vector<std::int64_t> numbers;
    for (int row = 0; row < Rows; ++row)
    {
      const Interval& interval = this->Intervals[slot * Rows + row];
      const auto has = [&](const auto& of) { return of.Rank == rank; };
      if (std::any_of(interval.Claims.begin(), interval.Claims.end(), has) ||
          std::any_of(interval.Crossings.begin(), interval.Crossings.end(), has))
      {
        numbers.push_back(FirstNumber + row);
      }
    }
    return numbers;
  }

private:
  static constexpr int Rows = Slabs * SampleSlab::Rows;

  struct Room
  {
    RayTile Rays;
    TileRows Rows;
    SampleSlab Slab;
    SlabOwners Owners;
    RunCollector Collector;
  };

  float LengthOf(int slot, int row) const
  {
    return row == 0 && this->Heads[slot] > 0.0          ? static_cast<float>(this->Heads[slot])
           : row == Rows - 1 && this->Tails[slot] > 0.0 ? static_cast<float>(this->Tails[slot])
                                                        : 1.0f;
  }

  Deal Of;
  std::vector<Interval> Intervals;
  double Heads[RayTile::Slots] = {};
  double Tails[RayTile::Slots] = {};
};

double Apart(const TilePixels& a, const TilePixels& b)
{
  double worst = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    for (int k = 0; k < 4; ++k)
    {
      const double difference = std::abs(a[i][k] - b[i][k]);
      // Not a number is infinitely far away.
      worst = difference <= worst ? worst : difference;
    }
  }
  return worst;
}

double Largest(const TilePixels& pixels)
{
  double largest = 0.0;
  for (const glm::vec4& pixel : pixels)
  {
    largest = std::max({ largest, double{ pixel.r }, double{ pixel.a } });
  }
  return largest;
}

/// The intervals of a ray in what a rank has sent, in the order of the ray.
std::vector<std::int64_t> NumbersIn(const TileRuns& runs, std::uint16_t pixel)
{
  std::vector<std::int64_t> numbers;
  for (const RayRun& run : runs.Runs)
  {
    for (std::int64_t i = run.First; run.Pixel == pixel && i <= run.Last; ++i)
    {
      numbers.push_back(i);
    }
  }
  for (const RawInterval& raw : runs.Raw)
  {
    if (raw.Pixel == pixel)
    {
      numbers.push_back(raw.Number);
    }
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

struct Merged
{
  TilePixels Pixels;
  std::size_t Asked = 0; ///< intervals
};

/// Draws and merges, with a second round where ranks do not agree.
Merged Together(const DealtTile& tile, const Deal& deal, const Tables& tables)
{
  std::vector<TileRuns> runs;
  for (int rank = 0; rank < deal.Ranks; ++rank)
  {
    runs.push_back(tile.RunsOf(rank, tables, nullptr));
  }
  Merged merged;
  RunMerger merger;
  std::vector<std::vector<AskedIntervals>> asked(deal.Ranks);
  for (int rank = 0; rank < deal.Ranks; ++rank)
  {
    merger.Add(rank, runs[rank]);
  }
  const bool agree = merger.Agree(asked);
  merger.Merge(tables.Blend(), -1.0f, merged.Pixels);
  if (agree)
  {
    return merged;
  }
  std::vector<TileRuns> anew;
  for (int rank = 0; rank < deal.Ranks; ++rank)
  {
    merged.Asked += asked[rank].size();
    AskedTile of;
    of.Intervals = asked[rank];
    SortAsked(of.Intervals);
    TileRuns part = tile.RunsOf(rank, tables, &of);
    RemoveAsked(of, runs[rank]);
    anew.push_back(std::move(part));
  }
  for (int rank = 0; rank < deal.Ranks; ++rank)
  {
    merger.Add(rank, runs[rank]);
    merger.Add(rank, anew[rank]);
  }
  for (auto& of : asked)
  {
    of.clear();
  }
  EXPECT_TRUE(merger.Agree(asked));
  merger.Merge(tables.Blend(), -1.0f, merged.Pixels);
  return merged;
}

struct Case
{
  BlendMode Mode;
  bool Shaded;
};
const Case Cases[] = { { BlendMode::Composite, false }, { BlendMode::Composite, true },
  { BlendMode::Maximum, false }, { BlendMode::Minimum, false }, { BlendMode::Average, false } };

TEST(RunMerger, SamplesThatOneRankHas)
{
  for (const Case& is : Cases)
  {
    const Tables tables(is.Mode, is.Shaded);
    for (const int ranks : { 1, 6 })
    {
      Deal deal;
      deal.Ranks = ranks;
      deal.Contested = 0.02;
      deal.Crossings = 0.0;
      const DealtTile tile(deal, 1);
      const TilePixels whole = tile.Whole(tables);
      EXPECT_GT(Largest(whole), 0.3);
      const Merged merged = Together(tile, deal, tables);
      EXPECT_EQ(merged.Asked, 0u);
      EXPECT_LE(Apart(merged.Pixels, whole) / Largest(whole), 2e-6) << int(is.Mode) << ranks;
    }
  }
}

TEST(RunMerger, SamplesThatSeveralRanksHave)
{
  for (const Case& is : Cases)
  {
    const Tables tables(is.Mode, is.Shaded);
    for (const int ranks : { 4 })
    {
      Deal deal;
      deal.Ranks = ranks;
      deal.Overlaps = 0.1;
      deal.Contested = 0.3;
      const DealtTile tile(deal, 2);
      const TilePixels whole = tile.Whole(tables);
      const Merged merged = Together(tile, deal, tables);
      EXPECT_GT(merged.Asked, 100u);
      EXPECT_LE(Apart(merged.Pixels, whole) / Largest(whole), 2e-6) << int(is.Mode) << ranks;
    }
  }
}

TEST(RunMerger, ContestedSamplesTakeNoSecondRound)
{
  const Tables tables(BlendMode::Composite, true);
  Deal deal;
  deal.Overlaps = 0.3;
  deal.Contested = 1.0;
  deal.Crossings = 0.0;
  const DealtTile tile(deal, 3);
  const Merged merged = Together(tile, deal, tables);
  EXPECT_EQ(merged.Asked, 0u);
  EXPECT_LE(Apart(merged.Pixels, tile.Whole(tables)), 2e-6);
}

TEST(RunMerger, RunsHoldWhatARankHas)
{
  const Tables tables(BlendMode::Composite, false);
  Deal deal;
  deal.Overlaps = 0.05;
  deal.Contested = 0.1;
  const DealtTile tile(deal, 4);
  for (int rank = 0; rank < deal.Ranks; ++rank)
  {
    const TileRuns runs = tile.RunsOf(rank, tables, nullptr);
    const auto at = std::make_unique<RayTile>();
    for (int slot = 0; slot < RayTile::Slots; slot += 37)
    {
      const std::uint16_t pixel = TileRuns::PixelAt(at->PixelAt(slot));
      EXPECT_EQ(NumbersIn(runs, pixel), tile.NumbersOf(rank, slot)) << slot;
    }
    // Each run is as long as it can be.
    for (std::size_t i = 1; i < runs.Runs.size(); ++i)
    {
      const RayRun& a = runs.Runs[i - 1];
      const RayRun& b = runs.Runs[i];
      ASSERT_TRUE(a.Pixel < b.Pixel || (a.Pixel == b.Pixel && a.Last + 1 < b.First));
    }
  }
}

TEST(RunMerger, RaysEnd)
{
  const Tables tables(BlendMode::Composite, false);
  Deal deal;
  deal.Crossings = 0.01;
  const DealtTile tile(deal, 5);
  const float limit = 0.4f;
  const TilePixels whole = tile.Whole(tables);
  EXPECT_GT(Largest(whole), 0.7);
  std::size_t all = 0;
  std::size_t some = 0;
  RunMerger merger;
  std::vector<TileRuns> runs;
  for (int rank = 0; rank < deal.Ranks; ++rank)
  {
    runs.push_back(tile.RunsOf(rank, tables, nullptr, limit));
    some += runs.back().Runs.size();
    all += tile.RunsOf(rank, tables, nullptr).Runs.size();
  }
  EXPECT_LT(some, all);
  for (int rank = 0; rank < deal.Ranks; ++rank)
  {
    merger.Add(rank, runs[rank]);
  }
  TilePixels pixels;
  merger.Merge(tables.Blend(), limit, pixels);
  EXPECT_LE(Apart(pixels, whole), limit);
}

TEST(RunMerger, OrderOfRanksDoesNotMatter)
{
  const Tables tables(BlendMode::Composite, false);
  Deal deal;
  deal.Overlaps = 0.3;
  deal.Contested = 1.0;
  const DealtTile tile(deal, 6);
  RunMerger merger;
  std::vector<TileRuns> runs;
  for (int rank = 0; rank < deal.Ranks; ++rank)
  {
    runs.push_back(tile.RunsOf(rank, tables, nullptr));
  }
  TilePixels forwards;
  TilePixels backwards;
  for (int rank = 0; rank < deal.Ranks; ++rank)
  {
    merger.Add(rank, runs[rank]);
  }
  merger.Merge(tables.Blend(), -1.0f, forwards);
  for (int rank = deal.Ranks - 1; rank >= 0; --rank)
  {
    merger.Add(rank, runs[rank]);
  }
  merger.Merge(tables.Blend(), -1.0f, backwards);
  EXPECT_EQ(Apart(forwards, backwards), 0.0);
}

TEST(RunMerger, PixelsThatAreAskedFor)
{
  Numbers numbers(3);
  for (const std::uint64_t count : { 1, 3, 40 })
  {
    AskedTile asked;
    asked.Position = { 2, 1 };
    std::vector<glm::ivec2> at;
    for (std::uint64_t i = 0; i < count; ++i)
    {
      const auto pixel = static_cast<std::uint16_t>(numbers.Below(RayTile::Slots));
      asked.Intervals.push_back({ 0, 0, pixel });
      at.emplace_back(64 + pixel % 32, 32 + pixel / 32);
    }
    const AskedPixels pixels(asked);
    int found = 0;
    for (int i = 0; i < 1000; ++i)
    {
      const auto place = [&](int low) { return low - 5 + static_cast<int>(numbers.Below(42)); };
      PixelRect rect;
      rect.Lo = { place(64), place(32) };
      rect.Hi = rect.Lo + glm::ivec2(numbers.Below(33), numbers.Below(33));
      const bool any = std::any_of(at.begin(), at.end(),
        [&](const glm::ivec2& p)
        { return p.x >= rect.Lo.x && p.y >= rect.Lo.y && p.x < rect.Hi.x && p.y < rect.Hi.y; });
      found += any == pixels.AnyIn(rect) ? 1 : 0;
    }
    EXPECT_EQ(found, 1000) << count;
  }
}

} // namespace
