// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_LevelEdges_h
#define banyan_Render_Scene_LevelEdges_h

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cstdint>

namespace banyan
{

/// How long the cells of each level are along each axis, in cells of the finest level.
class LevelEdges
{
public:
  /// 2^level along all axes, as in encoded series.
  LevelEdges() = default;

  /// Flat grids keep their short axes: from a level to the next one, an axis is halved if it is
  /// longer than half of the longest one. So coarse levels of any grid are about as long along all
  /// axes. Plain data has such levels.
  /// @param cells of the finest level
  static LevelEdges Following(const glm::ivec3& cells)
  {
    const std::int64_t longest = std::max({ 1, cells.x, cells.y, cells.z });
    LevelEdges edges;
    for (int axis = 0; axis < 3; ++axis)
    {
      while ((std::int64_t{ std::max(1, cells[axis]) } << (edges.Rests[axis] + 1)) <= longest)
      {
        ++edges.Rests[axis];
      }
    }
    return edges;
  }

  /// 1 at all levels, as those of meshes: positions count in cells of the finest level everywhere.
  static LevelEdges Finest()
  {
    LevelEdges edges;
    edges.Rests = glm::ivec3(Never);
    return edges;
  }

  /// @param level in [0, 30]
  glm::ivec3 At(int level) const
  {
    const glm::ivec3 halvings = glm::max(level - this->Rests, 0);
    return { 1 << halvings.x, 1 << halvings.y, 1 << halvings.z };
  }

  /// Whether cells have one length at all levels.
  bool AreFinest() const { return this->Rests == glm::ivec3(Never); }

private:
  static constexpr int Never = 31;

  glm::ivec3 Rests{ 0 }; ///< the first levels, at which an axis is not halved
};

} // namespace banyan

#endif
