#include "MeshSteps.h"

#include "HexMeshOfGrid.h"
#include "LeafSteps.h"
#include "MeshPieces.h"
#include "PieceValues.h"
#include "StepReport.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataArraySelection.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkMultiProcessController.h"
#include "vtkMultiProcessStream.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "MeshSeries/AtlasValues.h"
#include "MeshSeries/MeshFile.h"
#include "Series/Varint.h"
#include "Series/Zstd.h"

#include <algorithm>
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

/// What changed between the meshes of two steps, or nothing.
std::string ChangeOf(vtkUnstructuredGrid* before, vtkUnstructuredGrid* now)
{
  if (before->GetNumberOfCells() != now->GetNumberOfCells() ||
      before->GetNumberOfPoints() != now->GetNumberOfPoints())
  {
    return "it had " + std::to_string(before->GetNumberOfCells()) + " cells and " +
           std::to_string(before->GetNumberOfPoints()) + " points, and has " +
           std::to_string(now->GetNumberOfCells()) + " and " +
           std::to_string(now->GetNumberOfPoints());
  }
  if (!SameValues(before->GetPoints()->GetData(), now->GetPoints()->GetData()))
  {
    return "points have moved (if they carry displacements, read the mesh without applying them)";
  }
  if (!SameValues(
        before->GetCells()->GetConnectivityArray(), now->GetCells()->GetConnectivityArray()) ||
      !SameValues(before->GetCellTypesArray(), now->GetCellTypesArray()))
  {
    return "cells have other points or types";
  }
  return {};
}

/// What is not a value of the simulation.
bool IsNoValue(vtkPointData* points, vtkDataArray* array)
{
  return array == points->GetGlobalIds() || array == points->GetPedigreeIds() ||
         (array->GetName() &&
           std::strcmp(array->GetName(), vtkDataSetAttributes::GhostArrayName()) == 0);
}

/// Names of arrays for messages: the image has no values for them.
void NameOthers(vtkUnstructuredGrid* grid, vtkImageData* image)
{
  vtkPointData* const points = grid->GetPointData();
  for (int i = 0; i < points->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* const array = points->GetArray(i);
    if (array && array->GetName() && IsNoValue(points, array))
    {
      vtkNew<vtkIntArray> empty;
      empty->SetName(LeftOutName(array->GetName()).c_str());
      image->GetFieldData()->AddArray(empty);
    }
  }
  vtkCellData* const cells = grid->GetCellData();
  for (int i = 0; i < cells->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* const array = cells->GetAbstractArray(i);
    if (array->GetName() && array != cells->GetGlobalIds() && array != cells->GetPedigreeIds() &&
        std::strcmp(array->GetName(), vtkDataSetAttributes::GhostArrayName()) != 0)
    {
      vtkNew<vtkIntArray> empty;
      empty->SetName(array->GetName());
      image->GetCellData()->AddArray(empty);
    }
  }
}

} // namespace

