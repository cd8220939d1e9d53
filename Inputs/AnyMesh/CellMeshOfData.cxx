// SPDX-License-Identifier: BSD-3-Clause
#include "AnyMesh/CellMeshOfData.h"

#include "AnyMesh/HiddenOfData.h"
#include "AnyMesh/LinearParts.h"
#include "ArrayLength.h"
#include "CellArrays.h"

#include "vtkCellArray.h"
#include "vtkCellType.h"
#include "vtkCellTypes.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkExplicitStructuredGrid.h"
#include "vtkFloatArray.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkRectilinearGrid.h"
#include "vtkStructuredGrid.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <vector>

namespace banyan
{
namespace
{

/// Keeps a mesh's arrays alive: those of now, the data may get others.
struct Owners
{
  std::vector<vtkSmartPointer<vtkDataArray>> Arrays;
  std::shared_ptr<const std::vector<std::uint8_t>> Hidden;
};

/// Whether an array can be read where it is, as float or double.
bool IsPlain(vtkDataArray* array)
{
  return array->HasStandardMemoryLayout() &&
         (array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE);
}

ScalarType TypeOfPlain(vtkDataArray* array)
{
  return array->GetDataType() == VTK_FLOAT ? ScalarType::Float32 : ScalarType::Float64;
}

template <class Array>
vtkSmartPointer<vtkDataArray> CopyAs(vtkDataArray* array)
{
  const auto copy = vtkSmartPointer<Array>::New();
  copy->DeepCopy(array);
  return copy;
}

/// The array itself, or a copy that can be read as float or double.
vtkSmartPointer<vtkDataArray> Plain(vtkDataArray* array)
{
  return IsPlain(array)                      ? vtkSmartPointer<vtkDataArray>(array)
         : array->GetDataType() == VTK_FLOAT ? CopyAs<vtkFloatArray>(array)
                                             : CopyAs<vtkDoubleArray>(array);
}

class MeshMaker
{
public:
  explicit MeshMaker(const MeshOfData& before)
    : Before(before)
  {
  }

  MeshOfData Make(vtkDataSet* data)
  {
    int size[3];
    if (auto* const grid = vtkUnstructuredGrid::SafeDownCast(data))
    {
      this->TakeGrid(grid);
    }
    else if (auto* const explicitGrid = vtkExplicitStructuredGrid::SafeDownCast(data))
    {
      this->TakeExplicit(explicitGrid);
    }
    else if (auto* const curvilinear = vtkStructuredGrid::SafeDownCast(data))
    {
      curvilinear->GetDimensions(size);
      if (this->TakeSize(curvilinear, size))
      {
        this->Taken.Mesh.Is = CellMesh::Kind::Curvilinear;
        this->TakePoints(curvilinear);
      }
    }
    else if (auto* const rectilinear = vtkRectilinearGrid::SafeDownCast(data))
    {
      rectilinear->GetDimensions(size);
      if (this->TakeSize(rectilinear, size))
      {
        this->Taken.Mesh.Is = CellMesh::Kind::Rectilinear;
        this->TakeAxes(rectilinear);
      }
    }
    else
    {
      this->LeaveAllOut(data);
    }
    if (this->Taken.Mesh.CellCount > 0)
    {
      this->Hide(data);
      this->Taken.Mesh.Owner = this->Kept;
    }
    return std::move(this->Taken);
  }

private:
  const void* Keep(const vtkSmartPointer<vtkDataArray>& array)
  {
    this->Kept->Arrays.push_back(array);
    return array->GetVoidPointer(0);
  }

  void LeaveOut(vtkIdType cell, int type)
  {
    OtherCells& others = this->Taken.Others;
    if (type != VTK_EMPTY_CELL && others.Count++ == 0)
    {
      const char* const name = vtkCellTypes::GetClassNameFromTypeId(type);
      others.First = cell;
      others.Type = name ? name : std::to_string(type);
    }
  }

  void LeaveAllOut(vtkDataSet* data)
  {
    for (vtkIdType cell = 0; cell < data->GetNumberOfCells(); ++cell)
    {
      this->LeaveOut(cell, data->GetCellType(cell));
    }
  }

