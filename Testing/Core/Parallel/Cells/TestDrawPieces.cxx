// SPDX-License-Identifier: BSD-3-Clause
// Meshes whose cells are dealt to ranks in any way, against one rank that has all of them.
#include "Base/StopFlag.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/PieceCases.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{

using namespace banyan;
using cellmeshes::Cut;
using piececases::Case;
using piececases::Deal;

constexpr Deal Deals[] = { Deal::OneByOne, Deal::Jagged, Deal::Morton, Deal::Slabs };

/// Sums over all ranks.
struct Took
{
  FloatImage Picture;
  std::int64_t Runs = 0;
  std::int64_t Raw = 0;
  std::int64_t Asked = 0;
  std::uint64_t Bytes = 0;
};

Took Together(const Case& is, Deal deal, int ranks)
{
  const std::vector<int> rankOf = piececases::Dealt(is.Mesh, deal, ranks);
  Took took;
  std::vector<PieceStatistics> statistics(static_cast<std::size_t>(ranks));
  RunOnSimulatedRanks(ranks,
    [&](Communicator& communicator)
    {
      FloatImage picture = is.Together(
        communicator, rankOf, statistics[static_cast<std::size_t>(communicator.Rank())]);
      if (communicator.Rank() == 0)
      {
        took.Picture = std::move(picture);
      }
    });
  for (const PieceStatistics& of : statistics)
  {
    took.Runs += of.Runs;
    took.Raw += of.Raw;
    took.Asked += of.Asked;
    took.Bytes += of.Sent.Bytes;
  }
  return took;
}

std::int64_t SeenIn(const FloatImage& picture)
{
  return std::count_if(picture.Pixels.begin(), picture.Pixels.end(),
    [](const glm::vec4& pixel) { return pixel.a > 0.02f; });
}

TEST(DrawPieces, AnyDealOfAnyShape)
{
  for (const Cut cut : { Cut::Hexahedra, Cut::FiveTetrahedra, Cut::Mixed })
  {
    const Case is(piececases::Cube(6, cut));
    const FloatImage whole = is.Whole();
    EXPECT_GT(SeenIn(whole), 1000);
    for (const Deal deal : Deals)
    {
      for (const int ranks : { 1, 3, 8 })
      {
        const Took took = Together(is, deal, ranks);
        EXPECT_LE(MaxDifference(took.Picture, whole), 1e-5)
          << int(cut) << " " << int(deal) << " " << ranks;
      }
    }
  }
}

TEST(DrawPieces, ManyRanks)
{
  const Case is(piececases::Cube(6, Cut::Mixed));
  const FloatImage whole = is.Whole();
  for (const Deal deal : { Deal::OneByOne, Deal::Jagged })
  {
    EXPECT_LE(MaxDifference(Together(is, deal, 64).Picture, whole), 1e-5) << int(deal);
  }
}

TEST(DrawPieces, CellsThatFoldAndOverlap)
{
  const Case is(piececases::Cube(6, Cut::Mixed, 0.6));
  const FloatImage whole = is.Whole();
  for (const Deal deal : Deals)
  {
    const Took took = Together(is, deal, 5);
    EXPECT_GT(took.Asked, 0) << int(deal);
    EXPECT_LE(MaxDifference(took.Picture, whole), 1e-5) << int(deal);
  }
}

/// Ends of rays that are no whole intervals, and parts of the mesh that are cut off.
Case WithPlanesAndDepths()
{
  Case is(piececases::Cube(6, Cut::Mixed), { 75, 70 }, 0.37);
  const glm::dvec3 normal(-0.6, 0.3, -0.7);
  is.Scene.ClipPlanes = { { normal, 0.3 - glm::dot(normal, glm::dvec3(0.5)) } };
  const auto pixels = static_cast<std::size_t>(is.Scene.Viewport.Count());
  is.Scene.Depth.assign(pixels, 1.0f);
  const glm::dvec4 clip = is.Scene.Camera.WorldToClipMatrix() * glm::dvec4(0.5, 0.5, 0.5, 1.0);
  const auto depth = static_cast<float>(0.5 + 0.5 * clip.z / clip.w);
  std::fill_n(is.Scene.Depth.begin(), pixels / 2, depth);
  return is;
}

