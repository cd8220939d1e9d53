// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Frame_LateFramesOfRanks_h
#define banyan_Parallel_Frame_LateFramesOfRanks_h

#include "Parallel/Communicate/CollectiveTask.h"
#include "Parallel/Frame/LateFrames.h"

#include <functional>
#include <mutex>
#include <optional>

namespace banyan
{

/// LateFrames of any number of ranks: a coarse picture of a scene is there at once, and threads of
/// all ranks draw the exact one while their main threads serve them, or do other things.
///
///     main threads   Draw(A)   GoOn ... leaves      GoOn ... true     Draw(B)
///     Last()         coarse A                       exact A           coarse B
///     threads        exact A ──────────────────────────────           exact B ─────
///
/// All functions but the getters are called by the main threads of all ranks, in the same order.
class LateFramesOfRanks
{
public:
  /// @param frames that pictures are drawn and kept by; not to be used by others meanwhile
  /// @param times the same on all ranks; Pause and Playing do not count
  explicit LateFramesOfRanks(FieldFrames& frames, const LateFrames::Times& times = {});
  ~LateFramesOfRanks();
  LateFramesOfRanks(const LateFramesOfRanks&) = delete;
  LateFramesOfRanks& operator=(const LateFramesOfRanks&) = delete;

  /// Collective: draws what can be had of the scene at once, unless that was done; begins the exact
  /// picture. Another scene, of any object of this main thread, is stopped. Of a scene at rest
  /// whose exact picture takes Times::AtRest at most, nothing else is drawn: an older picture seen
  /// anew may be better than a coarse one.
  /// @param communicator and the field have to stay, and the field as it is, until Stop
  /// @param coarse the same scene in the picture that a coarse one has: of another size, perhaps
  /// @param shows whether Last is shown at once, and has to be there: then an exact picture that
  /// takes Times::Shown at most is waited for
  /// @return whether Last has changed
  /// Throws CollectiveError on all ranks when one of them fails.
  bool Draw(Communicator& communicator, DistributedField& field, const RayScene& scene,
    const RayScene& coarse, const FieldFrames::Wish& wish, bool shows = false);

  /// Collective: draws a coarse picture, and begins no exact one: something of the scene is still
  /// to come. Another scene, of any object of this main thread, is stopped. Throws CollectiveError
  /// on all ranks when one of them fails.
  void DrawCoarse(Communicator& communicator, DistributedField& field, const RayScene& coarse,
    const FieldFrames::Wish& wish);

  /// Collective: serves the threads; begins what was paused, when no other object draws.
  /// @param leave as of CollectiveTask::Serve
  /// @return whether the exact picture has come, and is the Last one
  /// Throws CollectiveError on all ranks when a thread has failed: Draw begins anew.
  bool GoOn(const std::function<bool()>& leave);

  /// A picture between the coarse and the exact one, where that takes long: each once, on rank 0.
  std::optional<FieldFrames::Frame> TakeBetween();

  /// Whether anything of the last scene is there: the same on all ranks.
  bool HasAny() const { return this->Any; }
  /// The best picture of it, if so. Its pixels are on rank 0.
  const LateFrames::Shown& Last() const { return this->Best; }

  /// Whether threads draw from the field: the same on all ranks, as all that follows.
  bool IsDrawing() const { return this->Task && this->Task->IsStarted(); }
  /// Whether they do, or will by GoOn.
  bool IsComing() const { return this->Begin != nullptr; }

  /// Stops what the threads are at, so that the field may change.
  void Stop();
  /// Stops the threads of all objects of this main thread, so that ThreadPool::Process may change.
  /// They go on by GoOn.
  static void PauseAll();
  /// Whether threads of any such object draw.
  static bool AnyDraws();

private:
  void Learn(const LateFrames::Drawn& drawn);
  void DrawBest(Communicator& communicator, DistributedField& field, const RayScene& scene,
    const RayScene* coarse, const FieldFrames::Wish& exact, double patience);
  void Start(Communicator& communicator, DistributedField& field, const RayScene& scene,
    const FieldFrames::Wish& exact);

  FieldFrames& Frames;
  LateFrames::Times Waits;
  Hash128 Name;                       ///< of the last scene
  LateFrames::Shown Best;             ///< of it
  bool Any = false;                   ///< whether there is one
  std::function<void()> Begin;        ///< starts the threads; null when nothing is to come
  LateFrames::Drawn Next;             ///< by the threads, when they have ended
  std::optional<double> ExactSeconds; ///< of the last exact picture; the same on all ranks
  std::mutex Mutex;                   ///< of what is between
  std::optional<FieldFrames::Frame> Between;
  std::optional<CollectiveTask> Task; ///< last: its thread ends before what it writes is gone
};

} // namespace banyan

#endif