  /// False where a grid of points has no cells in three dimensions.
  bool TakeSize(vtkDataSet* grid, const int (&size)[3])
  {
    if (std::min({ size[0], size[1], size[2] }) < 2)
    {
      this->LeaveAllOut(grid);
      return false;
    }
    CellMesh& mesh = this->Taken.Mesh;
    mesh.Size = { size[0], size[1], size[2] };
    mesh.PointCount = std::int64_t{ size[0] } * size[1] * size[2];
    mesh.CellCount = std::int64_t{ size[0] - 1 } * (size[1] - 1) * (size[2] - 1);
    return true;
  }

  void TakePoints(vtkPointSet* set)
  {
    CellMesh& mesh = this->Taken.Mesh;
    const vtkIdType count = set->GetPoints() ? set->GetPoints()->GetNumberOfPoints() : 0;
    if (mesh.Is == CellMesh::Kind::Curvilinear && count != mesh.PointCount)
    {
      throw Error("The grid has " + std::to_string(count) + " points in place of " +
                  std::to_string(mesh.PointCount) + ".");
    }
    mesh.PointCount = count;
    const auto points = Plain(set->GetPoints()->GetData());
    mesh.Points = this->Keep(points);
    mesh.PointType = TypeOfPlain(points);
  }

  void TakeAxes(vtkRectilinearGrid* grid)
  {
    CellMesh& mesh = this->Taken.Mesh;
    vtkDataArray* const axes[3] = { grid->GetXCoordinates(), grid->GetYCoordinates(),
      grid->GetZCoordinates() };
    bool alike = true;
    for (int axis = 0; axis < 3; ++axis)
    {
      const vtkIdType count = axes[axis] ? axes[axis]->GetNumberOfValues() : 0;
      if (count != mesh.Size[axis])
      {
        throw Error("The grid has " + std::to_string(count) + " coordinates along " + "xyz"[axis] +
                    std::string(" in place of ") + std::to_string(mesh.Size[axis]) + ".");
      }
      alike = alike && IsPlain(axes[axis]) && axes[axis]->GetDataType() == axes[0]->GetDataType();
    }
    mesh.PointType = alike ? TypeOfPlain(axes[0]) : ScalarType::Float64;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      mesh.Axes[axis] = this->Keep(
        alike ? vtkSmartPointer<vtkDataArray>(axes[axis]) : CopyAs<vtkDoubleArray>(axes[axis]));
    }
  }

  /// Throws Error when cells have no points at all, or not each cell has a type.
  static void CheckWhole(vtkPointSet* set, vtkCellArray* cells, vtkDataArray* types)
  {
    const vtkIdType count = cells->GetNumberOfCells();
    if (set->GetNumberOfPoints() == 0)
    {
      throw Error("The mesh has " + std::to_string(count) + " cells, but no points");
    }
    const vtkIdType typed = types ? types->GetNumberOfTuples() : 0;
    if (typed != count)
    {
      throw Error("The mesh has " + std::to_string(count) + " cells, but the types of " +
                  std::to_string(typed));
    }
  }

  void TakeGrid(vtkUnstructuredGrid* grid)
  {
    if (grid->GetNumberOfCells() == 0)
    {
      return;
    }
    CheckWhole(grid, grid->GetCells(), CellTypesOf(grid));
    const auto types = PlainCellTypesOf(grid);
    bool divided = false;
    for (vtkIdType cell = 0; cell < types->GetNumberOfValues(); ++cell)
    {
      const unsigned char type = types->GetValue(cell);
      const bool whole = CellMesh::ShapeOf(type) != CellShape::None;
      divided = divided || (!whole && HasLinearParts(type));
      if (!whole && !HasLinearParts(type))
      {
        this->LeaveOut(cell, type);
      }
    }
    if (this->Taken.Others.Count == grid->GetNumberOfCells())
    {
      return;
    }
    if (divided)
    {
      this->TakeParts(grid);
      return;
    }
    this->TakePoints(grid);
    this->TakeCells(grid->GetCells(), types);
  }

