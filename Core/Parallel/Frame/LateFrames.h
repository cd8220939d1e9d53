// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Frame_LateFrames_h
#define banyan_Parallel_Frame_LateFrames_h

#include "Base/BackgroundTask.h"
#include "Parallel/Frame/FieldFrames.h"

#include <optional>

namespace banyan
{

/// Frames of one field that nobody has to wait for. Where an exact picture takes longer than
/// Patience, a coarse one is there at once, and the exact one is drawn by a thread meanwhile.
///
///     called         Draw(A)     Draw(A)      HasNews()   Draw(A)     Draw(B)
///     returned       coarse A    coarse A     true        exact A     coarse B
///     the thread     exact A ──────────────── done                    exact B ──────────
///
/// Another scene stops what the thread is at. All functions are called by one thread. Of one rank
/// alone.
class LateFrames
{
public:
  /// Seconds that an exact picture may take without a coarse one before it, and that a coarse one
  /// should take.
  static constexpr double Patience = 0.04;
  static constexpr double CoarseSeconds = 0.025;

  struct Shown
  {
    FieldFrames::Frame Frame;
    bool Exact = false; ///< otherwise the exact picture is still to come
  };

  /// @param frames that pictures are drawn and kept by; not to be used by others meanwhile
  explicit LateFrames(FieldFrames& frames, double patience = Patience);
  ~LateFrames();
  LateFrames(const LateFrames&) = delete;
  LateFrames& operator=(const LateFrames&) = delete;

  /// Returns the best picture of the scene that is there, or can be had in CoarseSeconds.
  /// @param communicator of one rank
  /// @param field and the communicator have to stay, and the field as it is, until Stop or Finish
  /// Throws Error when the scene cannot be drawn, now or by the thread.
  Shown Draw(Communicator& communicator, DistributedField& field, const RayScene& scene,
    const FieldFrames::Wish& wish);

  /// Whether the thread has ended, so that Draw will return another picture of the last scene.
  bool HasNews() const { return this->Exact.HasEnded(); }

  /// Whether the thread draws from the field: nothing that a picture changes may be read of it.
  bool IsDrawing() const { return this->Exact.IsStarted() && !this->Exact.HasEnded(); }

  /// Stops what the thread is at, so that the field may change.
  void Stop() { this->Exact.Stop(); }
  /// Stops the threads of all objects of this process, so that ThreadPool::Process may change.
  static void StopAll();
  /// Returns when the thread has ended.
  void Finish() { this->Exact.Finish(); }
  /// For a picture that is to be waited for, and drawn by FieldFrames: the same as Finish where the
  /// thread draws that scene, so that it is there, and as Stop elsewhere.
  void Settle(const DistributedField& field, const RayScene& scene, const FieldFrames::Wish& wish);

private:
  struct Drawn
  {
    FieldFrames::Frame Frame;
    double Seconds = 0.0;
  };

  static Hash128 NameOf(
    const DistributedField& field, const RayScene& scene, const FieldFrames::Wish& wish);
  void Take();

  FieldFrames& Frames;
  double WaitsFor;
  BackgroundTask Exact;
  Hash128 Name;                       ///< of the last scene
  Shown Last;                         ///< of it
  std::shared_ptr<Drawn> Coming;      ///< by the thread
  std::optional<double> ExactSeconds; ///< that the last exact picture took
};

} // namespace banyan

#endif
