// SPDX-License-Identifier: BSD-3-Clause
#include "CellsOutput.h"

#include "SetCells.h"

#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

#include "Mesh/CellSeries/CellsFile.h"
#include "Series/Decode/BetweenSteps.h"
#include "Series/Decode/SeriesFile.h"

#include <cstring>
#include <utility>

namespace banyan
{

void CellsOutput::Forget()
{
  this->Mesh.reset();
  this->Grid = nullptr;
  this->Made[0] = -1;
  this->HasPoints = false;
}

void CellsOutput::Fill(const StepRequest& request, vtkUnstructuredGrid* output)
{
  this->Load(*request.Series);
  if (this->Made[0] != request.Piece || this->Made[1] != request.Pieces)
  {
    this->Made[0] = -1;
    this->HasPoints = false;
    this->MakeCells(request);
    this->Made[0] = request.Piece;
    this->Made[1] = request.Pieces;
  }
  this->MakePoints(request);
  output->ShallowCopy(this->Grid);
}

void CellsOutput::Load(const SeriesFile& series)
{
  if (!this->Mesh)
  {
    this->Mesh = ReadCells(series);
  }
}

namespace
{

/// The faces of polyhedra in a run of cells, with points by their place in a piece.
FaceStreams FacesOf(const StoredCells& mesh, const std::vector<std::int64_t>& place,
  std::size_t first, std::size_t end)
{
  FaceStreams faces;
  std::size_t at = 0;
  for (std::size_t cell = 0; cell < end; ++cell)
  {
    if (mesh.Types[cell] != PolyhedronType)
    {
      continue;
    }
    const std::size_t begin = at;
    const std::int64_t count = mesh.Faces[at++];
    for (std::int64_t face = 0; face < count; ++face)
    {
      at += 1 + static_cast<std::size_t>(mesh.Faces[at]);
    }
    if (cell < first)
    {
      continue;
    }
    std::size_t from = begin;
    faces.push_back(mesh.Faces[from++]);
    while (from < at)
    {
      const std::int64_t corners = mesh.Faces[from++];
      faces.push_back(corners);
      for (std::int64_t i = 0; i < corners; ++i)
      {
        faces.push_back(place[static_cast<std::size_t>(mesh.Faces[from++])]);
      }
    }
  }
  return faces;
}

vtkSmartPointer<vtkUnsignedCharArray> TypesOf(
  const StoredCells& mesh, std::size_t first, std::size_t end)
{
  auto types = vtkSmartPointer<vtkUnsignedCharArray>::New();
  types->SetNumberOfValues(static_cast<vtkIdType>(end - first));
  for (std::size_t cell = first; cell < end; ++cell)
  {
    types->SetValue(static_cast<vtkIdType>(cell - first), mesh.Types[cell]);
  }
  return types;
}

/// A run of cells, with points by their place in a piece.
vtkSmartPointer<vtkCellArray> CellsOf(const StoredCells& mesh,
  const std::vector<std::int64_t>& place, std::size_t first, std::size_t end)
{
  vtkNew<vtkIdTypeArray> offsets, ids;
  offsets->SetNumberOfValues(static_cast<vtkIdType>(end - first) + 1);
  for (std::size_t cell = first; cell <= end; ++cell)
  {
    offsets->SetValue(static_cast<vtkIdType>(cell - first),
      static_cast<vtkIdType>(mesh.Offsets[cell] - mesh.Offsets[first]));
  }
  ids->SetNumberOfValues(static_cast<vtkIdType>(mesh.Offsets[end] - mesh.Offsets[first]));
  for (vtkIdType i = 0; i < ids->GetNumberOfValues(); ++i)
  {
    const std::int64_t point = mesh.Connectivity[static_cast<std::size_t>(mesh.Offsets[first] + i)];
    ids->SetValue(i, static_cast<vtkIdType>(place[static_cast<std::size_t>(point)]));
  }
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, ids);
  return cells;
}

/// Marks the points of faces, too: a face may have one that its cell does not list.
void MarkPoints(
  const StoredCells& mesh, std::size_t first, std::size_t end, std::vector<std::int64_t>& place)
{
  for (std::int64_t i = mesh.Offsets[first]; i < mesh.Offsets[end]; ++i)
  {
    place[static_cast<std::size_t>(mesh.Connectivity[static_cast<std::size_t>(i)])] = 0;
  }
  std::vector<std::int64_t> same(place.size());
  for (std::size_t i = 0; i < same.size() && !mesh.Faces.empty(); ++i)
  {
    same[i] = static_cast<std::int64_t>(i);
  }
  const FaceStreams faces = FacesOf(mesh, same, first, end);
  std::size_t at = 0;
  while (at < faces.size())
  {
    const std::int64_t count = faces[at++];
    for (std::int64_t face = 0; face < count; ++face)
    {
      const std::int64_t corners = faces[at++];
      for (std::int64_t i = 0; i < corners; ++i)
      {
        place[static_cast<std::size_t>(faces[at++])] = 0;
      }
    }
  }
}

} // namespace

