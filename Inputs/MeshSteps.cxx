// SPDX-License-Identifier: BSD-3-Clause
#include "MeshSteps.h"

#include "CellArrays.h"
#include "GhostCells.h"
#include "HexMeshOfGrid.h"
#include "LeafSteps.h"
#include "MeshPieces.h"
#include "PieceValues.h"
#include "RankMessages.h"
#include "RestPoints.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Base/Varint.h"
#include "Mesh/Series/AtlasValues.h"
#include "Mesh/Series/MeshFile.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"
#include "Series/Format/Zstd.h"

#include <cstring>
#include <vector>

namespace banyan
{
namespace
{

bool SameValues(vtkDataArray* a, vtkDataArray* b)
{
  if (a == b)
  {
    return true;
  }
  return a && b && a->GetDataType() == b->GetDataType() &&
         a->GetNumberOfValues() == b->GetNumberOfValues() &&
         std::memcmp(a->GetVoidPointer(0), b->GetVoidPointer(0),
           static_cast<std::size_t>(a->GetNumberOfValues()) * a->GetDataTypeSize()) == 0;
}

/// Says what changed between the meshes of two steps, or nothing.
std::string ChangeOf(
  vtkUnstructuredGrid* before, vtkUnstructuredGrid* now, const std::string& displacements)
{
  if (before->GetNumberOfCells() != now->GetNumberOfCells() ||
      before->GetNumberOfPoints() != now->GetNumberOfPoints())
  {
    return "it had " + std::to_string(before->GetNumberOfCells()) + " cells and " +
           std::to_string(before->GetNumberOfPoints()) + " points, and has " +
           std::to_string(now->GetNumberOfCells()) + " and " +
           std::to_string(now->GetNumberOfPoints());
  }
  const std::string moved = HowPointsMoved(before, now, displacements);
  if (!moved.empty())
  {
    return moved;
  }
  if (!SameValues(
        before->GetCells()->GetConnectivityArray(), now->GetCells()->GetConnectivityArray()) ||
      !SameValues(CellTypesOf(before), CellTypesOf(now)))
  {
    return "cells have other points or types";
  }
  return {};
}

std::string KindOf(const std::string& cellArray)
{
  return cellArray.empty() ? "a point array" : "the cell array " + cellArray;
}

std::shared_ptr<const std::vector<std::uint8_t>> Unpacked(
  const std::string& packed, std::uint64_t samples)
{
  auto mask = std::make_shared<std::vector<std::uint8_t>>(samples);
  Decompress(reinterpret_cast<const std::uint8_t*>(packed.data()), packed.size(), mask->data(),
    mask->size());
  return mask;
}

/// A plan as texts, to be sent.
std::vector<std::string> TextsOf(const MeshPlan& plan)
{
  const MeshIndex& index = plan.Index;
  Bytes numbers, needed, ofCells;
  for (const std::uint64_t number :
    { index.Bytes, index.HashLow, index.HashHigh, static_cast<std::uint64_t>(index.Points),
      static_cast<std::uint64_t>(index.Cells), std::uint64_t{ plan.Needed->size() } })
  {
    PutVarint(numbers, number);
  }
  AppendCompressed(plan.Needed->data(), plan.Needed->size(), 1, needed);
  AppendCompressed(plan.NeededOfCells->data(), plan.NeededOfCells->size(), 1, ofCells);
  std::vector<std::string> texts = { index.File };
  for (const Bytes& bytes : { numbers, needed, ofCells })
  {
    texts.emplace_back(bytes.begin(), bytes.end());
  }
  for (const auto& array : plan.CellArrays)
  {
    texts.insert(texts.end(), { array.first, array.second });
  }
  return texts;
}

/// The inverse of TextsOf.
std::shared_ptr<const MeshPlan> PlanFrom(const std::vector<std::string>& texts)
{
  auto plan = std::make_shared<MeshPlan>();
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(texts[1].data());
  ByteReader reader(bytes, texts[1].size());
  plan->Index.File = texts[0];
  plan->Index.Bytes = reader.Varint();
  plan->Index.HashLow = reader.Varint();
  plan->Index.HashHigh = reader.Varint();
  plan->Index.Points = static_cast<std::int64_t>(reader.Varint());
  plan->Index.Cells = static_cast<std::int64_t>(reader.Varint());
  const std::uint64_t samples = reader.Varint();
  plan->Needed = Unpacked(texts[2], samples);
  plan->NeededOfCells = Unpacked(texts[3], samples);
  for (std::size_t i = 4; i + 1 < texts.size(); i += 2)
  {
    plan->CellArrays[texts[i]] = texts[i + 1];
  }
  return plan;
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
      throw Error(std::string("Other ranks have a mesh of hexahedra, and this one has ") +
                  data->GetClassName() + " with other cells");
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
  if (this->Mesh)
  {
    const std::string change = ChangeOf(this->First, grid, this->Displacements);
    if (!change.empty())
    {
      throw Error("The mesh of a series must not change, and " + change + ".");
    }
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
  catch (const Error& error)
  {
    if (!CanBeSampled(grid))
    {
      throw;
    }
    std::string reason = error.what();
    reason.erase(reason.find_last_not_of('.') + 1);
    throw Error(reason +
                ". A mesh of general hexahedra can be written as the boxes that it is sampled at: "
                "see 'Sample General Meshes' of the filter 'Banyan Hex Octree'");
  }
  this->Mesh = StoreMesh(*tree, PlainCellTypesOf(grid)->GetPointer(0));
  this->First = vtkSmartPointer<vtkUnstructuredGrid>::New();
  this->First->CopyStructure(grid);
  if (this->Leaves)
  {
    this->Tree = tree;
    MakeNodal(*tree, grid, this->Arrays.WantedPoints(this->Leaves));
  }
}

vtkSmartPointer<vtkImageData> MeshSteps::ImageOf(vtkUnstructuredGrid* grid)
{
  const AtlasValues atPoints(this->Mesh);
  const AtlasValues ofCells(this->Mesh, MeshValues::OfCells);
  const auto image = vtkSmartPointer<vtkImageData>::New();
  const glm::ivec3 size = this->Mesh->Atlas->Samples();
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

std::shared_ptr<const MeshPlan> MeshSteps::Write(SegmentFolder* folder) const
{
  std::shared_ptr<const MeshPlan> plan;
  std::vector<std::string> texts;
  const auto write = [&]
  {
    const std::shared_ptr<MeshPlan> made = WriteMesh(*this->Mesh, *folder);
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
