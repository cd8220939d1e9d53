#include "HexMeshOfGrid.h"

#include "VoxelCells.h"

#include "vtkCellArray.h"
#include "vtkCellTypes.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <vector>

namespace banyan
{
namespace
{

constexpr int GhostBits = vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL;

void CheckTypes(vtkUnstructuredGrid* grid)
{
  const vtkIdType cells = grid->GetNumberOfCells();
  for (vtkIdType cell = 0; cell < cells; ++cell)
  {
    const int type = grid->GetCellType(cell);
    if (type != VTK_HEXAHEDRON && type != VTK_VOXEL)
    {
      const char* name = vtkCellTypes::GetClassNameFromTypeId(type);
      throw Error("Cell " + std::to_string(cell) + " is of the type " +
                  (name ? name : std::to_string(type)) +
                  ": an octree has hexahedra and voxels only. Extract these with 'Extract Cells By "
                  "Type', or use 'Resample To Image'.");
    }
  }
  // Whatever the types say: it is the points that are read.
  if (grid->GetCells()->IsHomogeneous() != 8)
  {
    throw Error("A hexahedron or voxel of the grid has not 8 points.");
  }
}

bool HasGhosts(vtkUnsignedCharArray* ghosts)
{
  for (vtkIdType cell = 0; ghosts && cell < ghosts->GetNumberOfTuples(); ++cell)
  {
    if ((ghosts->GetValue(cell) & GhostBits) != 0)
    {
      return true;
    }
  }
  return false;
}

template <class Id>
std::shared_ptr<std::vector<Id>> WithoutGhosts(
  const Id* ids, vtkIdType cells, vtkUnsignedCharArray* ghosts)
{
  auto kept = std::make_shared<std::vector<Id>>();
  for (vtkIdType cell = 0; cell < cells; ++cell)
  {
    if ((ghosts->GetValue(cell) & GhostBits) == 0)
    {
      kept->insert(kept->end(), ids + 8 * cell, ids + 8 * cell + 8);
    }
  }
  return kept;
}

/// What keeps a mesh's arrays alive.
struct Owners
{
  vtkSmartPointer<vtkUnstructuredGrid> Grid;
  vtkSmartPointer<vtkDataArray> Points;
  std::shared_ptr<const void> Ids;
};

template <class Id>
void TakeIds(vtkUnstructuredGrid* grid, const Id* ids, HexMesh& mesh, Owners& owners)
{
  mesh.IdType = ScalarTypeOf<Id>();
  mesh.Connectivity = ids;
  mesh.CellCount = grid->GetNumberOfCells();
  vtkUnsignedCharArray* const ghosts = grid->GetCellGhostArray();
  if (HasGhosts(ghosts))
  {
    const std::shared_ptr<std::vector<Id>> kept = WithoutGhosts(ids, mesh.CellCount, ghosts);
    mesh.Connectivity = kept->data();
    mesh.CellCount = static_cast<std::int64_t>(kept->size() / 8);
    owners.Ids = kept;
  }
}

} // namespace

HexMesh HexMeshOf(vtkUnstructuredGrid* grid)
{
  HexMesh mesh;
  if (!grid || grid->GetNumberOfCells() == 0 || grid->GetNumberOfPoints() == 0)
  {
    return mesh;
  }
  CheckTypes(grid);
  const auto owners = std::make_shared<Owners>();
  owners->Grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  // The arrays of now: the grid itself may get others.
  owners->Grid->ShallowCopy(grid);
  owners->Points = grid->GetPoints()->GetData();
  const int type = owners->Points->GetDataType();
  if (type != VTK_FLOAT && type != VTK_DOUBLE)
  {
    throw Error("The points of the grid are neither float nor double.");
  }
  mesh.Points = owners->Points->GetVoidPointer(0);
  mesh.PointType = type == VTK_FLOAT ? ScalarType::Float32 : ScalarType::Float64;
  mesh.PointCount = grid->GetNumberOfPoints();
  vtkCellArray* const cells = grid->GetCells();
  if (cells->IsStorage64Bit())
  {
    TakeIds(grid, cells->GetConnectivityArray64()->GetPointer(0), mesh, *owners);
  }
  else
  {
    TakeIds(grid, cells->GetConnectivityArray32()->GetPointer(0), mesh, *owners);
  }
  mesh.Owner = owners;
  return mesh;
}

vtkSmartPointer<vtkDataArray> ValuesOfCells(vtkUnstructuredGrid* grid, vtkDataArray* values)
{
  vtkUnsignedCharArray* const ghosts = grid ? grid->GetCellGhostArray() : nullptr;
  if (!values || !HasGhosts(ghosts))
  {
    return values;
  }
  vtkNew<vtkIdList> kept;
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    if ((ghosts->GetValue(cell) & GhostBits) == 0)
    {
      kept->InsertNextId(cell);
    }
  }
  return Chosen(values, kept);
}

} // namespace banyan
