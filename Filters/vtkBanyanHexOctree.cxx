// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBanyanHexOctree.h"

#include "ArraysOfRanks.h"
#include "CommunicatorOf.h"
#include "HexMeshOfGrid.h"
#include "LatticeOfRanks.h"
#include "LeafSteps.h"
#include "MeshArrays.h"
#include "MeshPieces.h"
#include "RankMessages.h"
#include "SampledGrid.h"
#include "SetNumber.h"

#include "Base/Interruption.h"
#include "Base/ThreadPool.h"
#include "Mesh/Octree/ElementOctree.h"
#include "Parallel/Communicate/Collective.h"

#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkErrorCode.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkSignedCharArray.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

vtkStandardNewMacro(vtkBanyanHexOctree);
banyanSetNumberMacro(vtkBanyanHexOctree, MeshTolerance, 0.0, 0.0625);
banyanSetNumberMacro(vtkBanyanHexOctree, MeshSamplingTolerance, 1.0 / 1024, 1.0);

namespace
{

/// Numbers of the grid's cells that the octree has, in the order that it counts them.
std::vector<vtkIdType> CellsWithoutGhosts(vtkUnstructuredGrid* grid)
{
  std::vector<vtkIdType> cells;
  vtkUnsignedCharArray* const ghosts = grid->GetCellGhostArray();
  constexpr int bits = vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL;
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    if (!ghosts || (ghosts->GetValue(cell) & bits) == 0)
    {
      cells.push_back(cell);
    }
  }
  return cells;
}

void AddLevels(const banyan::ElementOctree& tree, int shift, vtkUnstructuredGrid* grid)
{
  const std::vector<vtkIdType> cells = CellsWithoutGhosts(grid);
  vtkNew<vtkSignedCharArray> levels;
  levels->SetName("octree_level");
  levels->SetNumberOfTuples(grid->GetNumberOfCells());
  levels->Fill(-1);
  for (std::int64_t leaf = 0; leaf < tree.LeafCount(); ++leaf)
  {
    const vtkIdType cell = cells[static_cast<std::size_t>(tree.CellOfLeaf(leaf))];
    levels->SetValue(cell, static_cast<signed char>(tree.LevelOfLeaf(leaf) + shift));
  }
  grid->GetCellData()->AddArray(levels);
}

void AddHanging(const banyan::ElementOctree& tree, vtkUnstructuredGrid* grid)
{
  vtkNew<vtkUnsignedCharArray> hanging;
  hanging->SetName("hanging");
  hanging->SetNumberOfTuples(grid->GetNumberOfPoints());
  hanging->Fill(0);
  for (const banyan::HangingNode& node : tree.Hanging())
  {
    hanging->SetValue(node.Node, 1);
  }
  grid->GetPointData()->AddArray(hanging);
}

void AddFacts(
  const banyan::ElementOctree& tree, const banyan::CommonLattice& common, vtkUnstructuredGrid* grid)
{
  const double facts[] = { common.Origin.x, common.Origin.y, common.Origin.z, common.Edge.x,
    common.Edge.y, common.Edge.z, static_cast<double>(common.CoarsestLevel),
    static_cast<double>(tree.HoleCells()), static_cast<double>(tree.Hanging().size()),
    static_cast<double>(tree.UnbalancedNodes()), static_cast<double>(tree.Twins().size()) };
  const char* const names[] = { "origin x", "origin y", "origin z", "finest edge x",
    "finest edge y", "finest edge z", "coarsest level", "hole cells", "hanging points",
    "unbalanced points", "coinciding points" };
  vtkNew<vtkDoubleArray> array;
  array->SetName("octree");
  array->SetNumberOfComponents(11);
  array->SetNumberOfTuples(1);
  for (int i = 0; i < 11; ++i)
  {
    array->SetComponentName(i, names[i]);
    array->SetValue(i, facts[i]);
  }
  grid->GetFieldData()->AddArray(array);
}

vtkSmartPointer<vtkUnstructuredGrid> Merged(const std::vector<vtkUnstructuredGrid*>& pieces)
{
  return banyan::MergePieces(
    pieces, [](const std::string&) { return true; }, banyan::UnevenArrays::LeftOut);
}

/// This rank's part of a mesh as one grid.
vtkSmartPointer<vtkUnstructuredGrid> GridOf(vtkDataObject* data)
{
  if (vtkUnstructuredGrid* const grid = vtkUnstructuredGrid::SafeDownCast(data))
  {
    return grid; // with its ghost cells
  }
  std::vector<vtkUnstructuredGrid*> grids;
  // A rank may have none of the blocks.
  if (!banyan::CollectGrids(data, grids) && data &&
      data->GetNumberOfElements(vtkDataObject::CELL) > 0)
  {
    throw banyan::Error("The data hold cells that an unstructured grid cannot hold");
  }
  return Merged(grids);
}

/// Collective: the grids of all ranks as one, on the first one; the others keep theirs.
vtkSmartPointer<vtkUnstructuredGrid> OnFirst(
  banyan::Communicator& ranks, vtkSmartPointer<vtkUnstructuredGrid> grid)
{
  if (ranks.Size() == 1)
  {
    return grid;
  }
  const std::vector<vtkSmartPointer<vtkDataObject>> all = banyan::GatherData(ranks, grid);
  banyan::CollectiveOn(0, ranks,
    [&]
    {
      std::vector<vtkUnstructuredGrid*> pieces;
      for (const auto& piece : all)
      {
        banyan::CollectGrids(piece, pieces);
      }
      grid = Merged(pieces);
    });
  return grid;
}

} // namespace

