// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/CellSeries/CellsFile.h"

#include "Base/Error.h"
#include "Base/Hash.h"
#include "Series/Decode/SeriesFile.h"
#include "Series/Encode/SegmentFolder.h"
#include "Series/Format/AtomicFile.h"

#include <algorithm>

namespace banyan
{
namespace
{

std::shared_ptr<const std::vector<std::uint8_t>> Marked(
  const glm::ivec3& size, const std::vector<std::uint32_t>& samples)
{
  auto marked = std::make_shared<std::vector<std::uint8_t>>(static_cast<std::size_t>(size.x) *
                                                            static_cast<std::size_t>(size.y) *
                                                            static_cast<std::size_t>(size.z));
  for (const std::uint32_t sample : samples)
  {
    (*marked)[sample] = 1;
  }
  return marked;
}

void WriteBytes(const Bytes& bytes, const std::string& path)
{
  AtomicFile file(path);
  file.Append(bytes.data(), bytes.size());
  file.Commit();
}

/// A whole file that must be what the index says.
Bytes ReadBytes(const std::string& path, std::uint64_t bytes, const Hash128& hash)
{
  const std::string content = ReadWholeFile(path, bytes);
  if (content.size() != bytes || HashOf(content.data(), content.size()) != hash)
  {
    throw Error("The file of the mesh is damaged or not the one that belongs to the series",
      { path, {}, content.size(), bytes });
  }
  return { content.begin(), content.end() };
}

} // namespace

std::shared_ptr<MeshPlan> WriteCells(const StoredCells& mesh, SegmentFolder& folder)
{
  const Bytes bytes = CellsToBytes(mesh);
  const Hash128 hash = HashOf(bytes.data(), bytes.size());
  auto plan = std::make_shared<MeshPlan>();
  plan->Index.OfCells = true;
  plan->Index.File = folder.FinalNameOfMesh(hash);
  plan->Index.Bytes = bytes.size();
  plan->Index.HashLow = hash.Low;
  plan->Index.HashHigh = hash.High;
  plan->Index.Points = mesh.PointCount();
  plan->Index.Cells = mesh.CellCount();
  plan->Needed = Marked(mesh.Samples(), mesh.SampleOfPoint);
  plan->NeededOfCells = Marked(mesh.Samples(), mesh.SampleOfCell);
  WriteBytes(bytes, folder.Path() + "/" + plan->Index.File);
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
  WriteBytes(bytes, folder.Path() + "/" + file.File);
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
  const Bytes bytes = ReadBytes(path, index.Bytes, { index.HashLow, index.HashHigh });
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
  const Bytes bytes = ReadBytes(path, points.Bytes, { points.HashLow, points.HashHigh });
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
