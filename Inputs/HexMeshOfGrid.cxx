// SPDX-License-Identifier: BSD-3-Clause
#include "HexMeshOfGrid.h"

#include "ArrayLength.h"
#include "CellArrays.h"
#include "GhostCells.h"
#include "VoxelCells.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellTypes.h"
#include "vtkDataArray.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace banyan
{

void CheckWhole(vtkUnstructuredGrid* grid)
{
  const vtkIdType cells = grid->GetNumberOfCells();
  if (grid->GetNumberOfPoints() == 0)
  {
    throw Error("The mesh has " + std::to_string(cells) + " cells, but no points");
  }
  const vtkIdType types = CellTypesOf(grid)->GetNumberOfTuples();
  if (types != cells)
  {
    throw Error("The mesh has " + std::to_string(cells) + " cells, but the types of " +
                std::to_string(types));
  }
  CheckLength(GhostFlags(grid->GetCellData()), vtkDataObject::CELL, cells);
}

namespace
{

bool IsHexahedron(int type)
{
  return type == VTK_HEXAHEDRON || type == VTK_VOXEL;
}

OtherCells FindOthers(vtkUnstructuredGrid* grid)
{
  OtherCells others;
  const vtkIdType cells = grid->GetNumberOfCells();
  for (vtkIdType cell = 0; cell < cells; ++cell)
  {
    const int type = grid->GetCellType(cell);
    if (!IsHexahedron(type) && others.Count++ == 0)
    {
      const char* name = vtkCellTypes::GetClassNameFromTypeId(type);
      others.First = cell;
      others.Type = name ? name : std::to_string(type);
    }
  }
  return others;
}

/// The cells that count; null when all do.
vtkSmartPointer<vtkIdList> KeptCells(vtkUnstructuredGrid* grid, const OtherCells& others)
{
  vtkUnsignedCharArray* const ghosts = grid->GetCellGhostArray();
  if (others.Count == 0 && !HasGhosts(ghosts))
  {
    return nullptr;
  }
  auto kept = vtkSmartPointer<vtkIdList>::New();
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    if ((!ghosts || (ghosts->GetValue(cell) & GhostBits) == 0) &&
        IsHexahedron(grid->GetCellType(cell)))
    {
      kept->InsertNextId(cell);
    }
  }
  return kept;
}

/// Throws Error when a cell has not eight points, whatever its type says: it is those that are
/// read.
void CheckPoints(vtkUnstructuredGrid* grid, vtkIdList* kept)
{
  vtkCellArray* const cells = grid->GetCells();
  bool eight = cells->IsHomogeneous() == 8;
  if (!eight && kept)
  {
    eight = true;
    for (vtkIdType i = 0; i < kept->GetNumberOfIds() && eight; ++i)
    {
      eight = cells->GetCellSize(kept->GetId(i)) == 8;
    }
  }
  if (!eight)
  {
    throw Error("A hexahedron or voxel of the grid does not have 8 points.");
  }
}

template <class Id>
std::shared_ptr<std::vector<Id>> IdsOf(vtkUnstructuredGrid* grid, const Id* ids, vtkIdList* kept)
{
  auto chosen = std::make_shared<std::vector<Id>>();
  vtkDataArray* const offsets = grid->GetCells()->GetOffsetsArray();
  for (vtkIdType i = 0; i < kept->GetNumberOfIds(); ++i)
  {
    const auto begin = static_cast<vtkIdType>(offsets->GetTuple1(kept->GetId(i)));
    chosen->insert(chosen->end(), ids + begin, ids + begin + 8);
  }
  return chosen;
}

/// Keeps a mesh's arrays alive.
struct Owners
{
  vtkSmartPointer<vtkUnstructuredGrid> Grid;
  vtkSmartPointer<vtkDataArray> Points;
  vtkSmartPointer<vtkDataArray> Connectivity;
  std::shared_ptr<const void> Ids;
};

template <class Id>
void TakeIds(
  vtkUnstructuredGrid* grid, const Id* ids, vtkIdList* kept, HexMesh& mesh, Owners& owners)
{
  mesh.IdType = ScalarTypeOf<Id>();
  mesh.Connectivity = ids;
  mesh.CellCount = grid->GetNumberOfCells();
  if (kept)
  {
    const std::shared_ptr<std::vector<Id>> chosen = IdsOf(grid, ids, kept);
    mesh.Connectivity = chosen->data();
    mesh.CellCount = static_cast<std::int64_t>(chosen->size() / 8);
    owners.Ids = chosen;
  }
}

/// Whether the corners of a cell exist and lie apart along x, y and z.
template <class Coordinate, class Id>
bool Extends(const Coordinate* points, std::int64_t count, const Id* corners)
{
  double low[3];
  double high[3];
  for (int i = 0; i < 8; ++i)
  {
    const auto id = static_cast<std::int64_t>(corners[i]);
    if (id < 0 || id >= count)
    {
      return false;
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      const double at = points[3 * id + axis];
      if (!std::isfinite(at))
      {
        return false;
      }
      low[axis] = i == 0 ? at : std::min(low[axis], at);
      high[axis] = i == 0 ? at : std::max(high[axis], at);
    }
  }
  return high[0] > low[0] && high[1] > low[1] && high[2] > low[2];
}

/// Whether the points of a cell lie in two places along an axis, but for an eighth of their
/// distance.
bool HasTwoPlaces(vtkUnstructuredGrid* grid, vtkIdList* ids, int axis)
{
  double low = 0.0;
  double high = 0.0;
  const auto at = [&](vtkIdType i)
  {
    const vtkIdType point = ids->GetId(i);
    return point >= 0 && point < grid->GetNumberOfPoints() ? grid->GetPoint(point)[axis] : 0.0;
  };
  for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
  {
    low = i == 0 ? at(i) : std::min(low, at(i));
    high = i == 0 ? at(i) : std::max(high, at(i));
  }
  bool two = true;
  for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
  {
    two = two && std::min(at(i) - low, high - at(i)) <= 0.125 * (high - low);
  }
  return two;
}

} // namespace

