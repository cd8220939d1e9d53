// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/CellSeries/CellsFile.h"

#include "Base/Error.h"
#include "Base/Hash.h"
#include "Mesh/Series/MeshFile.h"
#include "Series/Decode/SeriesFile.h"
#include "Series/Encode/SegmentFolder.h"

#include <algorithm>

namespace banyan
{
std::shared_ptr<MeshPlan> WriteCells(const StoredCells& mesh, SegmentFolder& folder)
{
  std::shared_ptr<MeshPlan> plan = mesh_file::WriteFile(CellsToBytes(mesh), folder);
  const auto samples = static_cast<std::size_t>(GridOfImages(mesh).Extent.Count());
  plan->Index.OfCells = true;
  plan->Index.Points = mesh.PointCount();
  plan->Index.Cells = mesh.CellCount();
  plan->Needed = mesh_file::Marked(samples, mesh.SampleOfPoint);
  plan->NeededOfCells = mesh_file::Marked(samples, mesh.SampleOfCell);
  return plan;
}

PointsFile WriteMovedPoints(
  const StoredCells& mesh, const std::uint8_t* points, int step, SegmentFolder& folder)
{
  const Bytes bytes = MovedPointsToBytes(mesh, points);
  const Hash128 hash = HashOf(bytes.data(), bytes.size());
  PointsFile file;
  file.File = folder.PlaceOfPoints().NameOf(hash);
  file.FirstStep = step;
  file.Bytes = bytes.size();
  file.HashLow = hash.Low;
  file.HashHigh = hash.High;
  mesh_file::WriteFile(bytes, folder.Path() + "/" + file.File);
  return file;
}

Grid GridOfImages(const StoredCells& mesh)
{
  Grid grid;
  grid.Extent = { glm::ivec3{ 0 }, mesh.Samples() };
  return grid;
}

std::shared_ptr<const StoredCells> ReadCells(const SeriesFile& series)
{
  if (!series.Index().Mesh || !series.Index().Mesh->OfCells)
  {
    throw Error("The series holds no mesh of cells of any type", { series.Path() });
  }
  const MeshIndex& index = *series.Index().Mesh;
  const std::string path = series.Folder() + "/" + index.File;
  const Bytes bytes = mesh_file::ReadFile(path, index.Bytes, { index.HashLow, index.HashHigh });
  try
  {
    std::shared_ptr<const StoredCells> mesh = CellsFromBytes(bytes);
    const auto& arrays = series.Index().Arrays;
    const bool ofCells = std::any_of(
      arrays.begin(), arrays.end(), [](const ArrayIndex& one) { return !one.CellArray.empty(); });
    const bool ofPoints = std::any_of(
      arrays.begin(), arrays.end(), [](const ArrayIndex& one) { return one.CellArray.empty(); });
    if (mesh->PointCount() != index.Points || mesh->CellCount() != index.Cells ||
        mesh->Samples() != series.Index().Domain.Samples() ||
        (ofPoints && mesh->SampleOfPoint.empty()) || (ofCells && mesh->SampleOfCell.empty()))
    {
      throw Error("The mesh is not of the size that the index says");
    }
    return mesh;
  }
  catch (const Error& error)
  {
    throw Error(error.what(), { path });
  }
}

const PointsFile* MovedPointsOf(const SeriesIndex& index, int step)
{
  const PointsFile* found = nullptr;
  if (index.Mesh)
  {
    for (const PointsFile& file : index.Mesh->Moved)
    {
      found = file.FirstStep <= step ? &file : found;
    }
  }
  return found;
}

Bytes ReadMovedPoints(const SeriesFile& series, const StoredCells& mesh, const PointsFile& points)
{
  const std::string path = series.Folder() + "/" + points.File;
  const Bytes bytes = mesh_file::ReadFile(path, points.Bytes, { points.HashLow, points.HashHigh });
  try
  {
    return MovedPointsFromBytes(mesh, bytes);
  }
  catch (const Error& error)
  {
    throw Error(error.what(), { path });
  }
}

} // namespace banyan
