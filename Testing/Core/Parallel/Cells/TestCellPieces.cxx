// SPDX-License-Identifier: BSD-3-Clause
// What pieces of a mesh know of the whole one.
#include "Cells/CellOrder.h"
#include "Parallel/Cells/PieceMeans.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/PieceCases.h"
#include "Render/Cells/PointMeans.h"

#include <gtest/gtest.h>

#include <mutex>
#include <set>
#include <tuple>

namespace
{

using namespace banyan;
using cellmeshes::Cut;
using cellmeshes::OwnedCellMesh;
using piececases::Deal;

/// The middle of a face, rounded: names it on all ranks.
using Place = std::tuple<double, double, double>;

Place MiddleOfFace(const DrawnCells& cells, const BorderFace& face)
{
  const MeshCell cell = cells.Mesh.Cell(cells.Order[face.Cell]);
  const CellFace& of = FacesOf(cell.Shape).Faces[face.Face];
  glm::dvec3 sum(0.0);
  for (int i = 0; i < of.Count; ++i)
  {
    sum += cells.Mesh.Point(cell.Points[static_cast<std::size_t>(of.Corners[i])]);
  }
  sum = glm::round(sum * 1e6 / double(of.Count));
  return { sum.x, sum.y, sum.z };
}

Place PlaceOf(const glm::dvec3& point)
{
  return { point.x, point.y, point.z };
}

struct Whole
{
  explicit Whole(const OwnedCellMesh& mesh)
    : Pool(1)
    , Cells(DrawnCells::Of(mesh.View(), this->Facts, this->Pool))
  {
  }
  CellFacts Facts;
  ThreadPool Pool;
  std::shared_ptr<const DrawnCells> Cells;
};

/// Calls function(rank, piece, mesh of the piece, pool, communicator), one rank after the other in
/// what is locked.
template <class Function>
void OnPieces(
  const OwnedCellMesh& mesh, Deal deal, int ranks, bool ofCells, const Function& function)
{
  const std::vector<int> rankOf = piececases::Dealt(mesh, deal, ranks);
  RunOnSimulatedRanks(ranks,
    [&](Communicator& communicator)
    {
      ThreadPool pool(1);
      CellFacts facts;
      const OwnedCellMesh piece = piececases::PieceOf(mesh, rankOf, communicator.Rank(), ofCells);
      const auto cells = DrawnPiece(communicator, piece.View(), facts, pool);
      function(communicator, *cells, piece, pool);
    });
}

TEST(CellPieces, IndexSpaceAndBorderAreThoseOfTheWhole)
{
  for (const Cut cut : { Cut::Hexahedra, Cut::Mixed })
  {
    const OwnedCellMesh mesh = piececases::Cube(5, cut);
    const Whole whole(mesh);
    std::set<Place> want;
    for (const BorderFace& face : whole.Cells->Border)
    {
      want.insert(MiddleOfFace(*whole.Cells, face));
    }
    EXPECT_EQ(want.size(), whole.Cells->Border.size());
    for (const Deal deal : { Deal::OneByOne, Deal::Jagged, Deal::Slabs })
    {
      std::mutex mutex;
      std::multiset<Place> found;
      std::size_t alone = 0;
      OnPieces(mesh, deal, 5, false,
        [&](Communicator&, const DrawnCells& cells, const OwnedCellMesh&, ThreadPool&)
        {
          const std::lock_guard<std::mutex> lock(mutex);
          EXPECT_EQ(cells.Lattice.Origin, whole.Cells->Lattice.Origin);
          EXPECT_EQ(cells.Lattice.Edge, whole.Cells->Lattice.Edge);
          EXPECT_EQ(cells.Lattice.Size, whole.Cells->Lattice.Size);
          for (const BorderFace& face : cells.Border)
          {
            found.insert(MiddleOfFace(cells, face));
            EXPECT_TRUE((cells.Alone[face.Cell] >> face.Face & 1) != 0);
          }
          for (const std::uint8_t faces : cells.Alone)
          {
            alone += static_cast<std::size_t>(__builtin_popcount(faces));
          }
        });
      EXPECT_EQ(std::multiset<Place>(want.begin(), want.end()), found);
      // Each face between two pieces is in both.
      EXPECT_GT(alone, found.size());
      EXPECT_EQ((alone - found.size()) % 2, 0u);
    }
  }
}

TEST(CellPieces, NoCellOnAnyRankIsAnErrorOnAll)
{
  OwnedCellMesh none;
  none.Offsets = { 0 };
  int errors = 0;
  std::mutex mutex;
  RunOnSimulatedRanks(3,
    [&](Communicator& communicator)
    {
      ThreadPool pool(1);
      CellFacts facts;
      try
      {
        DrawnPiece(communicator, none.View(), facts, pool);
      }
      catch (const CollectiveError&)
      {
        const std::lock_guard<std::mutex> lock(mutex);
        ++errors;
      }
    });
  EXPECT_EQ(errors, 3);
}

TEST(CellPieces, KeysBringCellsIntoTheirOrder)
{
  OwnedCellMesh mesh = piececases::Cube(4, Cut::FiveTetrahedra);
  const Whole whole(mesh);
  const CellKeys keys(whole.Cells->Mesh, whole.Cells->OrderedBy);
  for (std::size_t i = 1; i < whole.Cells->Order.size(); ++i)
  {
    EXPECT_TRUE(keys.Of(whole.Cells->Order[i - 1]) < keys.Of(whole.Cells->Order[i]));
  }
}

/// @param numbers of each point, `width` of them
void ExpectAsInWhole(const std::vector<float>& numbers, const OwnedCellMesh& piece,
  const std::map<Place, std::vector<float>>& want, std::size_t width)
{
  const CellMesh view = piece.View();
  ASSERT_EQ(numbers.size(), width * static_cast<std::size_t>(view.PointCount));
  for (std::int64_t point = 0; point < view.PointCount; ++point)
  {
    const std::vector<float>& at = want.at(PlaceOf(view.Point(point)));
    for (std::size_t i = 0; i < width; ++i)
    {
      const float is = numbers[width * static_cast<std::size_t>(point) + i];
      ASSERT_NEAR(is, at[i], 2e-7 * std::max(1.0f, std::abs(at[i])));
    }
  }
}

std::map<Place, std::vector<float>> ByPlace(
  const OwnedCellMesh& mesh, const std::vector<float>& numbers, std::size_t width)
{
  const CellMesh view = mesh.View();
  std::map<Place, std::vector<float>> by;
  for (std::size_t point = 0; point < static_cast<std::size_t>(view.PointCount); ++point)
  {
    const auto from = numbers.begin() + static_cast<std::ptrdiff_t>(width * point);
    by[PlaceOf(view.Point(static_cast<std::int64_t>(point)))] = { from,
      from + static_cast<std::ptrdiff_t>(width) };
  }
  return by;
}

/// @param mesh whose values are those of points
void ExpectMeansOfTheWhole(const OwnedCellMesh& mesh)
{
  const Whole whole(mesh);
  ThreadPool pool(1);
  const auto gradients = ByPlace(mesh, PointGradients(*whole.Cells, mesh.Values, pool), 3);
  OwnedCellMesh ofCells = mesh;
  ofCells.Values.clear();
  for (std::int64_t cell = 0; cell < mesh.CellCount(); ++cell)
  {
    ofCells.Values.push_back(
      static_cast<float>(scenes::Standard(piececases::MiddleOf(mesh.View(), cell))));
  }
  const auto means = ByPlace(mesh, PointMeans(*whole.Cells, ofCells.Values, pool), 1);
  for (const Deal deal : { Deal::OneByOne, Deal::Jagged, Deal::Slabs })
  {
    OnPieces(mesh, deal, 4, false,
      [&](
        Communicator& ranks, const DrawnCells& cells, const OwnedCellMesh& piece, ThreadPool& mine)
      { ExpectAsInWhole(PieceGradients(ranks, cells, piece.Values, mine), piece, gradients, 3); });
    OnPieces(ofCells, deal, 4, true,
      [&](
        Communicator& ranks, const DrawnCells& cells, const OwnedCellMesh& piece, ThreadPool& mine)
      { ExpectAsInWhole(PieceMeans(ranks, cells, piece.Values, mine), piece, means, 1); });
  }
}

TEST(CellPieces, GradientsAndMeansAreThoseOfTheWhole)
{
  OwnedCellMesh mesh = piececases::Cube(5, Cut::Mixed);
  ExpectMeansOfTheWhole(mesh);
  // Points that are cells' own count as one where they meet, inside of a piece, too.
  cellmeshes::SeparatePoints(mesh);
  ExpectMeansOfTheWhole(mesh);
}

TEST(CellPieces, OfRepeatedCellsThoseOfTheHighestRankCount)
{
  const OwnedCellMesh once = piececases::Cube(5, Cut::Mixed);
  OwnedCellMesh mesh = once;
  cellmeshes::Append(mesh, once);
  cellmeshes::Append(mesh, once);
  const Whole whole(mesh);
  ASSERT_EQ(whole.Cells->Order.size(), static_cast<std::size_t>(once.CellCount()));
  for (const int ranks : { 1, 2, 3, 4, 7 })
  {
    std::mutex mutex;
    std::size_t drawn = 0;
    std::size_t border = 0;
    std::int64_t repeated = 0;
    const std::vector<int> rankOf = piececases::Dealt(mesh, Deal::Slabs, ranks);
    RunOnSimulatedRanks(ranks,
      [&](Communicator& communicator)
      {
        ThreadPool pool(1);
        CellFacts facts;
        const int rank = communicator.Rank();
        const OwnedCellMesh piece = piececases::PieceOf(mesh, rankOf, rank, false);
        const auto cells = DrawnPiece(communicator, piece.View(), facts, pool);
        const std::lock_guard<std::mutex> lock(mutex);
        drawn += cells->Order.size();
        border += cells->Border.size();
        repeated += facts.Repeated;
        const auto first =
          static_cast<std::int64_t>(std::find(rankOf.begin(), rankOf.end(), rank) - rankOf.begin());
        for (const std::uint32_t number : cells->Order)
        {
          EXPECT_GE(first + number, 2 * once.CellCount());
        }
      });
    EXPECT_EQ(drawn, whole.Cells->Order.size()) << ranks;
    EXPECT_EQ(border, whole.Cells->Border.size()) << ranks;
    EXPECT_EQ(repeated, 2 * once.CellCount()) << ranks;
  }
}

} // namespace