TEST(DrawPieces, ClipPlanesAndOpaqueGeometry)
{
  Case is = WithPlanesAndDepths();
  const FloatImage whole = is.Whole();
  Case uncut = is;
  uncut.Scene.ClipPlanes.clear();
  EXPECT_GT(MaxDifference(uncut.Whole(), whole), 0.1);
  uncut = is;
  uncut.Scene.Depth.clear();
  EXPECT_GT(MaxDifference(uncut.Whole(), whole), 0.1);
  for (const Deal deal : Deals)
  {
    EXPECT_LE(MaxDifference(Together(is, deal, 4).Picture, whole), 1e-5) << int(deal);
  }
}

TEST(DrawPieces, Shading)
{
  Case is(piececases::Cube(6, Cut::Mixed));
  const FloatImage plain = is.Whole();
  is.Scene.Shading.On = true;
  is.Scene.Shading.Specular = 0.3f;
  const FloatImage whole = is.Whole();
  EXPECT_GT(MaxDifference(plain, whole), 0.05);
  for (const Deal deal : Deals)
  {
    EXPECT_LE(MaxDifference(Together(is, deal, 4).Picture, whole), 1e-5) << int(deal);
  }
}

TEST(DrawPieces, ValuesOfCells)
{
  Case is(piececases::Cube(6, Cut::Mixed));
  const CellMesh mesh = is.Mesh.View();
  is.Mesh.Values.clear();
  for (std::int64_t cell = 0; cell < mesh.CellCount; ++cell)
  {
    is.Mesh.Values.push_back(
      static_cast<float>(scenes::Standard(piececases::MiddleOf(mesh, cell))));
  }
  is.OfCells = true;
  for (const bool shaded : { false, true })
  {
    is.Scene.Shading.On = shaded;
    const FloatImage whole = is.Whole();
    EXPECT_GT(SeenIn(whole), 1000);
    for (const Deal deal : Deals)
    {
      EXPECT_LE(MaxDifference(Together(is, deal, 4).Picture, whole), 1e-5) << int(deal);
    }
  }
}

TEST(DrawPieces, Projections)
{
  for (const BlendMode mode : { BlendMode::Maximum, BlendMode::Minimum, BlendMode::Average })
  {
    Case is(piececases::Cube(6, Cut::Mixed));
    is.Scene.Blend.Mode = mode;
    const FloatImage whole = is.Whole();
    EXPECT_GT(std::count_if(whole.Pixels.begin(), whole.Pixels.end(),
                [](const glm::vec4& pixel) { return std::max(pixel.r, pixel.g) > 0.002f; }),
      1000);
    for (const Deal deal : Deals)
    {
      EXPECT_LE(MaxDifference(Together(is, deal, 4).Picture, whole),
        mode == BlendMode::Average ? 1e-5 : 0.0)
        << int(mode) << " " << int(deal);
    }
  }
}

TEST(DrawPieces, RaysThatEnd)
{
  Case is(piececases::Cube(6, Cut::Mixed));
  is.Scene.Transfer.UnitDistance *= 0.02;
  is.Scene.OpacityLimit = 0.999f;
  const FloatImage whole = is.Whole();
  EXPECT_GT(std::count_if(whole.Pixels.begin(), whole.Pixels.end(),
              [](const glm::vec4& pixel) { return pixel.a >= 0.999f; }),
    300);
  for (const Deal deal : Deals)
  {
    EXPECT_LE(MaxDifference(Together(is, deal, 5).Picture, whole), 1.0 / 255) << int(deal);
  }
}

TEST(DrawPieces, PartsOfPicturesAndSkippedPixels)
{
  Case is(piececases::Cube(6, Cut::Hexahedra));
  is.Scene.Viewport = { { 21, 9 }, { 63, 58 } };
  EXPECT_GT(SeenIn(is.Whole()), 500);
  EXPECT_LE(MaxDifference(Together(is, Deal::Jagged, 4).Picture, is.Whole()), 1e-5);
  for (const int stride : { 2, 4 })
  {
    is.Scene.Samplings = std::make_shared<const TileSamplings>(is.Scene.Camera.ImageSize(),
      std::vector{ RaySampling{ 0, is.Scene.SampleDistance, stride } });
    EXPECT_LE(MaxDifference(Together(is, Deal::Jagged, 4).Picture, is.Whole()), 1e-5) << stride;
  }
}

