// SPDX-License-Identifier: BSD-3-Clause
#include "HexMeshRenderer.h"

#include "Base/Error.h"

namespace banyan::bench
{

std::unique_ptr<HexMeshRenderer> MakeVtkHexMeshRenderer(
  const std::string&, const HexMeshScene&, int)
{
  return nullptr;
}

std::unique_ptr<HexMeshRenderer> MakeLocatorHexMeshRenderer(const HexMeshScene&, int)
{
  return nullptr;
}

std::vector<std::string> VtkHexMeshRenderers()
{
  return {};
}

BenchMesh ExodusMeshAt(const std::string& file, double, ThreadPool&)
{
  throw Error("Files of Exodus need VTK, which this program was built without", { file });
}

} // namespace banyan::bench
