// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_BrickGroups_h
#define banyan_Render_Bricks_BrickGroups_h

#include "Base/Box.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace banyan
{

class BrickSource;

/// Small bricks side by side, which are drawn as one brick where all of them can be seen. Bricks of
/// 16^3 are good units to store, to decode and to leave out; packets of rays want bricks of 32^3,
/// and in large volumes of 64^3: of smaller ones they take few samples for what entering each
/// costs. No bit of a picture depends on it.
class BrickGroups
{
public:
  /// Cells per axis of a group, and of one in a large volume.
  static constexpr int Cells = 32;
  static constexpr int CellsOfLarge = 64;

  /// @param source must stay
  /// @param cells per axis that a group has at most; 0 where bricks are not cut by whole planes and
  /// may not be put together: each is a group of its own then
  BrickGroups(const BrickSource& source, int cells);

  /// Bricks per axis: 1, 2 or 4.
  int BricksPerAxis() const { return this->Edge; }
  std::int64_t Count() const;
  /// Positions of a group's bricks in the grid of bricks.
  Box BricksOf(std::int64_t group) const;
  /// The number of a brick.
  std::int64_t BrickAt(const glm::ivec3& position) const;
  /// The cells of some bricks together.
  Box CellsOf(const Box& bricks) const;
  /// A brick's place in its group, of 64 or fewer.
  int PlaceOf(const glm::ivec3& position) const
  {
    const glm::ivec3 in = position % this->Edge;
    return in.x + this->Edge * (in.y + this->Edge * in.z);
  }

private:
  const BrickSource& Source;
  glm::ivec3 Bricks;
  int Edge = 1; ///< bricks per axis
  glm::ivec3 Counts{ 0 };
};

/// Calls function(number, place) for bricks of a group.
template <class Function>
void ForMembers(const BrickGroups& groups, const Box& bricks, Function&& function)
{
  for (int z = bricks.Lo.z; z < bricks.Hi.z; ++z)
  {
    for (int y = bricks.Lo.y; y < bricks.Hi.y; ++y)
    {
      for (int x = bricks.Lo.x; x < bricks.Hi.x; ++x)
      {
        function(groups.BrickAt({ x, y, z }), groups.PlaceOf({ x, y, z }));
      }
    }
  }
}

/// What is known of a group's bricks whatever the camera, a bit per place.
struct GroupMembers
{
  std::uint64_t There = 0;
  std::uint64_t Visible = 0; ///< some value can be seen
  std::uint64_t Uniform = 0; ///< visible, and of one value: not loaded where nothing is shaded

  /// Of some bricks of the group alone.
  /// @param places of these
  GroupMembers Of(std::uint64_t places) const
  {
    return { this->There & places, this->Visible & places, this->Uniform & places };
  }
};

using GroupList = std::shared_ptr<const std::vector<GroupMembers>>;

} // namespace banyan

#endif
