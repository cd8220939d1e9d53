// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_ViewPrefetcher_h
#define banyan_Render_Bricks_ViewPrefetcher_h

#include "Cache/BackgroundDecoder.h"
#include "Render/Bricks/BrickSource.h"
#include "Render/Scene/RayScene.h"

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace banyan
{

class SeriesBrickSource;

/// Which bricks of an encoded series the next picture needs that this one did not: while a camera
/// moves, those that come onto the screen. The camera is expected to go on as it went from the
/// picture before to this one: round the volume, past it, nearer or away.
///
/// @par Limits: bricks that were hidden behind others, and levels that this picture did not have,
/// are not expected.
class ViewPrefetcher
{
public:
  /// After a picture of at least two.
  /// @param source of the finest level
  /// @param cells that this rank draws
  /// @return nothing when the camera rests, and after the first picture or one of another size
  std::vector<FieldBricks> Expected(
    const RayScene& scene, SeriesBrickSource& source, const Box& cells);

private:
  std::optional<glm::dmat4> Before; ///< from clip space to the index space, of the picture before
  glm::ivec2 PictureSize{ 0 };      ///< of it
};

/// A scene in the cells of a coarser level.
RayScene InCellsOf(RayScene scene, int level);

/// The scene as its camera is expected to see it next, all of the picture; nothing where that is no
/// camera.
/// @param before from clip space to the index space of the scene, of the picture before
std::optional<RayScene> SceneAfter(const RayScene& scene, const glm::dmat4& before);

/// Bricks with cells in `cells` that have something to see, may lie on the screen of `next`, and
/// surely did not on that of `scene`. Takes as long as there are bricks along the edges of the
/// screen.
/// @param scene, next in the index space of the source
std::vector<std::int64_t> BricksComingOntoScreen(
  const RayScene& scene, const RayScene& next, const BrickSource& source, const Box& cells);

} // namespace banyan

#endif