  void TakeParts(vtkUnstructuredGrid* grid)
  {
    this->Taken.Parts = LinearPartsOf(grid, this->Before.Parts);
    vtkUnstructuredGrid* const parts = this->Taken.Parts->Grid;
    if (parts->GetNumberOfCells() > 0)
    {
      this->TakePoints(parts);
      this->TakeCells(parts->GetCells(), PlainCellTypesOf(parts));
    }
  }

  void TakeExplicit(vtkExplicitStructuredGrid* grid)
  {
    vtkCellArray* const cells = grid->GetCells();
    if (!cells || cells->GetNumberOfCells() == 0)
    {
      return;
    }
    const auto types = vtkSmartPointer<vtkUnsignedCharArray>::New();
    types->SetNumberOfValues(cells->GetNumberOfCells());
    types->FillValue(VTK_HEXAHEDRON);
    CheckWhole(grid, cells, types);
    this->TakePoints(grid);
    this->TakeCells(cells, types);
  }

  void TakeCells(vtkCellArray* cells, const vtkSmartPointer<vtkUnsignedCharArray>& types)
  {
    CellMesh& mesh = this->Taken.Mesh;
    mesh.CellCount = cells->GetNumberOfCells();
    mesh.Types = static_cast<const std::uint8_t*>(this->Keep(types));
    vtkSmartPointer<vtkDataArray> ids = cells->GetConnectivityArray();
    vtkSmartPointer<vtkDataArray> offsets = cells->GetOffsetsArray();
    // Cells of one size are found without offsets: a read from memory less for each.
    const vtkIdType same = cells->IsHomogeneous();
    if (same > 0)
    {
      offsets = nullptr;
      mesh.PerCell = static_cast<int>(same);
    }
    const auto asTheyAre = [&](vtkDataArray* array)
    {
      return array->HasStandardMemoryLayout() &&
             array->GetDataTypeSize() == ids->GetDataTypeSize() &&
             (array->GetDataTypeSize() == 4 || array->GetDataTypeSize() == 8);
    };
    if (!asTheyAre(ids) || (offsets && !asTheyAre(offsets)))
    {
      ids = CopyAs<vtkTypeInt64Array>(ids);
      offsets = offsets ? CopyAs<vtkTypeInt64Array>(offsets) : nullptr;
    }
    mesh.IdType = ids->GetDataTypeSize() == 4 ? ScalarType::Int32 : ScalarType::Int64;
    mesh.Connectivity = this->Keep(ids);
    mesh.ConnectivityCount = ids->GetNumberOfValues();
    mesh.Offsets = offsets ? this->Keep(offsets) : nullptr;
  }

  void Hide(vtkDataSet* data)
  {
    std::vector<std::uint8_t> hidden = HiddenCellsOf(data);
    if (hidden.empty())
    {
      return;
    }
    if (this->Taken.Parts)
    {
      std::vector<std::uint8_t> parts;
      parts.reserve(this->Taken.Parts->CellOf.size());
      for (const vtkIdType cell : this->Taken.Parts->CellOf)
      {
        parts.push_back(hidden[static_cast<std::size_t>(cell)]);
      }
      hidden = std::move(parts);
    }
    this->Kept->Hidden = std::make_shared<const std::vector<std::uint8_t>>(std::move(hidden));
    this->Taken.Mesh.Hidden = this->Kept->Hidden->data();
  }

  const MeshOfData& Before;
  MeshOfData Taken;
  std::shared_ptr<Owners> Kept = std::make_shared<Owners>();
};

} // namespace

vtkSmartPointer<vtkDataArray> MeshOfData::ValuesOf(vtkDataArray* values, ValuesOn where) const
{
  if (!values || !this->Parts)
  {
    return values;
  }
  return where == ValuesOn::Cells ? this->Parts->CellValues(values)
                                  : this->Parts->PointValues(values);
}

MeshOfData CellMeshOf(vtkDataSet* data, const MeshOfData& before)
{
  return data ? MeshMaker(before).Make(data) : MeshOfData{};
}

} // namespace banyan
