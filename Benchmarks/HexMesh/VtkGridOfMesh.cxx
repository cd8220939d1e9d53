// SPDX-License-Identifier: BSD-3-Clause
#include "VtkGridOfMesh.h"

#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnstructuredGrid.h>

namespace banyan::bench
{
namespace
{

constexpr int keep = 1; // the memory is not VTK's

} // namespace

vtkSmartPointer<vtkUnstructuredGrid> VtkGridOf(const BenchMesh& mesh)
{
  vtkNew<vtkFloatArray> coordinates;
  coordinates->SetNumberOfComponents(3);
  coordinates->SetArray(
    const_cast<float*>(mesh.Points.data()), static_cast<vtkIdType>(mesh.Points.size()), keep);
  vtkNew<vtkPoints> points;
  points->SetData(coordinates);
  vtkNew<vtkTypeInt64Array> ids;
  ids->SetArray(reinterpret_cast<vtkTypeInt64*>(const_cast<std::int64_t*>(mesh.Ids.data())),
    static_cast<vtkIdType>(mesh.Ids.size()), keep);
  vtkNew<vtkTypeInt64Array> offsets;
  offsets->SetNumberOfValues(static_cast<vtkIdType>(mesh.Cells()) + 1);
  for (vtkIdType cell = 0; cell < offsets->GetNumberOfValues(); ++cell)
  {
    offsets->SetValue(cell, 8 * cell);
  }
  vtkNew<vtkCellArray> cells;
  cells->SetData(offsets, ids);
  vtkNew<vtkFloatArray> values;
  values->SetName("value");
  values->SetArray(
    const_cast<float*>(mesh.Values.data()), static_cast<vtkIdType>(mesh.Values.size()), keep);
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(points);
  grid->SetCells(mesh.Voxels ? VTK_VOXEL : VTK_HEXAHEDRON, cells);
  grid->GetPointData()->SetScalars(values);
  return grid;
}

} // namespace banyan::bench
