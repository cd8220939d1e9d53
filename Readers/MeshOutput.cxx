// SPDX-License-Identifier: BSD-3-Clause
#include "MeshOutput.h"

#include "LargeArrays.h"
#include "SeriesInformation.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkHyperTreeGrid.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include "Base/Error.h"
#include "Cache/BrickCache.h"
#include "Mesh/Series/MeanOfLeaves.h"
#include "Mesh/Series/MeshFile.h"
#include "Mesh/Series/MeshLevel.h"
#include "Series/Decode/BetweenSteps.h"
#include "Series/Decode/SeriesFile.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

namespace banyan
{
namespace
{

constexpr unsigned char Voxel = 11; ///< VTK's order of corners is that of leaves

/// Copies the chosen tuples one after the other.
void CopyTuples(
  const void* from, const std::vector<std::uint32_t>& chosen, std::size_t bytes, void* to)
{
  const char* const source = static_cast<const char*>(from);
  char* target = static_cast<char*>(to);
  for (const std::uint32_t tuple : chosen)
  {
    std::memcpy(target, source + std::size_t{ tuple } * bytes, bytes);
    target += bytes;
  }
}

struct MadeArray
{
  int Number; ///< in the series
  vtkSmartPointer<vtkDataArray> Values;
  vtkDataSetAttributes* Attributes; ///< of the output
};

/// To be called when all arrays are in the output: its ghost array may be one of them.
void DescribeRanges(const SeriesFile& series, const std::vector<MadeArray>& made)
{
  for (const MadeArray& array : made)
  {
    auto* const ghosts = vtkUnsignedCharArray::SafeDownCast(
      array.Attributes->GetArray(vtkDataSetAttributes::GhostArrayName()));
    DescribeRange(series, array.Number, ghosts, *array.Values);
  }
}

} // namespace

void MeshOutput::Open(std::shared_ptr<const SeriesFile> series)
{
  this->Series = std::move(series);
  this->Mesh.reset();
  this->Grid = nullptr;
  this->Trees.Forget();
  this->Cells.Forget();
  this->Made[0] = -1;
}

void MeshOutput::Fill(const StepRequest& request, bool readAhead, vtkDataObject* output)
{
  const SeriesIndex& index = request.Series->Index();
  vtkHyperTreeGrid* const trees = vtkHyperTreeGrid::SafeDownCast(output);
  if (trees)
  {
    this->FillTrees(request.Level, request.Piece, request.Pieces, trees);
  }
  else
  {
    this->FillGrid(request, vtkUnstructuredGrid::SafeDownCast(output));
  }
  output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), request.Time);
  vtkBanyanDeferred::Handle handle;
  handle.Series = request.Series;
  handle.Step = request.Step;
  handle.Samples = { glm::ivec3{ 0 }, index.Domain.Samples() };
  this->Ahead.Reading(*request.Series, request.Step);
  std::vector<FieldBricks> bricks;
  std::vector<MadeArray> made;
  const int arrays = static_cast<int>(index.Arrays.size());
  for (handle.Array = 0; handle.Array < arrays; ++handle.Array)
  {
    request.Progress(static_cast<double>(handle.Array) / arrays);
    const ArrayIndex& array = index.Arrays[handle.Array];
    if (!request.Wants(array))
    {
      continue;
    }
    handle.Fraction = AreInterpolated(array.Type) ? request.Fraction : 0.0;
    const int components = static_cast<int>(array.Components.size());
    for (int component = 0; readAhead && component < components; ++component)
    {
      bricks.push_back({ { handle.Step, handle.Array, component, handle.Level },
        this->BricksOf(array, trees != nullptr) });
    }
    const vtkSmartPointer<vtkDataArray> added =
      trees ? this->CellValues(handle) : this->Values(handle);
    vtkDataSetAttributes* const values = output->GetAttributes(
      trees || !array.CellArray.empty() ? vtkDataObject::CELL : vtkDataObject::POINT);
    values->AddArray(added);
    made.push_back({ handle.Array, added, values });
    if (array.Name == index.ActiveScalars)
    {
      values->SetActiveScalars(added->GetName());
    }
  }
  DescribeRanges(*request.Series, made);
  if (readAhead)
  {
    this->Ahead.Read(request.Series, std::move(bricks));
  }
  request.Progress(1.0);
}