void CellsOutput::MakeCells(const StepRequest& request)
{
  const StoredCells& mesh = *this->Mesh;
  const auto count = mesh.CellCount();
  const auto first = static_cast<std::size_t>(count * request.Piece / request.Pieces);
  const auto end = static_cast<std::size_t>(count * (request.Piece + 1) / request.Pieces);
  // Where each point of the mesh is in this piece.
  std::vector<std::int64_t> place(
    static_cast<std::size_t>(mesh.PointCount()), request.Pieces == 1 ? 0 : -1);
  MarkPoints(mesh, first, end, place);
  this->Chosen.clear();
  for (std::size_t point = 0; point < place.size(); ++point)
  {
    if (place[point] == 0)
    {
      place[point] = static_cast<std::int64_t>(this->Chosen.size());
      this->Chosen.push_back(static_cast<std::uint32_t>(point));
    }
  }
  this->ChooseSamples(request.Series->Layout(0), first, end);
  this->Grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  SetCells(this->Grid, TypesOf(mesh, first, end), CellsOf(mesh, place, first, end),
    FacesOf(mesh, place, first, end));
}

/// Finds where the values of the chosen points, and of a run of cells, are.
void CellsOutput::ChooseSamples(const BrickLayout& layout, std::size_t first, std::size_t end)
{
  const StoredCells& mesh = *this->Mesh;
  std::vector<std::uint32_t> samples;
  for (const std::uint32_t point : this->Chosen)
  {
    if (!mesh.SampleOfPoint.empty())
    {
      samples.push_back(mesh.SampleOfPoint[point]);
    }
  }
  this->SamplesOfPoints = ChosenSamples(layout, samples);
  samples.clear();
  if (!mesh.SampleOfCell.empty())
  {
    const auto of = mesh.SampleOfCell.begin();
    samples.assign(of + static_cast<std::ptrdiff_t>(first), of + static_cast<std::ptrdiff_t>(end));
  }
  this->SamplesOfCells = ChosenSamples(layout, samples);
}

/// @param file null: the points of the first step
vtkSmartPointer<vtkPoints> CellsOutput::PointsOf(
  const SeriesFile& series, const PointsFile* file) const
{
  const Bytes moved = file ? ReadMovedPoints(series, *this->Mesh, *file) : Bytes{};
  const Bytes& from = file ? moved : this->Mesh->Points;
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataType(this->Mesh->PointType == ScalarType::Float64 ? VTK_DOUBLE : VTK_FLOAT);
  points->SetNumberOfPoints(static_cast<vtkIdType>(this->Chosen.size()));
  const std::size_t bytes = 3 * SizeOf(this->Mesh->PointType);
  auto* to = static_cast<std::uint8_t*>(points->GetVoidPointer(0));
  for (const std::uint32_t point : this->Chosen)
  {
    std::memcpy(to, from.data() + std::size_t{ point } * bytes, bytes);
    to += bytes;
  }
  return points;
}

void CellsOutput::MakePoints(const StepRequest& request)
{
  const SeriesIndex& index = request.Series->Index();
  const PointsFile* const first = MovedPointsOf(index, request.Step);
  const PointsFile* const next =
    request.Fraction > 0.0 ? MovedPointsOf(index, request.Step + 1) : first;
  // Points that rest stay as they are, bit by bit.
  const double fraction = next == first ? 0.0 : request.Fraction;
  if (this->HasPoints && this->KeptFiles[0] == first && this->KeptFiles[1] == next &&
      this->KeptFraction == fraction)
  {
    return;
  }
  this->HasPoints = false;
  const vtkSmartPointer<vtkPoints> points = this->PointsOf(*request.Series, first);
  if (fraction > 0.0)
  {
    const vtkSmartPointer<vtkPoints> later = this->PointsOf(*request.Series, next);
    BetweenSteps between;
    between.Fraction = fraction;
    between.Interpolate(this->Mesh->PointType, points->GetVoidPointer(0), 1,
      later->GetVoidPointer(0), 3 * points->GetNumberOfPoints());
  }
  // Those who have the grid of the step before keep its points.
  const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->ShallowCopy(this->Grid);
  grid->SetPoints(points);
  this->Grid = grid;
  this->KeptFiles[0] = first;
  this->KeptFiles[1] = next;
  this->KeptFraction = fraction;
  this->HasPoints = true;
}

} // namespace banyan
