#include "HexMeshRenderer.h"

namespace banyan::bench
{

std::unique_ptr<HexMeshRenderer> MakeVtkHexMeshRenderer(
  const std::string&, const HexMeshScene&, int)
{
  return nullptr;
}

std::vector<std::string> VtkHexMeshRenderers()
{
  return {};
}

} // namespace banyan::bench
