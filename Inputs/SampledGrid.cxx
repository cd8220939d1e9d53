// SPDX-License-Identifier: BSD-3-Clause
#include "SampledGrid.h"

#include "ArrayLength.h"
#include "HexMeshOfGrid.h"
#include "MeshArrays.h"
#include "PieceValues.h"
#include "VoxelCells.h"

#include "Base/ThreadPool.h"
#include "Mesh/Sampling/CellMeans.h"
#include "Mesh/Sampling/OneNumberPerPlace.h"

#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkPointData.h"

#include <cstring>
#include <optional>

namespace banyan
{
namespace
{

bool IsSampled(vtkDataSetAttributes* attributes, vtkDataArray* array)
{
  return array && array->GetName() && array->GetDataType() != VTK_BIT &&
         !IsNoValue(attributes, array);
}

void Copy(const SampledMesh::Values& from, int component, vtkDataArray* to)
{
  for (vtkIdType point = 0; point < to->GetNumberOfTuples(); ++point)
  {
    const auto i = static_cast<std::size_t>(point);
    to->SetComponent(
      point, component, from.Floats.empty() ? from.Doubles[i] : double{ from.Floats[i] });
  }
}

} // namespace

void SampledGrid::Find(const HexMesh& mesh, const MeshSampling& sampling)
{
  const auto points = static_cast<std::size_t>(mesh.PointCount) * 3 * SizeOf(mesh.PointType);
  const auto corners = static_cast<std::size_t>(mesh.CellCount) * 8 * SizeOf(mesh.IdType);
  const Hash128 pointHash = HashOf(mesh.Points, points);
  const Hash128 cellHash = HashOf(mesh.Connectivity, corners);
  if (this->Sampled && pointHash == this->PointHash && cellHash == this->CellHash &&
      sampling == this->Sampling)
  {
    return;
  }
  this->Sampled.reset();
  const HexMesh one = OneNumberPerPlace(mesh, ThreadPool::Process());
  this->Sampled = SampledMesh::Of(one, sampling, ThreadPool::Process());
  this->Renumbered = HexMesh{};
  if (one.Connectivity != mesh.Connectivity)
  {
    this->Renumbered = one;
    this->Renumbered.Points = nullptr;
    this->Renumbered.PointOwner.reset();
  }
  this->PointHash = pointHash;
  this->CellHash = cellHash;
  this->Sampling = sampling;
  this->Sampling.Watch = nullptr; // may not live as long
  const HexMesh& boxes = this->Sampled->Boxes();
  vtkNew<vtkPoints> places;
  places->SetDataType(VTK_DOUBLE);
  places->SetNumberOfPoints(boxes.PointCount);
  std::memcpy(places->GetVoidPointer(0), boxes.Points,
    static_cast<std::size_t>(boxes.PointCount) * 3 * sizeof(double));
  VoxelCells voxels;
  DispatchMesh(boxes,
    [&](const auto*, const auto* ids)
    {
      for (std::int64_t box = 0; box < boxes.CellCount; ++box)
      {
        vtkIdType own[8];
        std::copy(ids + 8 * box, ids + 8 * box + 8, own);
        voxels.Add(own);
      }
    });
  this->Boxes = vtkSmartPointer<vtkUnstructuredGrid>::New();
  voxels.Finish(this->Boxes, places);
}

void SampledGrid::AddArrays(
  vtkUnstructuredGrid* grid, int where, const HexMesh& mesh, vtkDataSetAttributes* to) const
{
  ThreadPool& pool = ThreadPool::Process();
  vtkDataSetAttributes* const from = grid->GetAttributes(where);
  for (int i = 0; i < from->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* const array = from->GetArray(i);
    if (!IsSampled(from, array) || to->HasArray(array->GetName()))
    {
      continue;
    }
    CheckLength(array, where, grid->GetNumberOfElements(where));
    const bool cells = where == vtkDataObject::CELL;
    vtkSmartPointer<vtkDataArray> values = array;
    if (cells)
    {
      values = ValuesOfCells(grid, array);
    }
    NodeArray nodes;
    nodes.Values = values->GetVoidPointer(0);
    nodes.Type = TypeOf(values);
    nodes.Components = values->GetNumberOfComponents();
    const auto sampled = vtkSmartPointer<vtkDataArray>::Take(
      vtkDataArray::CreateDataArray(FitsFloat(nodes.Type) ? VTK_FLOAT : VTK_DOUBLE));
    sampled->SetName(array->GetName());
    sampled->SetNumberOfComponents(nodes.Components);
    sampled->CopyComponentNames(array);
    sampled->SetNumberOfTuples(this->Boxes->GetNumberOfPoints());
    for (nodes.Component = 0; nodes.Component < nodes.Components; ++nodes.Component)
    {
      std::optional<CellMeans> means;
      if (cells)
      {
        means.emplace(this->Renumbered.CellCount > 0 ? this->Renumbered : mesh, nodes);
      }
      Copy(this->Sampled->Sample(means ? means->Nodes() : nodes, pool), nodes.Component, sampled);
    }
    to->AddArray(sampled);
  }
}

vtkSmartPointer<vtkUnstructuredGrid> SampledGrid::Of(
  vtkUnstructuredGrid* grid, const MeshSampling& sampling)
{
  OtherCells others;
  const HexMesh mesh = HexMeshOf(grid, &others);
  this->NoteText.clear();
  if (others.Count > 0)
  {
    this->NoteText = "Only hexahedra and voxels are sampled, without " + others.Text() + ". ";
  }
  if (mesh.CellCount == 0)
  {
    throw Error("The mesh has no hexahedra or voxels");
  }
  this->Find(mesh, sampling);
  if (this->Sampled->TangledCells() > 0)
  {
    this->NoteText += std::to_string(this->Sampled->TangledCells()) +
                      " hexahedra are turned inside out at a corner, cell " +
                      std::to_string(this->Sampled->FirstTangledCell()) +
                      " first: values in them mean little. ";
  }
  if (this->Sampled->KeptCoarse() > 0)
  {
    this->NoteText += std::to_string(this->Sampled->KeptCoarse()) + " of " +
                      std::to_string(this->Boxes->GetNumberOfCells()) +
                      " boxes are coarser than they should be: allow more boxes, 'Mesh Sampling "
                      "Boxes' (MeshSamplingBoxes). ";
  }
  const auto output = vtkSmartPointer<vtkUnstructuredGrid>::New();
  output->CopyStructure(this->Boxes);
  this->AddArrays(grid, vtkDataObject::POINT, mesh, output->GetPointData());
  this->AddArrays(grid, vtkDataObject::CELL, mesh, output->GetPointData());
  vtkDataArray* const active = grid->GetPointData()->GetScalars();
  if (active && active->GetName())
  {
    output->GetPointData()->SetActiveScalars(active->GetName());
  }
  return output;
}

} // namespace banyan
