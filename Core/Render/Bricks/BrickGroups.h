// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_BrickGroups_h
#define banyan_Render_Bricks_BrickGroups_h

#include "Base/Box.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
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

  /// @param cells per axis that a group has at most; 0 where bricks are not cut by whole planes and
  /// may not be put together: each is a group of its own then
  BrickGroups(const BrickSource& source, int cells);

  /// Bricks per axis: 1, 2 or 4.
  int BricksPerAxis() const { return this->Edge; }
  std::int64_t Count() const;
  /// Positions of a group's bricks in the grid of bricks.
  Box BricksOf(std::int64_t group) const;
  /// The number of the group that some bricks are in.
  std::int64_t NumberOf(const Box& bricks) const;
  /// The number of a brick.
  std::int64_t BrickAt(const glm::ivec3& position) const;
  /// Places of bricks in their group, a bit each.
  /// @param bricks of one group
  std::uint64_t PlacesOf(const Box& bricks) const;
  /// A brick's place in its group, of 64 or fewer.
  int PlaceOf(const glm::ivec3& position) const
  {
    const glm::ivec3 in = position & (this->Edge - 1);
    return in.x + this->Edge * (in.y + this->Edge * in.z);
  }

private:
  glm::ivec3 Bricks;
  int Edge = 1; ///< bricks per axis
  glm::ivec3 Counts{ 0 };
};

/// Calls function(number, place) for bricks of a group.
template <class Function>
void ForMembers(const BrickGroups& groups, const Box& bricks, Function&& function)
{
  ForPositions(
    bricks, [&](const glm::ivec3& at) { function(groups.BrickAt(at), groups.PlaceOf(at)); });
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

/// What is known of the groups of a level under one transfer function, wherever the camera is:
/// found out group by group, when somebody asks. Methods may be called from any thread.
class KnownGroups
{
public:
  /// @param bytesAreOf whatever else BytesOf depends on, as a hash
  KnownGroups(std::int64_t count, std::uint64_t bytesAreOf)
    : Groups(static_cast<std::size_t>(count))
    , BytesKey(bytesAreOf)
  {
  }

  std::int64_t Count() const { return static_cast<std::int64_t>(this->Groups.size()); }
  std::uint64_t BytesAreOf() const { return this->BytesKey; }

  /// @param look called as GroupMembers() where it is not known; gives the same each time
  template <class Look>
  GroupMembers MembersOf(std::int64_t group, Look&& look)
  {
    Item& item = this->Groups[static_cast<std::size_t>(group)];
    const std::uint64_t there = item.There.load(std::memory_order_acquire);
    if (there != 0)
    {
      return { there, item.Visible, item.Uniform };
    }
    const GroupMembers members = look();
    item.Visible = members.Visible;
    item.Uniform = members.Uniform;
    item.There.store(members.There, std::memory_order_release);
    return members;
  }

  /// Bytes that all of a group takes.
  /// @param count called as std::uint64_t() where it is not known; gives the same each time
  template <class Count>
  std::uint64_t BytesOf(std::int64_t group, Count&& count)
  {
    return KnownOrCounted(
      this->Groups[static_cast<std::size_t>(group)].BytesAndOne, std::forward<Count>(count));
  }

  /// Bytes that all bricks of a group take as the source loads them, whatever is seen of them.
  /// @param count as BytesOf's
  template <class Count>
  std::uint64_t LoadBytesOf(std::int64_t group, Count&& count)
  {
    return KnownOrCounted(
      this->Groups[static_cast<std::size_t>(group)].LoadBytesAndOne, std::forward<Count>(count));
  }

private:
  /// All 0 as long as nothing is known.
  struct Item
  {
    std::atomic<std::uint64_t> There{ 0 };
    std::atomic<std::uint64_t> Visible{ 0 };
    std::atomic<std::uint64_t> Uniform{ 0 };
    std::atomic<std::uint64_t> BytesAndOne{ 0 };
    std::atomic<std::uint64_t> LoadBytesAndOne{ 0 };
  };

  template <class Count>
  static std::uint64_t KnownOrCounted(std::atomic<std::uint64_t>& more, Count&& count)
  {
    const std::uint64_t known = more;
    if (known != 0)
    {
      return known - 1;
    }
    const std::uint64_t bytes = count();
    more = bytes + 1;
    return bytes;
  }

  std::vector<Item> Groups;
  std::uint64_t BytesKey;
};

} // namespace banyan

#endif
