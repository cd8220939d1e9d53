// SPDX-License-Identifier: BSD-3-Clause
#include "LeafSteps.h"

#include "GridOfAmr.h"
#include "GridOfHyperTrees.h"
#include "PieceValues.h"
#include "RankTalk.h"

#include "Base/ThreadPool.h"
#include "Mesh/Octree/CellNodes.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkHyperTreeGrid.h"
#include "vtkMultiProcessStream.h"
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

std::string LeavesAsGrid(const RankTalk& talk, const std::string& problem,
  vtkSmartPointer<vtkDataObject>& data, bool& found)
{
  vtkOverlappingAMR* const blocks =
    problem.empty() ? vtkOverlappingAMR::SafeDownCast(data) : nullptr;
  vtkHyperTreeGrid* const trees = problem.empty() ? vtkHyperTreeGrid::SafeDownCast(data) : nullptr;
  vtkMultiProcessStream mine;
  mine << (blocks ? 1 : 0) << (trees ? 1 : 0) << (problem.empty() ? 0 : 1);
  bool amr = false;
  bool failed = false;
  found = false;
  for (vtkMultiProcessStream& theirs : talk.Exchange(mine))
  {
    int theirBlocks = 0, theirTrees = 0, theirProblem = 0;
    theirs >> theirBlocks >> theirTrees >> theirProblem;
    amr = amr || theirBlocks != 0;
    found = found || theirBlocks != 0 || theirTrees != 0;
    failed = failed || theirProblem != 0;
  }
  if (!found || failed)
  {
    return {};
  }
  try
  {
    vtkSmartPointer<vtkUnstructuredGrid> grid;
    if (amr)
    {
      grid = GridOfAmrOnRanks(blocks, talk);
    }
    talk.Together(
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
  catch (const AgreedError& error)
  {
    return error.what();
  }
  return {};
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