std::string MeshSteps::Take(vtkSmartPointer<vtkDataObject>& data, const std::string& problem)
{
  bool leaves = false;
  const std::string noLeaves = LeavesAsGrid(this->Talk, problem, data, leaves);
  if (!noLeaves.empty())
  {
    this->Found = true;
    data = vtkSmartPointer<vtkImageData>::New();
    return noLeaves;
  }
  std::vector<vtkUnstructuredGrid*> grids;
  const bool mine = problem.empty() && CollectGrids(data, grids);
  vtkMultiProcessStream stream;
  stream << static_cast<int>(!problem.empty()) << static_cast<int>(mine)
         << static_cast<int>(!grids.empty());
  bool failed = false;
  bool mesh = false;
  bool others = false; // ranks but the first one have cells
  int rank = 0;
  for (vtkMultiProcessStream& theirs : this->Talk.Exchange(stream))
  {
    int theirProblem = 0, theirMesh = 0, theirCells = 0;
    theirs >> theirProblem >> theirMesh >> theirCells;
    failed = failed || theirProblem != 0;
    mesh = mesh || theirMesh != 0;
    others = others || (rank++ > 0 && theirCells != 0);
  }
  if (failed || !mesh)
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
    piece = MergePieces(grids, this->Wanted());
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
    this->Gather(piece, others);
    if (this->Talk.Rank() == 0)
    {
      this->Remember(piece, leaves);
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

/// The arrays that are to be written.
WantedArrays MeshSteps::Wanted() const
{
  return [this](const std::string& name)
  {
    return this->Selection->GetNumberOfArrays() == 0 ||
           this->Selection->ArrayIsEnabled(name.c_str()) != 0;
  };
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
  piece = MergePieces(pieces, this->Wanted());
}

void MeshSteps::Remember(vtkUnstructuredGrid* grid, bool leaves)
{
  if (this->Mesh)
  {
    const std::string change = ChangeOf(this->First, grid);
    if (!change.empty())
    {
      throw Error("The mesh of a series must not change, and " + change + ".");
    }
    if (leaves && this->Tree)
    {
      MakeNodal(*this->Tree, grid, this->Wanted());
    }
    return;
  }
  const HexMesh cells = HexMeshOf(grid);
  ThreadPool pool(ThreadPool::DefaultWidth());
  const std::shared_ptr<const ElementOctree> tree = ElementOctree::Find(cells, pool);
  this->Mesh = StoreMesh(*tree, grid->GetCellTypesArray()->GetPointer(0));
  this->First = vtkSmartPointer<vtkUnstructuredGrid>::New();
  this->First->CopyStructure(grid);
  if (leaves)
  {
    this->Tree = tree;
    MakeNodal(*tree, grid, this->Wanted());
  }
}

vtkSmartPointer<vtkImageData> MeshSteps::ImageOf(vtkUnstructuredGrid* grid) const
{
  const AtlasValues values(this->Mesh);
  const auto image = vtkSmartPointer<vtkImageData>::New();
  const glm::ivec3 size = this->Mesh->Atlas->Samples();
  image->SetDimensions(size.x, size.y, size.z);
  ThreadPool pool(ThreadPool::DefaultWidth());
  vtkPointData* const points = grid->GetPointData();
  for (int i = 0; i < points->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* const array = points->GetArray(i);
    if (!array || array->GetDataType() == VTK_BIT || IsNoValue(points, array))
    {
      continue;
    }
    const std::string name =
      array->GetName() && *array->GetName() ? array->GetName() : "Unnamed" + std::to_string(i);
    if (this->Selection->GetNumberOfArrays() > 0 && !this->Selection->ArrayIsEnabled(name.c_str()))
    {
      continue;
    }
    const auto samples =
      vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(array->GetDataType()));
    samples->SetName(name.c_str());
    samples->SetNumberOfComponents(array->GetNumberOfComponents());
    samples->CopyComponentNames(array);
    samples->SetNumberOfTuples(image->GetNumberOfPoints());
    values.ToImage(TypeOf(array), array->GetVoidPointer(0), array->GetNumberOfComponents(),
      this->Options.QuantizerFor(name).FillValues, samples->GetVoidPointer(0), pool);
    image->GetPointData()->AddArray(samples);
    if (array == points->GetScalars())
    {
      image->GetPointData()->SetActiveScalars(name.c_str());
    }
  }
  NameOthers(grid, image);
  return image;
}

std::shared_ptr<const MeshPlan> MeshSteps::Write(SegmentFolder* folder) const
{
  std::shared_ptr<const MeshPlan> plan;
  this->Talk.OnRank(0, [&] { plan = WriteMesh(*this->Mesh, *folder); });
  if (this->Talk.Ranks() == 1)
  {
    return plan;
  }
  Bytes numbers, needed;
  std::string file;
  if (plan)
  {
    const MeshIndex& index = plan->Index;
    for (const std::uint64_t number :
      { index.Bytes, index.HashLow, index.HashHigh, static_cast<std::uint64_t>(index.Points),
        static_cast<std::uint64_t>(index.Cells), std::uint64_t{ plan->Needed->size() } })
    {
      PutVarint(numbers, number);
    }
    AppendCompressed(plan->Needed->data(), plan->Needed->size(), 1, needed);
    file = index.File;
  }
  const std::vector<std::string> told = this->Talk.FromRankZero({ file,
    std::string(numbers.begin(), numbers.end()), std::string(needed.begin(), needed.end()) });
  this->Talk.Together(
    [&]
    {
      if (plan)
      {
        return;
      }
      auto theirs = std::make_shared<MeshPlan>();
      const auto* bytes = reinterpret_cast<const std::uint8_t*>(told[1].data());
      ByteReader reader(bytes, told[1].size());
      theirs->Index.File = told[0];
      theirs->Index.Bytes = reader.Varint();
      theirs->Index.HashLow = reader.Varint();
      theirs->Index.HashHigh = reader.Varint();
      theirs->Index.Points = static_cast<std::int64_t>(reader.Varint());
      theirs->Index.Cells = static_cast<std::int64_t>(reader.Varint());
      auto mask = std::make_shared<std::vector<std::uint8_t>>(reader.Varint());
      Decompress(reinterpret_cast<const std::uint8_t*>(told[2].data()), told[2].size(),
        mask->data(), mask->size());
      theirs->Needed = std::move(mask);
      plan = std::move(theirs);
    });
  return plan;
}

} // namespace banyan
