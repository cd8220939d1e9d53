// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Series/MeshFile.h"

#include "Base/Error.h"
#include "Series/Decode/SeriesFile.h"
#include "Series/Encode/SegmentFolder.h"
#include "Series/Format/AtomicFile.h"

namespace banyan
{
namespace mesh_file
{

std::shared_ptr<MeshPlan> WriteFile(const Bytes& bytes, SegmentFolder& folder)
{
  const Hash128 hash = HashOf(bytes.data(), bytes.size());
  auto plan = std::make_shared<MeshPlan>();
  plan->Index.File = folder.FinalNameOfMesh(hash);
  plan->Index.Bytes = bytes.size();
  plan->Index.HashLow = hash.Low;
  plan->Index.HashHigh = hash.High;
  WriteFile(bytes, folder.Path() + "/" + plan->Index.File);
  return plan;
}

void WriteFile(const Bytes& bytes, const std::string& path)
{
  AtomicFile file(path);
  file.Append(bytes.data(), bytes.size());
  file.Commit();
}

Bytes ReadFile(const std::string& path, std::uint64_t bytes, const Hash128& hash)
{
  const std::string content = ReadWholeFile(path, bytes);
  if (content.size() != bytes || HashOf(content.data(), content.size()) != hash)
  {
    throw Error("The file of the mesh is damaged or not the one that belongs to the series",
      { path, {}, content.size(), bytes });
  }
  return { content.begin(), content.end() };
}

std::shared_ptr<const std::vector<std::uint8_t>> Marked(
  std::size_t count, const std::vector<std::uint32_t>& samples)
{
  auto marked = std::make_shared<std::vector<std::uint8_t>>(count);
  for (const std::uint32_t sample : samples)
  {
    (*marked)[sample] = 1;
  }
  return marked;
}

} // namespace mesh_file

std::shared_ptr<MeshPlan> WriteMesh(const StoredMesh& mesh, SegmentFolder& folder)
{
  std::shared_ptr<MeshPlan> plan = mesh_file::WriteFile(MeshToBytes(mesh), folder);
  const auto samples = static_cast<std::size_t>(mesh.Atlas->SampleCount());
  plan->Index.Points = mesh.PointCount();
  plan->Index.Cells = mesh.CellCount();
  plan->Needed = mesh_file::Marked(samples, mesh.SampleOfPoint);
  plan->NeededOfCells = mesh_file::Marked(samples, mesh.SampleOfCell);
  return plan;
}

Grid GridOfImages(const StoredMesh& mesh)
{
  Grid grid;
  grid.Extent = { glm::ivec3{ 0 }, mesh.Atlas->Samples() };
  return grid;
}

std::shared_ptr<const StoredMesh> ReadMesh(const SeriesFile& series)
{
  if (!series.Index().Mesh || series.Index().Mesh->OfCells)
  {
    throw Error(series.Index().Mesh ? "The series holds a mesh of cells of any type, not an octree"
                                    : "The series holds image data, not a mesh",
      { series.Path() });
  }
  const MeshIndex& index = *series.Index().Mesh;
  const std::string path = series.Folder() + "/" + index.File;
  const Bytes bytes = mesh_file::ReadFile(path, index.Bytes, { index.HashLow, index.HashHigh });
  try
  {
    std::shared_ptr<const StoredMesh> mesh = MeshFromBytes(bytes);
    if (mesh->PointCount() != index.Points || mesh->CellCount() != index.Cells ||
        mesh->Atlas->Samples() != series.Index().Domain.Samples())
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

} // namespace banyan
