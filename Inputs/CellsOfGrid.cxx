// SPDX-License-Identifier: BSD-3-Clause
#include "CellsOfGrid.h"

#include "CellArrays.h"
#include "HexMeshOfGrid.h"

#include "vtkCellArray.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cstring>

namespace banyan
{
namespace
{

std::vector<std::int64_t> NumbersOf(vtkDataArray* array)
{
  vtkNew<vtkIdTypeArray> ids;
  ids->DeepCopy(array);
  return { ids->GetPointer(0), ids->GetPointer(0) + ids->GetNumberOfValues() };
}

bool HasPolyhedra(vtkUnstructuredGrid* grid)
{
  vtkDataArray* const types = CellTypesOf(grid);
  bool has = false;
  for (vtkIdType cell = 0; types && cell < types->GetNumberOfTuples() && !has; ++cell)
  {
    has = types->GetTuple1(cell) == VTK_POLYHEDRON;
  }
  return has;
}

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

} // namespace

ScalarType TypeOfPoints(vtkUnstructuredGrid* grid)
{
  return grid->GetPoints() && grid->GetPoints()->GetDataType() == VTK_FLOAT ? ScalarType::Float32
                                                                            : ScalarType::Float64;
}

Bytes PointsOfGrid(vtkUnstructuredGrid* grid, ScalarType type)
{
  vtkDataArray* const data = grid->GetPoints() ? grid->GetPoints()->GetData() : nullptr;
  if (!data)
  {
    return {};
  }
  const bool plain = data->HasStandardMemoryLayout() &&
                     data->GetDataType() == (type == ScalarType::Float32 ? VTK_FLOAT : VTK_DOUBLE);
  vtkSmartPointer<vtkDataArray> copy;
  if (!plain)
  {
    copy = vtkSmartPointer<vtkDataArray>::Take(
      vtkDataArray::CreateDataArray(type == ScalarType::Float32 ? VTK_FLOAT : VTK_DOUBLE));
    copy->DeepCopy(data);
  }
  vtkDataArray* const from = copy ? copy.Get() : data;
  Bytes points(3 * SizeOf(type) * static_cast<std::size_t>(from->GetNumberOfTuples()));
  if (!points.empty())
  {
    std::memcpy(points.data(), from->GetVoidPointer(0), points.size());
  }
  return points;
}

std::vector<std::int64_t> FacesOfGrid(vtkUnstructuredGrid* grid)
{
  std::vector<std::int64_t> faces;
  if (!HasPolyhedra(grid))
  {
    return faces;
  }
  vtkNew<vtkIdList> stream;
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    if (grid->GetCellType(cell) == VTK_POLYHEDRON)
    {
      stream->Reset();
      grid->GetFaceStream(cell, stream);
      if (stream->GetNumberOfIds() == 0)
      {
        faces.push_back(0);
      }
      faces.insert(faces.end(), stream->begin(), stream->end());
    }
  }
  return faces;
}

StoredCells CellsOfGrid(vtkUnstructuredGrid* grid)
{
  CheckWhole(grid);
  StoredCells cells;
  cells.PointType = TypeOfPoints(grid);
  cells.Points = PointsOfGrid(grid, cells.PointType);
  const auto types = PlainCellTypesOf(grid);
  cells.Types.assign(types->GetPointer(0), types->GetPointer(0) + types->GetNumberOfValues());
  cells.Offsets = NumbersOf(grid->GetCells()->GetOffsetsArray());
  cells.Connectivity = NumbersOf(grid->GetCells()->GetConnectivityArray());
  if (!cells.Offsets.empty() && cells.Offsets.back() >= 0 &&
      cells.Offsets.back() < static_cast<std::int64_t>(cells.Connectivity.size()))
  {
    // Room that is left behind the last cell is no part of the mesh.
    cells.Connectivity.resize(static_cast<std::size_t>(cells.Offsets.back()));
  }
  cells.Faces = FacesOfGrid(grid);
  return cells;
}

std::string ChangeOfCells(vtkUnstructuredGrid* before, vtkUnstructuredGrid* now)
{
  if (before->GetNumberOfCells() != now->GetNumberOfCells() ||
      before->GetNumberOfPoints() != now->GetNumberOfPoints())
  {
    return "it had " + std::to_string(before->GetNumberOfCells()) + " cells and " +
           std::to_string(before->GetNumberOfPoints()) + " points, and has " +
           std::to_string(now->GetNumberOfCells()) + " and " +
           std::to_string(now->GetNumberOfPoints());
  }
  vtkCellArray* const a = before->GetCells();
  vtkCellArray* const b = now->GetCells();
  if (!SameValues(a->GetConnectivityArray(), b->GetConnectivityArray()) ||
      !SameValues(a->GetOffsetsArray(), b->GetOffsetsArray()) ||
      !SameValues(CellTypesOf(before), CellTypesOf(now)))
  {
    return "cells have other points or types";
  }
  if (HasPolyhedra(now) && FacesOfGrid(before) != FacesOfGrid(now))
  {
    return "cells have other faces";
  }
  return {};
}

} // namespace banyan
