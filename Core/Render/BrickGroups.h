#ifndef banyan_Render_BrickGroups_h
#define banyan_Render_BrickGroups_h

#include "Base/Box.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace banyan
{

class BrickSource;

/// Small bricks side by side, which are drawn as one brick where all of them can be seen. Bricks of
/// 16^3 are good units to store, to decode and to leave out; packets of rays want bricks of 32^3:
/// of one half as long they take few samples for what entering it costs. No bit of a picture
/// depends on it.
class BrickGroups
{
public:
  /// Cells per axis of bricks that are put together, two along each axis.
  static constexpr int LargestMember = 16;

  /// @param source must stay
  /// @param may whether bricks are cut by whole planes and may be put together; otherwise each is a
  /// group of its own
  BrickGroups(const BrickSource& source, bool may);

  std::int64_t Count() const;
  /// Positions of a group's bricks in the grid of bricks.
  Box BricksOf(std::int64_t group) const;
  /// The number of a brick.
  std::int64_t BrickAt(const glm::ivec3& position) const;
  /// The cells of some bricks together.
  Box CellsOf(const Box& bricks) const;

private:
  const BrickSource& Source;
  glm::ivec3 Bricks;
  int Edge = 1; ///< bricks per axis
  glm::ivec3 Counts{ 0 };
};

/// Calls function(number, place) for the bricks of a group: place counts them from 0 to 7.
template <class Function>
void ForMembers(const BrickGroups& groups, const Box& bricks, Function&& function)
{
  for (int z = bricks.Lo.z; z < bricks.Hi.z; ++z)
  {
    for (int y = bricks.Lo.y; y < bricks.Hi.y; ++y)
    {
      for (int x = bricks.Lo.x; x < bricks.Hi.x; ++x)
      {
        const glm::ivec3 in = glm::ivec3(x, y, z) - bricks.Lo;
        function(groups.BrickAt({ x, y, z }), in.x + 2 * in.y + 4 * in.z);
      }
    }
  }
}

/// What is known of a group's bricks whatever the camera, a bit per place.
struct GroupMembers
{
  std::uint8_t There = 0;
  std::uint8_t Visible = 0; ///< some value can be seen
  std::uint8_t Uniform = 0; ///< visible, and of one value: not loaded where nothing is shaded
};

using GroupList = std::shared_ptr<const std::vector<GroupMembers>>;

} // namespace banyan

#endif
