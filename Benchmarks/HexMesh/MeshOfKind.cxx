// SPDX-License-Identifier: BSD-3-Clause
#include "MeshOfKind.h"

#include "KeptMesh.h"

#include "Base/Error.h"

#include <cstdint>
#include <filesystem>
#include <functional>

namespace banyan::bench
{
namespace
{

bool IsExodus(const std::string& name)
{
  const std::string end = ".exo";
  return name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
}

/// Where a mesh is kept. A file that is written again has another time.
std::string PlaceOf(const MeshKind& kind, const std::string& folder)
{
  if (folder.empty())
  {
    return {};
  }
  std::string name = kind.Name;
  if (IsExodus(kind.Name))
  {
    std::error_code problem;
    const auto absolute = std::filesystem::absolute(kind.Name, problem).string();
    const auto written = std::filesystem::last_write_time(kind.Name, problem);
    name = "exodus-" + std::to_string(std::hash<std::string>()(absolute)) + "-" +
           std::to_string(written.time_since_epoch().count());
  }
  else
  {
    name += "-" + std::to_string(kind.Cells);
  }
  return (std::filesystem::path(folder) / (name + "-" + std::to_string(kind.Seconds) + ".mesh"))
    .string();
}

} // namespace

BenchMesh MeshOfKind(const MeshKind& kind, const std::string& folder, ThreadPool& pool)
{
  const std::string place = PlaceOf(kind, folder);
  if (IsExodus(kind.Name))
  {
    return KeptMesh(place, [&] { return ExodusMeshAt(kind.Name, kind.Seconds, pool); });
  }
  if (kind.Name == "earthquake")
  {
    return KeptMesh(place, [&] { return EarthquakeMeshAt(kind.Cells, kind.Seconds, pool); });
  }
  if (kind.Cells > 1000)
  {
    throw Error("A mesh has at most 1000 cells across");
  }
  if (kind.Name == "uniform")
  {
    return UniformMesh(kind.Cells, pool); // takes less than reading it
  }
  if (kind.Name != "graded" || (kind.Cells & (kind.Cells - 1)) != 0)
  {
    throw Error("Meshes are uniform, earthquake, or graded with a power of two cells across");
  }
  return KeptMesh(place, [&] { return GradedMesh(kind.Cells, pool); });
}

} // namespace banyan::bench