vtkBanyanHexOctree::vtkBanyanHexOctree() = default;
vtkBanyanHexOctree::~vtkBanyanHexOctree() = default;

int vtkBanyanHexOctree::FillInputPortInformation(int, vtkInformation* info)
{
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  for (const char* type : { "vtkUnstructuredGrid", "vtkHyperTreeGrid", "vtkOverlappingAMR",
         "vtkMultiBlockDataSet", "vtkPartitionedDataSet", "vtkPartitionedDataSetCollection" })
  {
    info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), type);
  }
  return 1;
}

int vtkBanyanHexOctree::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->SetErrorCode(vtkErrorCode::NoError);
  this->SetAbortExecute(
    0); // what stopped an update, or came behind its end, was not meant for this
  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputs);
  vtkSmartPointer<vtkDataObject> data = vtkDataObject::GetData(inputs[0]);
  vtkSmartPointer<vtkUnstructuredGrid> grid;
  bool leaves = false; // whether cells are boxes already
  try
  {
    const std::unique_ptr<banyan::Communicator> ranks =
      banyan::CommunicatorOf(vtkMultiProcessController::GetGlobalController());
    banyan::LeavesAsGrid(*ranks, {}, data, leaves);
    banyan::Collective(*ranks, [&] { grid = GridOf(data); });
    if (!this->SampleGeneralMeshes || leaves)
    {
      grid = banyan::WithArraysOfAllRanks(*ranks, grid);
      this->Describe(*ranks, grid, output);
      return 1;
    }
    grid = OnFirst(*ranks, grid);
    const std::unique_ptr<banyan::Communicator> alone = banyan::MakeSelfCommunicator();
    banyan::CollectiveOn(0, *ranks, [&] { this->Describe(*alone, grid, output); });
    return 1;
  }
  catch (const std::exception& error)
  {
    this->SetErrorCode(vtkErrorCode::UserError);
    std::string reason = error.what();
    reason.erase(reason.find_last_not_of('.') + 1);
    vtkErrorMacro(<< "The mesh is no octree of hexahedra. " << reason
                  << (this->SampleGeneralMeshes || leaves || !banyan::CanBeSampled(grid)
                         ? ""
                         : ". Switch on 'Sample General Meshes' for boxes with its values, "
                           "which a series can keep"));
    output->Initialize();
    return 0;
  }
}

/// Collective: the input with what is found in it, or the boxes that it is sampled at.
void vtkBanyanHexOctree::Describe(
  banyan::Communicator& ranks, vtkUnstructuredGrid* input, vtkUnstructuredGrid* output)
{
  std::shared_ptr<const banyan::ElementOctree> tree;
  banyan::Collective(ranks, [&] { tree = this->Survey(input, output); });
  const banyan::CommonLattice common = banyan::LatticeOfRanks(ranks, tree.get());
  if (tree)
  {
    AddLevels(*tree, common.Shift, output);
    AddHanging(*tree, output);
    AddFacts(*tree, common, output);
  }
}

/// @param output is given the input, or the boxes
/// @return null where there are no cells
std::shared_ptr<const banyan::ElementOctree> vtkBanyanHexOctree::Survey(
  vtkUnstructuredGrid* input, vtkUnstructuredGrid* output)
{
  banyan::ThreadPool& pool = banyan::ThreadPool::Process();
  const std::string leftOut = banyan::TakeLeftOut(input);
  if (!leftOut.empty())
  {
    vtkWarningMacro(<< leftOut);
  }
  vtkSmartPointer<vtkUnstructuredGrid> grid = input;
  std::shared_ptr<const banyan::ElementOctree> tree;
  try
  {
    const banyan::HexMesh mesh = banyan::HexMeshOf(grid);
    if (mesh.CellCount == 0)
    {
      output->ShallowCopy(grid);
      return nullptr;
    }
    tree = banyan::ElementOctree::Find(mesh, pool, this->MeshTolerance);
  }
  catch (const banyan::Error&)
  {
    if (!this->SampleGeneralMeshes)
    {
      throw;
    }
  }
  if (!tree)
  {
    if (!this->Sampled)
    {
      this->Sampled = std::make_unique<banyan::SampledGrid>();
    }
    try
    {
      grid = this->Sampled->Of(input, { this->MeshSamplingTolerance, this->MeshSamplingBoxes,
                                        [this](double part)
                                        {
                                          this->UpdateProgress(part);
                                          return this->GetAbortExecute() == 0;
                                        } });
    }
    catch (const banyan::Interruption&)
    {
      output->Initialize(); // as other filters that are told to stop
      return nullptr;
    }
    if (!this->Sampled->Note().empty())
    {
      vtkWarningMacro(<< this->Sampled->Note());
    }
    tree = banyan::ElementOctree::Find(banyan::HexMeshOf(grid), pool);
  }
  output->ShallowCopy(grid);
  return tree;
}

void vtkBanyanHexOctree::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MeshTolerance: " << this->MeshTolerance << "\n"
     << indent << "SampleGeneralMeshes: " << this->SampleGeneralMeshes << "\n"
     << indent << "MeshSamplingTolerance: " << this->MeshSamplingTolerance << "\n"
     << indent << "MeshSamplingBoxes: " << this->MeshSamplingBoxes << "\n";
}
