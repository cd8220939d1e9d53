// SPDX-License-Identifier: BSD-3-Clause
// Volumes of cells as CellMesh gives them, and as VTK measures them.
#ifndef banyan_Testing_MeshVolume_h
#define banyan_Testing_MeshVolume_h

#include "Cells/CellMesh.h"

#include "vtkCellData.h"
#include "vtkCellSizeFilter.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkNew.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>

namespace banyan::testing
{

/// Of a cell, by what flows through its faces: negative where they look inwards. Exact for faces of
/// four corners, too: the integrand is quadratic along both sides, and two places of Gauss are
/// enough.
inline double VolumeOf(const CellMesh& mesh, const MeshCell& cell)
{
  const CellFaces& faces = FacesOf(cell.Shape);
  double flow = 0.0;
  for (int f = 0; f < faces.Count; ++f)
  {
    const CellFace& face = faces.Faces[static_cast<std::size_t>(f)];
    const auto corner = [&](int i)
    {
      const int local = face.Corners[static_cast<std::size_t>(i)];
      return mesh.Point(cell.Points[static_cast<std::size_t>(local)]);
    };
    const glm::dvec3 a = corner(0);
    const glm::dvec3 b = corner(1);
    const glm::dvec3 c = corner(2);
    if (face.Count == 3)
    {
      flow += glm::dot(a, glm::cross(b - a, c - a)) / 2.0;
      continue;
    }
    const glm::dvec3 d = corner(3);
    for (const double u : { 0.5 - std::sqrt(1.0 / 12.0), 0.5 + std::sqrt(1.0 / 12.0) })
    {
      for (const double v : { 0.5 - std::sqrt(1.0 / 12.0), 0.5 + std::sqrt(1.0 / 12.0) })
      {
        const glm::dvec3 at = (1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * d + u * c);
        const glm::dvec3 alongU = (1 - v) * (b - a) + v * (c - d);
        const glm::dvec3 alongV = (1 - u) * (d - a) + u * (c - b);
        flow += glm::dot(at, glm::cross(alongU, alongV)) / 4.0;
      }
    }
  }
  return flow / 3.0;
}

struct Volumes
{
  double Sum = 0.0;
  double Least = HUGE_VAL;
  int Count = 0; ///< of cells that are drawn
};

inline Volumes VolumesOf(const CellMesh& mesh)
{
  Volumes volumes;
  for (std::int64_t i = 0; i < mesh.CellCount; ++i)
  {
    const MeshCell cell = mesh.Cell(i);
    if (cell.Shape != CellShape::None)
    {
      const double volume = VolumeOf(mesh, cell);
      volumes.Sum += volume;
      volumes.Least = std::fmin(volumes.Least, volume);
      ++volumes.Count;
    }
  }
  return volumes;
}

/// VTK's own: of all cells, hidden or not.
inline double VolumeByVtk(vtkDataSet* data)
{
  vtkNew<vtkCellSizeFilter> filter;
  filter->SetInputData(data);
  filter->Update();
  vtkDataArray* const volumes =
    vtkDataSet::SafeDownCast(filter->GetOutput())->GetCellData()->GetArray("Volume");
  double sum = 0.0;
  for (vtkIdType cell = 0; cell < volumes->GetNumberOfTuples(); ++cell)
  {
    sum += volumes->GetTuple1(cell);
  }
  return sum;
}

} // namespace banyan::testing

#endif