TEST(DrawPieces, ThinShells)
{
  // Thinner than a step: intervals hold the ends of several ranks' cells.
  cellmeshes::OwnedCellMesh mesh = cellmeshes::AsCells(cellmeshes::Sector({ 1, 20, 5 }, 0.98, 4.0));
  cellmeshes::SetValues(mesh, scenes::Linear);
  Case is(mesh, { 75, 70 }, 2.0);
  is.Scene.Transfer.UnitDistance *= 0.1;
  const FloatImage whole = is.Whole();
  EXPECT_GT(SeenIn(whole), 500);
  for (const Deal deal : Deals)
  {
    EXPECT_LE(MaxDifference(Together(is, deal, 6).Picture, whole), 1e-5) << int(deal);
  }
}

TEST(DrawPieces, RanksWithoutCells)
{
  cellmeshes::OwnedCellMesh mesh = cellmeshes::AsCells(cellmeshes::Sector({ 1, 2, 1 }));
  cellmeshes::SetValues(mesh, scenes::Linear);
  const Case is(mesh);
  const FloatImage whole = is.Whole();
  EXPECT_GT(SeenIn(whole), 300);
  EXPECT_LE(MaxDifference(Together(is, Deal::Slabs, 5).Picture, whole), 1e-5);
}

TEST(DrawPieces, LargeCellsAndParallelRays)
{
  const Case is(piececases::Cube(2, Cut::Mixed), { 75, 70 }, 0.05, true);
  const FloatImage whole = is.Whole();
  EXPECT_GT(SeenIn(whole), 500);
  for (const Deal deal : Deals)
  {
    EXPECT_LE(MaxDifference(Together(is, deal, 3).Picture, whole), 1e-5) << int(deal);
  }
}

TEST(DrawPieces, CellsThatSeveralRanksHave)
{
  // Every second cell is there once more, with other values.
  cellmeshes::OwnedCellMesh mesh = piececases::Cube(6, Cut::Mixed);
  cellmeshes::OwnedCellMesh other = mesh;
  cellmeshes::SetValues(other, scenes::Linear);
  std::vector<int> half(static_cast<std::size_t>(other.CellCount()));
  for (std::size_t cell = 0; cell < half.size(); ++cell)
  {
    half[cell] = static_cast<int>(cell % 2);
  }
  const Case plain(mesh);
  cellmeshes::Append(mesh, piececases::PieceOf(other, half, 1, false));
  Case is(mesh);
  EXPECT_GT(MaxDifference(is.Whole(), plain.Whole()), 0.05);
  for (const bool shaded : { false, true })
  {
    is.Scene.Shading.On = shaded;
    const FloatImage whole = is.Whole();
    for (const int ranks : { 2, 5 })
    {
      EXPECT_LE(MaxDifference(Together(is, Deal::Slabs, ranks).Picture, whole), 1e-5) << ranks;
    }
  }
}

std::shared_ptr<const TileSamplings> SamplingsOf(
  const Case& is, const std::vector<RaySampling>& samplings)
{
  auto all = std::make_shared<TileSamplings>(is.Scene.Camera.ImageSize(), samplings);
  for (int y = 0; y < all->Tiles().y; ++y)
  {
    for (int x = 0; x < all->Tiles().x; ++x)
    {
      all->SetNumber({ x, y }, (x + y) % static_cast<int>(samplings.size()));
    }
  }
  return all;
}

TEST(DrawPieces, LatticesAreThoseOfTheWholeMesh)
{
  for (const Cut cut : { Cut::Hexahedra, Cut::FiveTetrahedra, Cut::Mixed })
  {
    for (const double offset : { 0.1, 0.6 }) // cells fold and overlap where points are far off
    {
      Case is(piececases::Cube(6, cut, offset));
      for (const int level : { 1, 2 })
      {
        is.Scene.Samplings = SamplingsOf(is, { { level, is.Scene.SampleDistance } });
        const FloatImage whole = is.Whole();
        EXPECT_GT(SeenIn(whole), 1000);
        for (const Deal deal : Deals)
        {
          const Took took = Together(is, deal, 5);
          EXPECT_LE(MaxDifference(took.Picture, whole), 1e-5)
            << int(cut) << " " << int(deal) << " " << level;
          EXPECT_EQ(took.Runs, 0) << "each rank draws its tiles alone";
        }
      }
    }
  }
}

