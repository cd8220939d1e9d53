// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Series/MeshFile.h"

#include "Base/Error.h"
#include "Base/Hash.h"
#include "Series/Decode/SeriesFile.h"
#include "Series/Encode/SegmentFolder.h"
#include "Series/Format/AtomicFile.h"

namespace banyan
{
namespace
{

std::shared_ptr<const std::vector<std::uint8_t>> Marked(
  const StoredMesh& mesh, const std::vector<std::uint32_t>& samples)
{
  auto marked = std::make_shared<std::vector<std::uint8_t>>(
    static_cast<std::size_t>(mesh.Atlas->SampleCount()));
  for (const std::uint32_t sample : samples)
  {
    (*marked)[sample] = 1;
  }
  return marked;
}

} // namespace

std::shared_ptr<MeshPlan> WriteMesh(const StoredMesh& mesh, SegmentFolder& folder)
{
  const Bytes bytes = MeshToBytes(mesh);
  const Hash128 hash = HashOf(bytes.data(), bytes.size());
  auto plan = std::make_shared<MeshPlan>();
  plan->Index.File = folder.FinalNameOfMesh(hash);
  plan->Index.Bytes = bytes.size();
  plan->Index.HashLow = hash.Low;
  plan->Index.HashHigh = hash.High;
  plan->Index.Points = mesh.PointCount();
  plan->Index.Cells = mesh.CellCount();
  plan->Needed = Marked(mesh, mesh.SampleOfPoint);
  plan->NeededOfCells = Marked(mesh, mesh.SampleOfCell);
  AtomicFile file(folder.Path() + "/" + plan->Index.File);
  file.Append(bytes.data(), bytes.size());
  file.Commit();
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
  const std::string content = ReadWholeFile(path, index.Bytes);
  const Hash128 hash = HashOf(content.data(), content.size());
  if (content.size() != index.Bytes || hash != Hash128{ index.HashLow, index.HashHigh })
  {
    throw Error("The file of the mesh is damaged or not the one that belongs to the series",
      { path, {}, content.size(), index.Bytes });
  }
  try
  {
    const std::shared_ptr<const StoredMesh> mesh =
      MeshFromBytes(Bytes(content.begin(), content.end()));
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
