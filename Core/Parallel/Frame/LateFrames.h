// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Frame_LateFrames_h
#define banyan_Parallel_Frame_LateFrames_h

#include "Base/BackgroundTask.h"
#include "Base/Timer.h"
#include "Parallel/Frame/FieldFrames.h"

#include <functional>
#include <optional>

namespace banyan
{

/// Frames of one field that nobody has to wait for. Where an exact picture takes longer than one
/// waits, a coarse one is there at once, and the exact one is drawn by a thread meanwhile.
///
///     called         Draw(A)     Draw(A)      GoOn()      Draw(A)     Draw(B)
///     returned       coarse A    coarse A     true        exact A     coarse B
///     the thread     exact A ──────────────── done                    exact B ──────────
///
/// Another scene stops what threads are at. While the camera moves, the thread begins once nothing
/// was drawn for a while. Pictures that take long have one between the coarse and the exact one.
/// While a series plays, each step is waited for: otherwise none would ever be shown exactly.
/// All functions are called by one thread. Of one rank alone.
class LateFrames
{
public:
  /// Seconds that a coarse picture should take.
  static constexpr double CoarseSeconds = 0.025;

  /// Seconds.
  struct Times
  {
    double Patience = CoarseSeconds; ///< that an exact picture may take without a coarse one
    double Pause = 0.1;   ///< without a picture, while the camera moves, before the thread begins
    double Long = 2.0;    ///< exact pictures that take more have one between
    double Playing = 1.0; ///< steps that follow each other in less time are those of a play
    /// That the exact picture of a scene at rest may take without a coarse one, where a client
    /// shows older ones meanwhile.
    double AtRest = 0.2;
    /// That an exact picture may take that somebody waits for, where showing it later takes long:
    /// on a line of 20 Mbit/s ParaView's own picture takes a second.
    double Shown = 1.0;
  };

  struct Shown
  {
    FieldFrames::Frame Frame;
    bool Exact = false; ///< otherwise the exact picture is still to come
  };
  struct Drawn
  {
    FieldFrames::Frame Frame;
    double Seconds = 0.0;
  };

  /// What a coarse picture is drawn with: no probe is drawn for it, and time decides how coarse it
  /// is.
  static FieldFrames::Wish CoarseOf(FieldFrames::Wish wish, double seconds);
  /// A hash of all that decides an exact picture, as far as this process knows it.
  static Hash128 NameOf(
    const DistributedField& field, const RayScene& scene, const FieldFrames::Wish& wish);

  /// @param frames that pictures are drawn and kept by; not to be used by others meanwhile
  explicit LateFrames(FieldFrames& frames)
    : LateFrames(frames, Times())
  {
  }
  LateFrames(FieldFrames& frames, const Times& times);
  ~LateFrames();
  LateFrames(const LateFrames&) = delete;
  LateFrames& operator=(const LateFrames&) = delete;

  /// Returns the best picture of the scene that is there, or can be had in the coarse one's time.
  /// @param communicator of one rank
  /// @param field and the communicator have to stay, and the field as it is, until Stop or Finish
  /// @param coarseSeconds that a coarse picture should take
  /// Throws Error when the scene cannot be drawn, now or by the thread.
  Shown Draw(Communicator& communicator, DistributedField& field, const RayScene& scene,
    const FieldFrames::Wish& wish, double coarseSeconds = CoarseSeconds);

  /// To be called now and then while Draw returns coarse pictures: begins what has to be begun.
  /// @return whether Draw would return a better picture of the last scene
  bool GoOn();

  /// Whether the thread draws from the field: nothing that a picture changes may be read of it.
  bool IsDrawing() const { return this->Exact.IsStarted() && !this->Exact.HasEnded(); }

  /// Stops what the thread is at, so that the field may change.
  void Stop();
  /// Stops the threads of all objects of this process, so that ThreadPool::Process may change.
  /// They go on by GoOn, or by Draw.
  static void PauseAll();
  /// Returns when the thread has ended.
  void Finish() { this->Exact.Finish(); }
  /// For a picture that is to be waited for, and drawn by FieldFrames: the same as Finish where the
  /// thread draws that scene, so that it is there. Elsewhere the thread stops until GoOn or Draw.
  void Settle(const DistributedField& field, const RayScene& scene, const FieldFrames::Wish& wish);

private:
  struct Coming;
  using Drawing = std::function<Drawn(const RayScene& scene, const FieldFrames::Wish& wish)>;

  bool Plays(const DistributedField& field, const FieldFrames::Wish& wish);
  void Take();
  void Learn(const Drawn& drawn);
  void Start(const Drawing& draw, const RayScene& scene, const FieldFrames::Wish& exact,
    double coarseSeconds);

  FieldFrames& Frames;
  Times Waits;
  BackgroundTask Exact;
  Hash128 Name;                       ///< of the last scene
  Shown Last;                         ///< of it; without pixels while there is none
  std::function<void()> Begin;        ///< starts the thread; none while there is nothing to draw
  std::shared_ptr<Coming> Next;       ///< by the thread
  std::optional<double> ExactSeconds; ///< that the last exact picture took
  Timer SinceDrawn;
  std::uint64_t Version = 0; ///< of the field, when it was drawn last
  Timer SinceVersion;        ///< that version's first picture
};

} // namespace banyan

#endif
