// SPDX-License-Identifier: BSD-3-Clause
#include "RayCastRenderer.h"

namespace banyan::bench
{

RendererList MakeVtkRenderers(int, std::vector<std::string>& missing)
{
  missing = { "vtk-gpu", "vtk-fixed-point" };
  return {};
}

} // namespace banyan::bench
