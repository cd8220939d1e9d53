// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_PackedBrickCache_h
#define banyan_Render_Bricks_PackedBrickCache_h

#include "Render/Bricks/BrickGroups.h"
#include "Render/Bricks/PackedBrick.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <shared_mutex>
#include <unordered_map>
#include <utility>

namespace banyan
{

class CacheContext;

/// Packed bricks that a source keeps from one picture to the next. What is there stays, as long as
/// pictures use it: pictures go through bricks in ever other orders, and dropping the least
/// recently used of more than there is room for would keep none in time.
///
/// Coarse pictures while the camera moves let bricks of the finest levels stay, which the picture
/// after them needs: they take room from those only where they find none.
///
/// Methods may be called from any thread.
class PackedBrickCache
{
public:
  using Pointer = std::shared_ptr<const PackedBrick>;

  /// Shares the budget for drawing of the process, or of other caches.
  PackedBrickCache();
  explicit PackedBrickCache(std::shared_ptr<CacheContext> caches);
  ~PackedBrickCache();
  PackedBrickCache(const PackedBrickCache&) = delete;
  PackedBrickCache& operator=(const PackedBrickCache&) = delete;

  /// Of what drawing may take, what is kept from picture to picture. The rest is for bricks that
  /// are packed for one picture.
  static std::uint64_t PartOf(std::uint64_t budgetBytes) { return budgetBytes / 4 * 3; }
  /// The part of the context's budget for drawing that is this one's: all that keep bricks have
  /// equal ones.
  std::uint64_t ShareBytes() const;
  const std::shared_ptr<CacheContext>& Caches() const { return this->Context; }

  enum class Picture
  {
    Whole,
    Passing, ///< a coarse one, after which another will come
    Part     ///< of the one before, or a help to make the next one
  };

  /// Lets go of all beyond the limit, and for a whole picture of bricks that neither the last two
  /// pictures used nor the last two whole ones. Where the last passing picture found no room, the
  /// next one gets it from bricks that the last two pictures did not use.
  void BeginPicture(std::uint64_t limitBytes, Picture kind = Picture::Whole);
  /// The picture that was begun has been drawn: one that was stopped makes bricks no older.
  void EndPicture();

  /// Lets go of what the values of a source that has others do not fit any more: of bricks of which
  /// `stale(number, packed)` is true, and of all that is known of groups.
  void LetGoOf(const std::function<bool(std::int64_t, const PackedBrick&)>& stale);
  /// Lets go of everything.
  void Clear();

  struct Wanted
  {
    std::int64_t Brick = -1; ///< none if below 0
    Box Cells;
    double Low = 0.0; ///< what values are packed relative to, if they are relative
    bool Gradients = false;
  };

  struct Found
  {
    Pointer Packed; ///< null if not kept
    /// What can be seen of it, as KeepVisibility was told; empty if it was not.
    std::optional<BrickVisibility> Visibility;
  };

  /// Looks for several bricks in one go; those that are there are used from now on.
  /// @param visible VisibleValues::Number
  /// @param found as many; those that are not there are not set
  void Find(const Wanted* wanted, std::size_t count, std::uint64_t visible, Found* found) const;

  /// Keeps a brick if there is room, in place of what was kept under its number.
  void Keep(std::int64_t brick, const Pointer& packed);

  /// What can be seen of a kept brick under a number of VisibleValues. Without effect when the
  /// brick is not kept.
  void KeepVisibility(std::int64_t brick, std::uint64_t visible, const BrickVisibility& visibility);

  /// What is known of the groups of bricks of a level under a number of VisibleValues. Kept for one
  /// number per level.
  /// @param count of all groups
  /// @param bytesAreOf see KnownGroups; 0 for whatever is there
  std::shared_ptr<KnownGroups> GroupsOf(
    int level, std::uint64_t visible, std::int64_t count, std::uint64_t bytesAreOf);

  std::uint64_t Bytes() const;

private:
  /// The number of a picture before all others.
  static constexpr std::int64_t Never = -1000;

  struct Item
  {
    explicit Item(Pointer packed)
      : Packed(std::move(packed))
    {
    }

    Pointer Packed;
    mutable std::atomic<std::int64_t> UsedIn{ Never }; ///< number of a picture
    mutable std::atomic<std::int64_t> UsedInWhole{ Never };
    std::optional<BrickVisibility> Visibility;
    std::uint64_t VisibleUnder = 0; ///< VisibleValues::Number
  };

  void SetHeld(std::uint64_t bytes);
  void Use(const Item& item) const;
  const Item* FindHere(const Wanted& wanted) const;

  std::shared_ptr<CacheContext> Context;
  std::uint64_t LimitBytes = 0;
  std::uint64_t HeldBytes = 0;
  std::uint64_t RefusedBytes = 0; ///< that found no room in a passing picture
  Picture Kind = Picture::Whole;
  std::int64_t Number = 0;      ///< of the picture, among all but parts
  std::int64_t WholeNumber = 0; ///< of the picture, among whole ones
  std::unordered_map<std::int64_t, Item> Items;
  /// By level, with the number of VisibleValues.
  std::unordered_map<int, std::pair<std::uint64_t, std::shared_ptr<KnownGroups>>> Groups;
  mutable std::shared_mutex Mutex; ///< shared by those who only look
};

} // namespace banyan

#endif