void MeshOutput::FillTrees(int level, int piece, int pieces, vtkHyperTreeGrid* output)
{
  if (this->OfCells())
  {
    throw Error("The mesh of the series is no octree, so that it cannot become a hyper tree grid: "
                "switch 'Mesh As Hyper Tree Grid' off");
  }
  this->Load();
  level = std::min(level, this->Mesh->Atlas->CoarsestLevel());
  this->Trees.FillTrees(this->Mesh, level, piece, pieces, output);
}

void MeshOutput::Load()
{
  if (!this->Mesh)
  {
    this->Mesh = ReadMesh(*this->Series);
  }
}

bool MeshOutput::OfCells() const
{
  return this->Series->Index().Mesh->OfCells;
}

int MeshOutput::Levels()
{
  if (this->OfCells())
  {
    return 1;
  }
  this->Load();
  return this->Mesh->Atlas->CoarsestLevel() + 1;
}

/// Cells [first, end) with points by their place in a piece.
/// @param corners of all cells, eight each
static vtkSmartPointer<vtkCellArray> CellsOf(const std::vector<std::int64_t>& corners,
  const std::vector<std::int64_t>& place, std::int64_t first, std::int64_t end)
{
  vtkNew<vtkIdTypeArray> ids;
  ids->SetNumberOfValues(8 * (end - first));
  for (std::int64_t i = 8 * first; i < 8 * end; ++i)
  {
    ids->SetValue(
      i - 8 * first, place[static_cast<std::size_t>(corners[static_cast<std::size_t>(i)])]);
  }
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(8, ids);
  return cells;
}

void MeshOutput::MakeGrid(int level, int piece, int pieces)
{
  const StoredMesh& mesh = *this->Mesh;
  MeshCells coarse;
  if (level > 0)
  {
    coarse = CoarserCells(mesh, level);
  }
  const std::vector<std::int64_t>& corners = level > 0 ? coarse.Connectivity : mesh.Connectivity;
  const auto count = static_cast<std::int64_t>(corners.size() / 8);
  const std::int64_t first = count * piece / pieces;
  const std::int64_t end = count * (piece + 1) / pieces;
  // Where each point of the mesh is in this piece.
  std::vector<std::int64_t> place(
    static_cast<std::size_t>(mesh.PointCount()), level == 0 && pieces == 1 ? 0 : -1);
  for (std::int64_t i = 8 * first; i < 8 * end; ++i)
  {
    place[static_cast<std::size_t>(corners[static_cast<std::size_t>(i)])] = 0;
  }
  std::vector<std::uint32_t> chosen;
  std::vector<std::uint32_t> samples;
  for (std::size_t point = 0; point < place.size(); ++point)
  {
    if (place[point] == 0)
    {
      place[point] = static_cast<std::int64_t>(chosen.size());
      chosen.push_back(static_cast<std::uint32_t>(point));
      samples.push_back(mesh.SampleOfPoint[point]);
    }
  }
  const BrickLayout layout = this->Series->Layout(0);
  this->PointSamples = ChosenSamples(layout, samples);
  this->CellSamples = {};
  if (level == 0)
  {
    const auto of = mesh.SampleOfCell.begin();
    this->CellSamples = ChosenSamples(layout, { of + first, of + end });
  }
  this->Leaves.clear();
  for (std::int64_t cell = first; level > 0 && cell <= end; ++cell)
  {
    this->Leaves.push_back(cell < count ? coarse.FirstLeaf[static_cast<std::size_t>(cell)]
                                        : static_cast<std::uint32_t>(mesh.CellCount()));
  }
  vtkNew<vtkPoints> points;
  points->SetDataType(mesh.PointType == ScalarType::Float64 ? VTK_DOUBLE : VTK_FLOAT);
  points->SetNumberOfPoints(static_cast<vtkIdType>(chosen.size()));
  CopyTuples(mesh.Points.data(), chosen, 3 * SizeOf(mesh.PointType), points->GetVoidPointer(0));
  vtkNew<vtkUnsignedCharArray> types;
  types->SetNumberOfValues(end - first);
  for (std::int64_t cell = first; cell < end; ++cell)
  {
    types->SetValue(
      cell - first, level > 0 ? Voxel : mesh.CellTypes[static_cast<std::size_t>(cell)]);
  }
  this->Grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  this->Grid->SetPoints(points);
  this->Grid->SetCells(types, CellsOf(corners, place, first, end));
}