std::string OtherCells::Text() const
{
  return std::to_string(this->Count) + (this->Count == 1 ? " cell, cell " : " cells, cell ") +
         std::to_string(this->First) + " of the type " + this->Type +
         (this->Count == 1 ? "" : " the first of them");
}

HexMesh HexMeshOf(vtkUnstructuredGrid* grid, OtherCells* others)
{
  HexMesh mesh;
  if (!grid || grid->GetNumberOfCells() == 0)
  {
    return mesh;
  }
  CheckWhole(grid);
  const OtherCells left = FindOthers(grid);
  if (left.Count > 0 && !others)
  {
    throw Error("Cell " + std::to_string(left.First) + " is of the type " + left.Type +
                ": an octree has hexahedra and voxels only. Extract these with 'Extract Cells By "
                "Type', or use 'Resample To Image'.");
  }
  if (others)
  {
    *others = left;
  }
  const vtkSmartPointer<vtkIdList> kept = KeptCells(grid, left);
  CheckPoints(grid, kept);
  const auto owners = std::make_shared<Owners>();
  owners->Grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  // The arrays of now: the grid itself may get others.
  owners->Grid->ShallowCopy(grid);
  owners->Points = grid->GetPoints()->GetData();
  const int type = owners->Points->GetDataType();
  if (type != VTK_FLOAT && type != VTK_DOUBLE)
  {
    throw Error("The points of the grid must be float or double.");
  }
  mesh.Points = owners->Points->GetVoidPointer(0);
  mesh.PointType = type == VTK_FLOAT ? ScalarType::Float32 : ScalarType::Float64;
  mesh.PointCount = grid->GetNumberOfPoints();
  owners->Connectivity = grid->GetCells()->GetConnectivityArray();
  if (!owners->Connectivity->HasStandardMemoryLayout())
  {
    const auto plain = vtkSmartPointer<vtkTypeInt64Array>::New();
    plain->DeepCopy(owners->Connectivity);
    owners->Connectivity = plain;
  }
  const void* const ids = owners->Connectivity->GetVoidPointer(0);
  if (owners->Connectivity->GetDataTypeSize() == 8)
  {
    TakeIds(grid, static_cast<const vtkTypeInt64*>(ids), kept, mesh, *owners);
  }
  else
  {
    TakeIds(grid, static_cast<const vtkTypeInt32*>(ids), kept, mesh, *owners);
  }
  mesh.Owner = owners;
  return mesh;
}

bool CanBeSampled(vtkUnstructuredGrid* grid)
{
  try
  {
    OtherCells others;
    const HexMesh mesh = HexMeshOf(grid, &others);
    return mesh.CellCount > 0 &&
           DispatchMesh(mesh,
             [&](const auto* points, const auto* ids)
             {
               bool all = true;
               for (std::int64_t cell = 0; cell < mesh.CellCount && all; ++cell)
               {
                 all = Extends(points, mesh.PointCount, ids + 8 * cell);
               }
               return all;
             });
  }
  catch (const Error&)
  {
    return false;
  }
}

bool HasBoxesAlone(vtkUnstructuredGrid* grid)
{
  // Of others one in so many is enough to tell: what is no octree is found out later, too.
  constexpr vtkIdType most = 1000;
  const vtkIdType count = grid->GetNumberOfCells();
  const vtkIdType step = count / most + 1;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < count; ++cell)
  {
    const int type = grid->GetCellType(cell);
    if (!IsHexahedron(type))
    {
      if (vtkCellTypes::IsLinear(static_cast<unsigned char>(type)) == 0 ||
          (type >= VTK_TETRA && type <= VTK_HEXAGONAL_PRISM))
      {
        return false;
      }
    }
    else if (cell % step == 0)
    {
      grid->GetCells()->GetCellAtId(cell, ids);
      for (int axis = 0; axis < 3; ++axis)
      {
        if (!HasTwoPlaces(grid, ids, axis))
        {
          return false;
        }
      }
    }
  }
  return true;
}

vtkSmartPointer<vtkDataArray> ValuesOfCells(vtkUnstructuredGrid* grid, vtkDataArray* values)
{
  if (!grid || !values)
  {
    return values;
  }
  const vtkSmartPointer<vtkIdList> kept = KeptCells(grid, FindOthers(grid));
  if (!kept)
  {
    return values;
  }
  return Chosen(values, kept);
}

} // namespace banyan
