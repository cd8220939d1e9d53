// SPDX-License-Identifier: BSD-3-Clause
#include "LeafSteps.h"

#include "GridOfAmr.h"
#include "GridOfHyperTrees.h"
#include "PieceValues.h"

#include "Base/ThreadPool.h"
#include "Mesh/Octree/CellNodes.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkHyperTreeGrid.h"
#include "vtkNew.h"
#include "vtkOverlappingAMR.h"
#include "vtkPointData.h"
#include "vtkUnstructuredGrid.h"

namespace banyan
{
namespace
{

std::shared_ptr<const ElementOctree> Unowned(const ElementOctree& tree)
{
  return { std::shared_ptr<const void>(), &tree };
}

/// A component of an array at the points of the octree.
void FillComponent(const ElementOctree& tree, vtkDataArray* from, ValuesOn where, int component,
  vtkDataArray* to, ThreadPool& pool)
{
  NodeArray given;
  given.Values = from->GetVoidPointer(0);
  given.Type = TypeOf(from);
  given.Components = from->GetNumberOfComponents();
  given.Component = component;
  const CellNodes made(tree, given, where, pool);
  const NodalField field(Unowned(tree), made.Nodes(), pool);
  for (vtkIdType point = 0; point < to->GetNumberOfTuples(); ++point)
  {
    to->SetComponent(point, component, field.AtNode(point));
  }
}

} // namespace

void LeavesAsGrid(Communicator& ranks, const std::string& problem,
  vtkSmartPointer<vtkDataObject>& data, bool& found)
{
  vtkOverlappingAMR* const blocks =
    problem.empty() ? vtkOverlappingAMR::SafeDownCast(data) : nullptr;
  vtkHyperTreeGrid* const trees = problem.empty() ? vtkHyperTreeGrid::SafeDownCast(data) : nullptr;
  const bool failed = AllMax(ranks, problem.empty() ? 0.0 : 1.0) > 0.0;
  const double kind = AllMax(ranks, blocks ? 2.0 : trees ? 1.0 : 0.0);
  found = kind > 0.0;
  if (!found || failed)
  {
    return;
  }
  vtkSmartPointer<vtkUnstructuredGrid> grid;
  if (kind == 2.0)
  {
    grid = GridOfAmrOnRanks(ranks, blocks);
  }
  Collective(ranks,
    [&]
    {
      if (trees)
      {
        grid = GridOfHyperTrees(trees);
      }
    });
  if (blocks || trees)
  {
    data = grid.GetPointer();
  }
}

void MakeNodal(const ElementOctree& tree, vtkUnstructuredGrid* grid,
  const std::function<bool(const std::string&)>& wanted)
{
  ThreadPool pool(ThreadPool::DefaultWidth());
  vtkNew<vtkPointData> nodal;
  for (const int where : { vtkDataObject::POINT, vtkDataObject::CELL })
  {
    vtkDataSetAttributes* const arrays = grid->GetAttributes(where);
    for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
    {
      vtkDataArray* const from = arrays->GetArray(i);
      if (!from || !from->GetName() || from->GetDataType() == VTK_BIT ||
          nodal->GetArray(from->GetName()) || !wanted(from->GetName()))
      {
        continue;
      }
      const auto to = vtkSmartPointer<vtkDataArray>::Take(
        vtkDataArray::CreateDataArray(FitsFloat(TypeOf(from)) ? VTK_FLOAT : VTK_DOUBLE));
      to->SetName(from->GetName());
      to->SetNumberOfComponents(from->GetNumberOfComponents());
      to->CopyComponentNames(from);
      to->SetNumberOfTuples(grid->GetNumberOfPoints());
      for (int component = 0; component < from->GetNumberOfComponents(); ++component)
      {
        FillComponent(tree, from,
          where == vtkDataObject::CELL ? ValuesOn::Cells : ValuesOn::CellCorners, component, to,
          pool);
      }
      nodal->AddArray(to);
    }
  }
  grid->GetCellData()->Initialize();
  grid->GetPointData()->ShallowCopy(nodal);
}

} // namespace banyan
