// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Parallel_PieceCases_h
#define banyan_Testing_Core_Parallel_PieceCases_h

#include "Base/Morton.h"
#include "Base/ThreadPool.h"
#include "Cells/DrawnMesh.h"
#include "Parallel/Cells/CellPieces.h"
#include "Parallel/Cells/DrawPieces.h"
#include "Parallel/Communicate/Communicator.h"
#include "Render/Raycast/InterpolateSkippedPixels.h"

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

/// Meshes of cells that are dealt to ranks, against pictures of one rank.
namespace piececases
{

using cellmeshes::OwnedCellMesh;

enum class Deal
{
  OneByOne, ///< each cell to any rank
  Jagged,   ///< around points, by distances that differ from cell to cell
  Morton,   ///< runs of the order of cells
  Slabs     ///< runs in the order of the file
};

inline glm::dvec3 MiddleOf(const banyan::CellMesh& mesh, std::int64_t number)
{
  const banyan::MeshCell cell = mesh.Cell(number);
  const int corners = banyan::CornersOf(cell.Shape);
  glm::dvec3 middle(0.0);
  for (int i = 0; i < corners; ++i)
  {
    middle += mesh.Point(cell.Points[static_cast<std::size_t>(i)]) / double(corners);
  }
  return middle;
}

/// The rank of each cell.
inline std::vector<int> Dealt(const OwnedCellMesh& mesh, Deal deal, int ranks)
{
  const banyan::CellMesh view = mesh.View();
  const auto count = static_cast<std::size_t>(view.CellCount);
  std::vector<int> rankOf(count);
  cellmeshes::Numbers numbers(7);
  const auto random = [&] { return numbers.Between(0.0, 1.0); };
  std::vector<glm::dvec3> seeds;
  for (int rank = 0; rank < ranks; ++rank)
  {
    const double x = random();
    const double y = random();
    seeds.emplace_back(x, y, random());
  }
  std::vector<std::uint32_t> order = cellmeshes::GeometricOrder(view);
  for (std::size_t i = 0; i < count; ++i)
  {
    const auto run = static_cast<int>(i * static_cast<std::size_t>(ranks) / count);
    if (deal == Deal::Morton)
    {
      rankOf[order[i]] = run;
    }
    else if (deal == Deal::Slabs)
    {
      rankOf[i] = run;
    }
    else if (deal == Deal::OneByOne)
    {
      rankOf[i] = static_cast<int>(numbers.Below(static_cast<std::uint64_t>(ranks)));
    }
    else
    {
      const glm::dvec3 jump(random() - 0.5, random() - 0.5, random() - 0.5);
      const glm::dvec3 at = MiddleOf(view, static_cast<std::int64_t>(i)) + 0.1 * jump;
      const auto nearest = std::min_element(seeds.begin(), seeds.end(),
        [&](const glm::dvec3& a, const glm::dvec3& b)
        { return glm::distance(a, at) < glm::distance(b, at); });
      rankOf[i] = static_cast<int>(nearest - seeds.begin());
    }
  }
  return rankOf;
}

/// The cells of one rank, with the points that they have. Values of cells come with them.
inline OwnedCellMesh PieceOf(
  const OwnedCellMesh& mesh, const std::vector<int>& rankOf, int rank, bool ofCells)
{
  OwnedCellMesh piece;
  piece.Offsets = { 0 };
  std::map<std::int64_t, std::int64_t> numbers;
  for (std::size_t cell = 0; cell < rankOf.size(); ++cell)
  {
    if (rankOf[cell] != rank)
    {
      continue;
    }
    for (std::int64_t i = mesh.Offsets[cell]; i < mesh.Offsets[cell + 1]; ++i)
    {
      const std::int64_t point = mesh.Ids[static_cast<std::size_t>(i)];
      const auto [at, isNew] = numbers.emplace(point, static_cast<std::int64_t>(numbers.size()));
      if (isNew)
      {
        for (std::int64_t axis = 0; axis < 3; ++axis)
        {
          piece.Points.push_back(mesh.Points[static_cast<std::size_t>(3 * point + axis)]);
        }
        if (!ofCells)
        {
          piece.Values.push_back(mesh.Values[static_cast<std::size_t>(point)]);
        }
      }
      piece.Ids.push_back(at->second);
    }
    piece.Offsets.push_back(static_cast<std::int64_t>(piece.Ids.size()));
    piece.Types.push_back(mesh.Types[cell]);
    if (ofCells)
    {
      piece.Values.push_back(mesh.Values[cell]);
    }
  }
  return piece;
}

/// A mesh, how it is shown, and its picture as one rank draws it.
struct Case
{
  explicit Case(OwnedCellMesh mesh, const glm::ivec2& picture = { 75, 70 }, double step = 0.8,
    bool parallel = false)
    : Mesh(std::move(mesh))
    , Scene(SceneFor(this->Mesh, picture, step, parallel))
  {
  }

