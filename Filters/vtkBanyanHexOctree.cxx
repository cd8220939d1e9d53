#include "vtkBanyanHexOctree.h"

#include "GridOfAmr.h"
#include "GridOfHyperTrees.h"
#include "HexMeshOfGrid.h"
#include "RankTalk.h"

#include "Base/ThreadPool.h"
#include "HexOctree/ElementOctree.h"

#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkErrorCode.h"
#include "vtkFieldData.h"
#include "vtkHyperTreeGrid.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkOverlappingAMR.h"
#include "vtkPointData.h"
#include "vtkSignedCharArray.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

vtkStandardNewMacro(vtkBanyanHexOctree);

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

void AddLevels(const banyan::ElementOctree& tree, vtkUnstructuredGrid* grid)
{
  const std::vector<vtkIdType> cells = CellsWithoutGhosts(grid);
  vtkNew<vtkSignedCharArray> levels;
  levels->SetName("octree_level");
  levels->SetNumberOfTuples(grid->GetNumberOfCells());
  levels->Fill(-1);
  for (std::int64_t leaf = 0; leaf < tree.LeafCount(); ++leaf)
  {
    const vtkIdType cell = cells[static_cast<std::size_t>(tree.CellOfLeaf(leaf))];
    levels->SetValue(cell, static_cast<signed char>(tree.LevelOfLeaf(leaf)));
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

void AddFacts(const banyan::ElementOctree& tree, vtkUnstructuredGrid* grid)
{
  const double facts[] = { tree.Origin().x, tree.Origin().y, tree.Origin().z, tree.Edge().x,
    tree.Edge().y, tree.Edge().z, static_cast<double>(tree.CoarsestLevel()),
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

/// Collective for AMR.
vtkSmartPointer<vtkUnstructuredGrid> GridOf(vtkDataObject* data)
{
  if (vtkHyperTreeGrid* const trees = vtkHyperTreeGrid::SafeDownCast(data))
  {
    return banyan::GridOfHyperTrees(trees);
  }
  if (vtkOverlappingAMR* const blocks = vtkOverlappingAMR::SafeDownCast(data))
  {
    const banyan::RankTalk talk(vtkMultiProcessController::GetGlobalController());
    return banyan::GridOfAmrOnRanks(blocks, talk);
  }
  return vtkUnstructuredGrid::SafeDownCast(data);
}

} // namespace

int vtkBanyanHexOctree::FillInputPortInformation(int, vtkInformation* info)
{
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  for (const char* type : { "vtkUnstructuredGrid", "vtkHyperTreeGrid", "vtkOverlappingAMR" })
  {
    info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), type);
  }
  return 1;
}

int vtkBanyanHexOctree::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->SetErrorCode(vtkErrorCode::NoError);
  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputs);
  try
  {
    const vtkSmartPointer<vtkUnstructuredGrid> input = GridOf(vtkDataObject::GetData(inputs[0]));
    output->ShallowCopy(input);
    const banyan::HexMesh mesh = banyan::HexMeshOf(input);
    if (mesh.CellCount == 0)
    {
      return 1;
    }
    const auto tree =
      banyan::ElementOctree::Find(mesh, banyan::ThreadPool::Process(), this->MeshTolerance);
    AddLevels(*tree, output);
    AddHanging(*tree, output);
    AddFacts(*tree, output);
    return 1;
  }
  catch (const std::exception& error)
  {
    this->SetErrorCode(vtkErrorCode::UserError);
    vtkErrorMacro(<< "The mesh is no octree of hexahedra. " << error.what());
    output->Initialize();
    return 0;
  }
}

void vtkBanyanHexOctree::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MeshTolerance: " << this->MeshTolerance << "\n";
}