void MeshOutput::FillGrid(const StepRequest& request, vtkUnstructuredGrid* output)
{
  if (!this->OfCells())
  {
    this->FillOctree(request.Level, request.Piece, request.Pieces, output);
    return;
  }
  this->Cells.Fill(request, output);
  this->PointSamples = this->Cells.PointSamples();
  this->CellSamples = this->Cells.CellSamples();
}

void MeshOutput::FillOctree(int level, int piece, int pieces, vtkUnstructuredGrid* output)
{
  this->Load();
  level = std::min(level, this->Mesh->Atlas->CoarsestLevel());
  if (this->Made[0] != level || this->Made[1] != piece || this->Made[2] != pieces)
  {
    this->Made[0] = -1;
    this->MakeGrid(level, piece, pieces);
    this->Made[0] = level;
    this->Made[1] = piece;
    this->Made[2] = pieces;
  }
  output->ShallowCopy(this->Grid);
}

/// Whether values are made of others than those of single samples.
bool MeshOutput::NeedsImage(const ArrayIndex& array) const
{
  return !array.CellArray.empty() && this->Made[0] > 0;
}

/// Fills a cell array in the cells of a coarser grid.
void MeshOutput::FillCells(const vtkBanyanDeferred::Handle& handle, vtkDataArray* values) const
{
  const StoredMesh& mesh = *this->Mesh;
  const ArrayIndex& array =
    handle.Series->Index().Arrays.at(static_cast<std::size_t>(handle.Array));
  const vtkSmartPointer<vtkDataArray> image = vtkBanyanDeferred::NewPlain(handle);
  const vtkIdType cells = this->Grid->GetNumberOfCells();
  const int components = image->GetNumberOfComponents();
  SetTuples(values, cells);
  Dispatch(array.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const T* const from = static_cast<const T*>(image->GetVoidPointer(0));
      T* const to = static_cast<T*>(values->GetVoidPointer(0));
      for (int c = 0; c < components; ++c)
      {
        const FillSet<T> fills(array.Components.at(static_cast<std::size_t>(c)).FillValues);
        for (vtkIdType cell = 0; cell < cells; ++cell)
        {
          const auto at = static_cast<std::size_t>(cell);
          to[cell * components + c] = MeanOfLeaves<T>(
            mesh, from, components, c, this->Leaves[at], this->Leaves[at + 1], fills);
        }
      }
    });
}

vtkSmartPointer<vtkDataArray> MeshOutput::Values(const vtkBanyanDeferred::Handle& handle) const
{
  const ArrayIndex& array =
    handle.Series->Index().Arrays.at(static_cast<std::size_t>(handle.Array));
  vtkSmartPointer<vtkDataArray> values = vtkBanyanDeferred::NewEmpty(handle);
  const bool ofCells = !array.CellArray.empty();
  if (ofCells)
  {
    values->SetName(array.CellArray.c_str());
  }
  if (this->NeedsImage(array))
  {
    this->FillCells(handle, values);
    return values;
  }
  const ChosenSamples& samples = ofCells ? this->CellSamples : this->PointSamples;
  SetTuples(values, samples.Count());
  const int components = values->GetNumberOfComponents();
  for (int component = 0; component < components; ++component)
  {
    ReadBetween(*handle.Series, { handle.Step, handle.Array, component, handle.Level },
      handle.Fraction, samples.Count(), values->GetVoidPointer(0), components, component,
      [&](const FieldKey& field, void* to, int stride, int at)
      { samples.Read(BrickCache::Of(*handle.Series), *handle.Series, field, to, stride, at); });
  }
  return values;
}

std::vector<std::int64_t> MeshOutput::BricksOf(const ArrayIndex& array, bool trees) const
{
  if (!trees && !this->NeedsImage(array))
  {
    return (array.CellArray.empty() ? this->PointSamples : this->CellSamples).Bricks();
  }
  std::vector<std::int64_t> all(static_cast<std::size_t>(this->Series->Layout(0).BrickCount()));
  std::iota(all.begin(), all.end(), std::int64_t{ 0 });
  return all;
}

} // namespace banyan