  static banyan::RayScene SceneFor(
    const OwnedCellMesh& mesh, const glm::ivec2& picture, double step, bool parallel)
  {
    banyan::ThreadPool pool(1);
    banyan::CellFacts facts;
    const banyan::CellLattice lattice = banyan::DrawnCells::Of(mesh.View(), facts, pool)->Lattice;
    const glm::dmat4 toWorld =
      glm::scale(glm::translate(glm::dmat4(1.0), lattice.Origin), glm::dvec3(lattice.Edge));
    banyan::RayScene scene = scenes::Scene(lattice.Size + 1, picture, toWorld, 1.4, parallel);
    // There is room around the mesh.
    const double edges = std::max({ lattice.Size.x, lattice.Size.y, lattice.Size.z });
    const double closer = 1.3 * edges / (edges - 16.0);
    const glm::dmat4 zoom = glm::scale(glm::dmat4(1.0), glm::dvec3(closer, closer, 1.0));
    const banyan::RayCamera camera = scene.Camera;
    scene.Camera =
      banyan::RayCamera(zoom * camera.WorldToClipMatrix(), picture, camera.AnchorPoint());
    scene.Transfer = scenes::Tabulate(cellmeshes::Dense);
    scene.Levels = banyan::LevelEdges::Finest();
    scene.SampleDistance = step * lattice.Edge;
    scene.Transfer.UnitDistance = lattice.Edge;
    scene.OpacityLimit = 2.0f; // rays never end
    return scene;
  }

  banyan::FloatImage Whole() const
  {
    banyan::ThreadPool pool(1);
    banyan::CellFacts facts;
    banyan::CellSource source({ banyan::DrawnCells::Of(this->Mesh.View(), facts, pool),
                                this->Mesh.Values, 0.0, this->OfCells, {} },
      pool);
    banyan::RayStatistics statistics;
    banyan::FloatImage picture =
      banyan::CastViewport(this->Scene, source, this->Scene.DomainCells, 1 << 30, pool, statistics);
    banyan::FinishPicture(this->Scene, picture);
    return picture;
  }

  /// Collective.
  /// @param rankOf the rank of each cell
  /// @return empty but on ranks that are Root
  banyan::FloatImage Together(banyan::Communicator& ranks, const std::vector<int>& rankOf,
    banyan::PieceStatistics& statistics) const
  {
    banyan::ThreadPool pool(1);
    const OwnedCellMesh piece = PieceOf(this->Mesh, rankOf, ranks.Rank(), this->OfCells);
    banyan::CellFacts facts;
    banyan::CellSource source({ banyan::DrawnPiece(ranks, piece.View(), facts, pool), piece.Values,
                                0.0, this->OfCells, {} },
      pool);
    banyan::FloatImage picture =
      banyan::DrawPieces(ranks, this->Scene, source, pool, this->Root, statistics);
    if (this->Root == banyan::EveryRank || ranks.Rank() == this->Root)
    {
      banyan::FinishPicture(this->Scene, picture);
    }
    return picture;
  }

  OwnedCellMesh Mesh;
  banyan::RayScene Scene;
  bool OfCells = false;
  int Root = 0;
};

/// A warped cube whose neighbours' faces match.
inline OwnedCellMesh Cube(int n, cellmeshes::Cut cut, double offset = 0.1)
{
  OwnedCellMesh mesh = cellmeshes::Cube(n, cut, { 0.03, offset, false, 1 });
  cellmeshes::SetValues(mesh, scenes::Standard);
  return mesh;
}

} // namespace piececases

#endif
