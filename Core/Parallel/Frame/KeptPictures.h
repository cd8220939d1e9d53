// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Frame_KeptPictures_h
#define banyan_Parallel_Frame_KeptPictures_h

#include "Base/Hash.h"
#include "Parallel/Frame/DistributedFrame.h"
#include "Render/Scene/FloatImage.h"
#include "Series/Decode/CacheContext.h"

#include <atomic>
#include <cstdint>
#include <list>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace banyan
{

/// A picture that was drawn, and what a user is told of it.
struct DrawnPicture
{
  std::shared_ptr<const FloatImage> Pixels;
  double EstimatedError = 0.0; ///< ToleranceControl::Plan
  std::string Limit;           ///< ToleranceControl::Limit
  FrameStatistics Statistics;  ///< of the frame that it was drawn for
};

/// Pictures of one field that were drawn, by all that decides them: a scene that comes again is not
/// drawn again. Of pictures that somebody saw while the camera moved, the last one is kept alone:
/// they hardly come again.
///
/// When the budget is full, the least recently used pictures of other scenes go first. Then half of
/// the pictures are the newest ones, and half stay: of a loop that is longer than the budget, some
/// steps are there each time. (If the oldest one went, it would always be the one that comes next.)
class KeptPictures
{
public:
  KeptPictures() = default;
  ~KeptPictures();
  KeptPictures(const KeptPictures&) = delete;
  KeptPictures& operator=(const KeptPictures&) = delete;

  /// How coarse a picture is: ToleranceControl::Aim.
  struct Quality
  {
    double Coarseness = 0.0;
    bool Interacting = false;
  };

  /// Says whose PictureBudgetBytes pictures are kept in; all that keep some have equal parts of it.
  /// Those that were kept in others are let go.
  void KeepIn(const std::shared_ptr<CacheContext>& caches);

  /// Returns a picture of a scene that is as fine as wanted, and was not drawn while the camera
  /// moved if that does not move now. Null if there is none. Stays until the next call.
  /// @param content DistributedField::VisibleContent; it counts at the levels that a picture was
  /// drawn from
  const DrawnPicture* Find(
    const Hash128& scene, const std::vector<Hash128>& content, const Quality& wanted);

  /// Keeps a picture, in place of coarser ones of the scene, if the budget has room for it.
  /// @param levels that it was drawn from
  void Keep(const Hash128& scene, const std::vector<Hash128>& content, const std::set<int>& levels,
    const Quality& quality, const DrawnPicture& picture);

  void Clear() { this->KeepIn(nullptr); }
  /// May be called while another thread draws.
  std::uint64_t Bytes() const { return this->HeldBytes; }

private:
  struct Item
  {
    Hash128 Scene;
    Hash128 Content; ///< at Levels
    std::set<int> Levels;
    Quality How;
    DrawnPicture Picture;
    std::uint64_t Bytes;
  };

  std::list<Item>::iterator NextToGo(const Hash128& scene);
  template <class Predicate>
  void LetGoIf(Predicate&& predicate);

  std::shared_ptr<CacheContext> Caches; ///< null while nothing is kept
  std::list<Item> Items;                ///< the last used first
  std::atomic<std::uint64_t> HeldBytes{ 0 };
};

} // namespace banyan

#endif