TEST(DrawPieces, CellsAndLatticesInOnePicture)
{
  Case is(piececases::Cube(6, Cut::Mixed), { 150, 140 });
  const double step = is.Scene.SampleDistance;
  const FloatImage cells = is.Whole();
  is.Scene.Samplings = SamplingsOf(is,
    { { 0, step }, { 1, step }, { 0, 0.5 * step, 2 }, { 2, 2.0 * step, 4 }, { 1, 0.25 * step } });
  for (const bool shaded : { false, true })
  {
    is.Scene.Shading.On = shaded;
    const FloatImage whole = is.Whole();
    EXPECT_GT(MaxDifference(whole, cells), 0.01);
    for (const int ranks : { 2, 7, 16 })
    {
      EXPECT_LE(MaxDifference(Together(is, Deal::Jagged, ranks).Picture, whole), 1e-5) << ranks;
    }
  }
}

TEST(DrawPieces, LatticesOfCellValuesAndProjections)
{
  Case is(piececases::Cube(6, Cut::Mixed));
  is.Scene.Samplings = SamplingsOf(is, { { 1, is.Scene.SampleDistance } });
  is.Scene.Blend.Mode = BlendMode::Maximum;
  EXPECT_EQ(MaxDifference(Together(is, Deal::OneByOne, 4).Picture, is.Whole()), 0.0);
  is.Scene.Blend.Mode = BlendMode::Composite;
  const CellMesh mesh = is.Mesh.View();
  is.Mesh.Values.clear();
  for (std::int64_t cell = 0; cell < mesh.CellCount; ++cell)
  {
    is.Mesh.Values.push_back(
      static_cast<float>(scenes::Standard(piececases::MiddleOf(mesh, cell))));
  }
  // Cells without a value are not there, and nor are their faces.
  is.Mesh.Values[3] = std::numeric_limits<float>::quiet_NaN();
  is.OfCells = true;
  for (const bool shaded : { false, true })
  {
    is.Scene.Shading.On = shaded;
    const FloatImage whole = is.Whole();
    EXPECT_GT(SeenIn(whole), 1000);
    EXPECT_LE(MaxDifference(Together(is, Deal::OneByOne, 4).Picture, whole), 1e-5) << shaded;
  }
}

TEST(DrawPieces, LatticesWhereRanksHaveNoCells)
{
  cellmeshes::OwnedCellMesh mesh = cellmeshes::AsCells(cellmeshes::Sector({ 1, 2, 1 }));
  cellmeshes::SetValues(mesh, scenes::Linear);
  Case is(mesh);
  is.Scene.Samplings = SamplingsOf(is, { { 1, is.Scene.SampleDistance } });
  for (const bool shaded : { false, true })
  {
    is.Scene.Shading.On = shaded;
    const FloatImage whole = is.Whole();
    EXPECT_GT(SeenIn(whole), 300);
    EXPECT_LE(MaxDifference(Together(is, Deal::Slabs, 5).Picture, whole), 1e-5);
  }
}

TEST(DrawPieces, EveryRankGetsAProbe)
{
  Case is(piececases::Cube(6, Cut::Mixed));
  is.Root = EveryRank;
  const double step = is.Scene.SampleDistance;
  is.Scene.Samplings = SamplingsOf(is, { { 0, step }, { 1, step } });
  const FloatImage whole = is.Whole();
  const std::vector<int> rankOf = piececases::Dealt(is.Mesh, Deal::Jagged, 3);
  RunOnSimulatedRanks(3,
    [&](Communicator& communicator)
    {
      PieceStatistics statistics;
      EXPECT_LE(MaxDifference(is.Together(communicator, rankOf, statistics), whole), 1e-5);
      communicator.Barrier();
    });
}

TEST(DrawPieces, AllRanksHearOfOneThatStops)
{
  for (const int level : { 0, 1 })
  {
    RunOnSimulatedRanks(3,
      [&](Communicator& communicator)
      {
        Case is(piececases::Cube(6, Cut::Mixed));
        is.Scene.Samplings = SamplingsOf(is, { { level, is.Scene.SampleDistance } });
        StopFlag stop;
        if (communicator.Rank() == 1)
        {
          stop.Ask();
        }
        is.Scene.Stop = &stop;
        const std::vector<int> rankOf = piececases::Dealt(is.Mesh, Deal::Jagged, 3);
        PieceStatistics statistics;
        EXPECT_THROW(is.Together(communicator, rankOf, statistics), CollectiveError);
        is.Scene.Stop = nullptr;
        const FloatImage picture = is.Together(communicator, rankOf, statistics);
        EXPECT_EQ(picture.Pixels.empty(), communicator.Rank() != 0);
        communicator.Barrier();
      });
  }
}

} // namespace
