// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_VisibleContent_h
#define banyan_Render_Bricks_VisibleContent_h

#include "Base/Hash.h"
#include "Render/Bricks/BrickSource.h"
#include "Render/Scene/RayScene.h"

#include <vector>

namespace banyan
{

/// Per level, a hash of what a scene may show of a source, wherever the camera is: of the samples
/// that decide pictures, and of what is hidden. Of equal scenes with equal samplings, sources with
/// equal ones at the levels of these samplings have the same pictures.
/// @param source of the finest level
/// @param coarsest level that pictures are drawn from; fewer where there are not so many
/// @return none where the source does not know what its bricks hold (BrickSource::ContentOf)
std::vector<Hash128> VisibleContent(const RayScene& scene, BrickSource& source, int coarsest);

} // namespace banyan

#endif
