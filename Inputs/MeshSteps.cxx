// SPDX-License-Identifier: BSD-3-Clause
#include "MeshSteps.h"

#include "GhostCells.h"
#include "HexMeshOfGrid.h"
#include "LeafSteps.h"
#include "MeshPieces.h"
#include "PieceValues.h"
#include "RestPoints.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkMultiProcessController.h"
#include "vtkMultiProcessStream.h"
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
      !SameValues(before->GetCellTypesArray(), now->GetCellTypesArray()))
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

/// What the ranks have of a step.
struct PartsOfRanks
{
  bool Failed = false;        ///< some have a problem
  bool Mesh = false;          ///< some have a mesh
  bool CellsOfOthers = false; ///< ranks but the first one have cells
};

/// Collective.
/// @param failed, mesh, cells what this rank has
PartsOfRanks PartsOf(const RankTalk& talk, bool failed, bool mesh, bool cells)
{
  vtkMultiProcessStream stream;
  stream << static_cast<int>(failed) << static_cast<int>(mesh) << static_cast<int>(cells);
  PartsOfRanks parts;
  int rank = 0;
  for (vtkMultiProcessStream& theirs : talk.Exchange(stream))
  {
    int theirProblem = 0, theirMesh = 0, theirCells = 0;
    theirs >> theirProblem >> theirMesh >> theirCells;
    parts.Failed = parts.Failed || theirProblem != 0;
    parts.Mesh = parts.Mesh || theirMesh != 0;
    parts.CellsOfOthers = parts.CellsOfOthers || (rank++ > 0 && theirCells != 0);
  }
  return parts;
}

} // namespace

std::string MeshSteps::Take(vtkSmartPointer<vtkDataObject>& data, const std::string& problem)
{
  const std::string noLeaves = LeavesAsGrid(this->Talk, problem, data, this->Leaves);
  if (!noLeaves.empty())
  {
    this->Found = true;
    data = vtkSmartPointer<vtkImageData>::New();
    return noLeaves;
  }
  std::vector<vtkUnstructuredGrid*> grids;
  const bool mine = problem.empty() && CollectGrids(data, grids);
  const PartsOfRanks parts = PartsOf(this->Talk, !problem.empty(), mine, !grids.empty());
  if (parts.Failed || !parts.Mesh)
  {
    return problem;
  }
  this->Found = true;
  std::string mistake;
  vtkSmartPointer<vtkUnstructuredGrid> piece = vtkSmartPointer<vtkUnstructuredGrid>::New();
  try
  {
    if (!mine && data && data->GetNumberOfElements(vtkDataObject::CELL) > 0)
    {
      throw Error(std::string("Other ranks have a mesh of hexahedra, and this one has ") +
                  data->GetClassName() + " with other cells");
    }
    this->LookAt(grids);
    piece = this->Merged(grids);
  }
  catch (const std::exception& error)
  {
    mistake = error.what();
  }
  vtkSmartPointer<vtkImageData> image = vtkSmartPointer<vtkImageData>::New();
  mistake = this->FirstMistake(mistake);
  if (!mistake.empty())
  {
    data = image;
    return mistake;
  }
  try
  {
    this->Gather(piece, parts.CellsOfOthers);
    if (this->Talk.Rank() == 0)
    {
      this->Remember(piece);
      image = this->ImageOf(piece);
    }
  }
  catch (const std::bad_alloc&)
  {
    mistake = "There is not enough memory for the mesh and its values.";
  }
  catch (const std::exception& error)
  {
    mistake = error.what();
  }
  data = image;
  return mistake;
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

/// Collective: what all ranks then give as the reason, so that nobody goes on with a part of the
/// mesh.
std::string MeshSteps::FirstMistake(const std::string& mine) const
{
  vtkMultiProcessStream stream;
  stream << mine;
  for (vtkMultiProcessStream& theirs : this->Talk.Exchange(stream))
  {
    std::string mistake;
    theirs >> mistake;
    if (!mistake.empty())
    {
      return mistake;
    }
  }
  return {};
}

/// Brings the pieces of all ranks to rank 0, if others have any.
void MeshSteps::Gather(vtkSmartPointer<vtkUnstructuredGrid>& piece, bool others)
{
  std::vector<vtkSmartPointer<vtkDataObject>> all;
  if (others)
  {
    this->Controller->Gather(piece, all, 0);
  }
  if (this->Talk.Rank() > 0)
  {
    return;
  }
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
    pieces.push_back(piece);
  }
  piece = MergePieces(pieces, this->Arrays.WantedPoints(this->Leaves));
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
  this->Mesh = StoreMesh(*tree, grid->GetCellTypesArray()->GetPointer(0));
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
  this->Talk.OnRank(0,
    [&]
    {
      const std::shared_ptr<MeshPlan> made = WriteMesh(*this->Mesh, *folder);
      made->CellArrays = this->CellArrays;
      plan = made;
    });
  if (this->Talk.Ranks() == 1)
  {
    return plan;
  }
  const std::vector<std::string> texts =
    this->Talk.FromRankZero(plan ? TextsOf(*plan) : std::vector<std::string>());
  this->Talk.Together(
    [&]
    {
      if (!plan)
      {
        plan = PlanFrom(texts);
      }
    });
  return plan;
}

} // namespace banyan
