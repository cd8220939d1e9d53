// SPDX-License-Identifier: BSD-3-Clause
#include "BenchMesh.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Mesh/Octree/ElementOctree.h"

#include <vtkCellArray.h>
#include <vtkCompositeDataIterator.h>
#include <vtkDataArray.h>
#include <vtkExodusIIReader.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnstructuredGrid.h>

#include <glm/common.hpp>

#include <cmath>

namespace banyan::bench
{
namespace
{

constexpr const char* Drawn = "velocity";

/// The first block of a file, at the step that is nearest to a time.
vtkSmartPointer<vtkUnstructuredGrid> BlockAt(const std::string& file, double seconds)
{
  vtkNew<vtkExodusIIReader> reader;
  reader->SetFileName(file.c_str());
  reader->ApplyDisplacementsOff();
  reader->SetSqueezePoints(false); // there is one block, and this takes long
  reader->UpdateInformation();
  reader->SetAllArrayStatus(vtkExodusIIReader::NODAL, 0);
  reader->SetPointResultArrayStatus(Drawn, 1);
  vtkInformation* const information = reader->GetOutputInformation(0);
  const auto key = vtkStreamingDemandDrivenPipeline::TIME_STEPS();
  double nearest = seconds;
  for (int i = 0; information->Has(key) && i < information->Length(key); ++i)
  {
    const double time = information->Get(key)[i];
    nearest = i == 0 || std::abs(time - seconds) < std::abs(nearest - seconds) ? time : nearest;
  }
  reader->UpdateTimeStep(nearest);
  const vtkSmartPointer<vtkCompositeDataIterator> blocks =
    vtkSmartPointer<vtkCompositeDataIterator>::Take(reader->GetOutput()->NewIterator());
  for (blocks->InitTraversal(); !blocks->IsDoneWithTraversal(); blocks->GoToNextItem())
  {
    if (auto* const grid = vtkUnstructuredGrid::SafeDownCast(blocks->GetCurrentDataObject()))
    {
      return grid;
    }
  }
  throw Error("The file has no block of cells", { file });
}

} // namespace

BenchMesh ExodusMeshAt(const std::string& file, double seconds, ThreadPool& pool)
{
  const vtkSmartPointer<vtkUnstructuredGrid> grid = BlockAt(file, seconds);
  vtkDataArray* const velocity = grid->GetPointData()->GetArray(Drawn);
  if (!velocity)
  {
    throw Error(std::string("The mesh has no array '") + Drawn + "' at its points", { file });
  }
  BenchMesh mesh;
  std::vector<double> places;
  for (vtkIdType point = 0; point < grid->GetNumberOfPoints(); ++point)
  {
    const double* const place = grid->GetPoint(point);
    places.insert(places.end(), place, place + 3);
    double sum = 0.0;
    for (int i = 0; i < velocity->GetNumberOfComponents(); ++i)
    {
      const double part = velocity->GetComponent(point, i);
      sum += part * part;
    }
    mesh.Values.push_back(static_cast<float>(std::sqrt(sum)));
  }
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    grid->GetCellPoints(cell, corners);
    if (corners->GetNumberOfIds() != 8)
    {
      throw Error("The mesh has cells that are no hexahedra", { file });
    }
    mesh.Ids.insert(mesh.Ids.end(), corners->begin(), corners->end());
  }
  HexMesh input;
  input.Points = places.data();
  input.PointType = ScalarType::Float64;
  input.PointCount = static_cast<std::int64_t>(mesh.Values.size());
  input.Connectivity = mesh.Ids.data();
  input.CellCount = static_cast<std::int64_t>(mesh.Cells());
  const auto tree = ElementOctree::Find(input, pool);
  const glm::dvec3 first = tree->Origin() + glm::dvec3(tree->Domain().Lo) * tree->Edge();
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    const int axis = static_cast<int>(i % 3);
    mesh.Points.push_back(
      static_cast<float>(std::round((places[i] - first[axis]) / tree->Edge()[axis])));
  }
  return mesh;
}

} // namespace banyan::bench
