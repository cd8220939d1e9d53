// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_SceneDigest_h
#define banyan_Render_Scene_SceneDigest_h

#include "Base/Hash.h"
#include "Render/Scene/RayScene.h"

namespace banyan
{

/// A hash of all that decides a picture except the values and how finely they are sampled: scenes
/// with equal ones show the same.
Hash128 DigestOf(const RayScene& scene);

/// The same without the colours and opacities of the transfer function's entries.
Hash128 DigestWithoutEntries(const RayScene& scene);

} // namespace banyan

#endif
