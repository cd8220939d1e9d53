// SPDX-License-Identifier: BSD-3-Clause
#include "MeshSteps.h"

#include "CellArrays.h"
#include "CellsOfGrid.h"
#include "GhostCells.h"
#include "HexMeshOfGrid.h"
#include "LeafSteps.h"
#include "MeshPieces.h"
#include "MeshPlanTexts.h"
#include "PieceValues.h"
#include "RankMessages.h"
#include "RestPoints.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Mesh/CellSeries/CellsFile.h"
#include "Mesh/Series/AtlasValues.h"
#include "Mesh/Series/MeshFile.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"

#include <cstring>
#include <vector>

namespace banyan
{
namespace
{

/// Says what changed between the meshes of two steps, or nothing.
/// @param move whether points may be others
std::string ChangeOf(vtkUnstructuredGrid* before, vtkUnstructuredGrid* now,
  const std::string& displacements, bool move)
{
  std::string change = ChangeOfCells(before, now);
  if (change.empty() && TypeOfPoints(before) != TypeOfPoints(now))
  {
    return "points are of another type";
  }
  return !change.empty() || move ? change : HowPointsMoved(before, now, displacements);
}

std::string KindOf(const std::string& cellArray)
{
  return cellArray.empty() ? "a point array" : "the cell array " + cellArray;
}

/// What ranks have of a step. Plain memory: it is sent as it is.
struct Parts
{
  std::uint8_t Failed = 0;        ///< some have a problem
  std::uint8_t Mesh = 0;          ///< some have a mesh
  std::uint8_t CellsOfOthers = 0; ///< ranks but the first one have cells
};

/// Collective.
Parts PartsOfRanks(Communicator& ranks, const Parts& mine)
{
  std::vector<Parts> all(static_cast<std::size_t>(ranks.Size()));
  ranks.AllGather(&mine, sizeof(mine), all.data());
  Parts some;
  for (const Parts& theirs : all)
  {
    some.Failed |= theirs.Failed;
    some.Mesh |= theirs.Mesh;
    some.CellsOfOthers |= theirs.CellsOfOthers;
  }
  return some;
}

Hash128 HashOfPoints(const Bytes& points)
{
  return HashOf(points.data(), points.size());
}

constexpr const char* NoMemoryForMesh = "There is not enough memory for the mesh and its values.";

} // namespace

void MeshSteps::Take(vtkSmartPointer<vtkDataObject>& data, const std::string& problem)
{
  LeavesAsGrid(this->Ranks, problem, data, this->Leaves);
  std::vector<vtkUnstructuredGrid*> grids;
  Parts mine;
  Collective(this->Ranks,
    [&]
    {
      mine.Failed = problem.empty() ? 0 : 1;
      mine.Mesh = problem.empty() && CollectGrids(data, grids) ? 1 : 0;
      mine.CellsOfOthers = this->Ranks.Rank() > 0 && !grids.empty() ? 1 : 0;
    });
  const Parts parts = PartsOfRanks(this->Ranks, mine);
  if (parts.Failed || !parts.Mesh)
  {
    return;
  }
  this->Found = true;
  vtkSmartPointer<vtkUnstructuredGrid> piece;
  const auto merge = [&]
  {
    if (!mine.Mesh && data && data->GetNumberOfElements(vtkDataObject::CELL) > 0)
    {
      throw Error(
        std::string("Other ranks have a mesh of cells (vtkUnstructuredGrid), and this one "
                    "has ") +
        data->GetClassName());
    }
    this->LookAt(grids);
    piece = this->Merged(grids);
  };
  Collective(this->Ranks, merge, NoMemoryForMesh);
  std::vector<vtkSmartPointer<vtkDataObject>> all;
  if (parts.CellsOfOthers)
  {
    all = GatherData(this->Ranks, piece);
  }
  vtkSmartPointer<vtkImageData> image = vtkSmartPointer<vtkImageData>::New();
  const auto makeImage = [&]
  {
    piece = this->MergedOfRanks(piece, all);
    this->Remember(piece);
    image = this->ImageOf(piece);
  };
  CollectiveOn(0, this->Ranks, makeImage, NoMemoryForMesh);
  data = image;
}

/// This rank's part as one mesh, its points at rest.
vtkSmartPointer<vtkUnstructuredGrid> MeshSteps::Merged(std::vector<vtkUnstructuredGrid*> grids)
{
  std::vector<vtkSmartPointer<vtkUnstructuredGrid>> rest;
  for (vtkUnstructuredGrid*& grid : grids)
  {
    rest.push_back(AtRest(grid, this->Leaves ? "" : this->Displacements));
    grid = rest.back();
  }
  return MergePieces(grids, this->Arrays.WantedPoints(this->Leaves));
}

/// Notes what is not written of this rank's part.
void MeshSteps::LookAt(const std::vector<vtkUnstructuredGrid*>& grids)
{
  this->OthersThere.clear();
  bool hidden = false;
  for (vtkUnstructuredGrid* grid : grids)
  {
    const std::vector<std::string> names = this->Arrays.NotChosen(grid, this->Leaves);
    this->OthersThere.insert(this->OthersThere.end(), names.begin(), names.end());
    hidden = hidden || HasGhosts(grid->GetCellGhostArray(), vtkDataSetAttributes::HIDDENCELL) ||
             HasGhosts(grid->GetPointGhostArray(), vtkDataSetAttributes::HIDDENPOINT);
  }
  this->HiddenParts =
    hidden ? "Hidden cells of the mesh are not written, and hidden points like all others. " : "";
}

/// The one mesh of all ranks, from their pieces; without any of others, from this rank's own.
vtkSmartPointer<vtkUnstructuredGrid> MeshSteps::MergedOfRanks(
  vtkUnstructuredGrid* mine, const std::vector<vtkSmartPointer<vtkDataObject>>& all) const
{
  std::vector<vtkUnstructuredGrid*> pieces;
  for (const auto& one : all)
  {
    vtkUnstructuredGrid* const grid = vtkUnstructuredGrid::SafeDownCast(one);
    if (grid && grid->GetNumberOfCells() > 0)
    {
      pieces.push_back(grid);
    }
  }
  if (pieces.empty())
  {
    pieces.push_back(mine);
  }
  return MergePieces(pieces, this->Arrays.WantedPoints(this->Leaves));
}

void MeshSteps::Remember(vtkUnstructuredGrid* grid)
{
  if (this->First)
  {
    const bool move = this->Cells && this->Displacements.empty();
    const std::string change = ChangeOf(this->First, grid, this->Displacements, move);
    if (!change.empty())
    {
      throw Error("The mesh of a series must not change, and " + change + ".");
    }
    this->Now = move ? grid : nullptr;
    if (this->Tree)
    {
      MakeNodal(*this->Tree, grid, this->Arrays.WantedPoints(this->Leaves));
    }
    return;
  }
  ThreadPool pool(ThreadPool::DefaultWidth());
  std::shared_ptr<const ElementOctree> tree;
  try
  {
    tree = ElementOctree::Find(HexMeshOf(grid), pool);
  }
  catch (const Error&)
  {
    if (this->Leaves || grid->GetNumberOfCells() == 0)
    {
      throw;
    }
  }
  if (tree)
  {
    this->Mesh = StoreMesh(*tree, PlainCellTypesOf(grid)->GetPointer(0));
  }
  else
  {
    this->Cells = this->CellsOf(grid);
  }
  this->First = vtkSmartPointer<vtkUnstructuredGrid>::New();
  this->First->CopyStructure(grid);
  if (this->Leaves)
  {
    this->Tree = tree;
    MakeNodal(*tree, grid, this->Arrays.WantedPoints(this->Leaves));
  }
}

/// A mesh that is no octree, with an image for the values that are there.
std::shared_ptr<const StoredCells> MeshSteps::CellsOf(vtkUnstructuredGrid* grid) const
{
  StoredCells cells = CellsOfGrid(grid); // what is wrong with the mesh is said first
  std::string warning;
  StoredValues values{ false, false };
  const bool absolute = this->Options.Mode == ErrorBoundMode::Absolute;
  for (const MeshArray& array : this->Arrays.Of(grid, false, warning))
  {
    const bool atPoints = array.CellArray.empty();
    (atPoints ? values.AtPoints : values.InCells) = true;
    (atPoints ? values.PointArrays : values.CellArrays)
      .push_back({ TypeOf(array.Values), array.Values->GetVoidPointer(0),
        array.Values->GetNumberOfComponents(), this->Options.ErrorBound, absolute });
  }
  return StoreCells(std::move(cells), values);
}

std::optional<PointsFile> MeshSteps::WriteMoved(int step, SegmentFolder& folder)
{
  if (!this->Cells || !this->Now)
  {
    return std::nullopt;
  }
  const Bytes points = PointsOfGrid(this->Now, this->Cells->PointType);
  const Hash128 hash = HashOfPoints(points);
  if (hash == this->LastPoints)
  {
    return std::nullopt;
  }
  this->LastPoints = hash;
  return WriteMovedPoints(*this->Cells, points.data(), step, folder);
}

vtkSmartPointer<vtkImageData> MeshSteps::ImageOf(vtkUnstructuredGrid* grid)
{
  const auto values = [this](MeshValues where)
  { return this->Cells ? AtlasValues(this->Cells, where) : AtlasValues(this->Mesh, where); };
  const AtlasValues atPoints = values(MeshValues::OfPoints);
  const AtlasValues ofCells = values(MeshValues::OfCells);
  auto image = vtkSmartPointer<vtkImageData>::New();
  const glm::ivec3 size = this->Cells ? this->Cells->Samples() : this->Mesh->Atlas->Samples();
  image->SetDimensions(size.x, size.y, size.z);
  ThreadPool pool(ThreadPool::DefaultWidth());
  this->LeftOut.clear();
  this->CellArrays.clear();
  for (const MeshArray& array : this->Arrays.Of(grid, this->Leaves, this->LeftOut))
  {
    const std::string& before = this->Kinds.emplace(array.Name, array.CellArray).first->second;
    if (before != array.CellArray)
    {
      throw Error("The array " + array.Name + " of the series was " + KindOf(before) +
                  " before, and is " + KindOf(array.CellArray) + ".");
    }
    const auto samples = vtkSmartPointer<vtkDataArray>::Take(
      vtkDataArray::CreateDataArray(array.Values->GetDataType()));
    samples->SetName(array.Name.c_str());
    samples->SetNumberOfComponents(array.Values->GetNumberOfComponents());
    samples->CopyComponentNames(array.Values);
    samples->SetNumberOfTuples(image->GetNumberOfPoints());
    const bool cells = !array.CellArray.empty();
    (cells ? ofCells : atPoints)
      .ToImage(TypeOf(array.Values), array.Values->GetVoidPointer(0),
        array.Values->GetNumberOfComponents(), this->Options.QuantizerFor(array.Name).FillValues,
        samples->GetVoidPointer(0), pool);
    image->GetPointData()->AddArray(samples);
    if (array.Values == grid->GetPointData()->GetScalars())
    {
      image->GetPointData()->SetActiveScalars(array.Name.c_str());
    }
    if (cells)
    {
      this->CellArrays[array.Name] = array.CellArray;
    }
  }
  return image;
}

std::shared_ptr<const MeshPlan> MeshSteps::Write(SegmentFolder* folder)
{
  std::shared_ptr<const MeshPlan> plan;
  std::vector<std::string> texts;
  const auto write = [&]
  {
    const std::shared_ptr<MeshPlan> made =
      this->Cells ? WriteCells(*this->Cells, *folder) : WriteMesh(*this->Mesh, *folder);
    this->LastPoints = this->Cells ? HashOfPoints(this->Cells->Points) : Hash128{};
    made->CellArrays = this->CellArrays;
    plan = made;
    texts = this->Ranks.Size() > 1 ? TextsOf(*plan) : texts;
  };
  CollectiveOn(0, this->Ranks, write, NoMemoryForMesh);
  texts = BroadcastStrings(this->Ranks, std::move(texts));
  const auto read = [&] { plan = plan ? plan : PlanFrom(texts); };
  Collective(this->Ranks, read, NoMemoryForMesh);
  return plan;
}

} // namespace banyan
