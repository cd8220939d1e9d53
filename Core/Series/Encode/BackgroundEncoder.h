// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_BackgroundEncoder_h
#define banyan_Series_Encode_BackgroundEncoder_h

#include "Base/ThreadPool.h"
#include "Series/Encode/GroupEncoder.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace banyan
{

/// Encodes groups of a series one after another, each in a thread of its own, while the caller goes
/// on reading. The thread calls nothing of the caller's: neither MPI nor VTK nor Python.
///
/// One thread at a time may use it.
class BackgroundEncoder
{
public:
  /// @param plan the index of the series, with ranges and bounds (see PlanSeries)
  /// @param folder must outlive this object, and not be used while Busy()
  /// @param threads that work on a group, at least 1
  BackgroundEncoder(
    SeriesIndex plan, const EncodeOptions& options, SegmentFolder& folder, int threads);
  /// Interrupts what is under way and waits for it.
  ~BackgroundEncoder();
  BackgroundEncoder(const BackgroundEncoder&) = delete;
  BackgroundEncoder& operator=(const BackgroundEncoder&) = delete;

  /// Begins with a group; must not be Busy(), and the result of the one before must be taken.
  /// @param steps values by step and array; borrowed until it is no longer Busy()
  /// @param before the step before them, borrowed as well. Not needed by the first group of the
  /// series, nor when the group before was encoded here just before this one
  /// Throws Error when no thread can be started.
  void Start(int number, std::vector<double> times, std::vector<std::vector<ArrayValues>> steps,
    std::vector<ArrayValues> before = {});

  bool Busy() const;

  /// How much of the present group is encoded, in [0, 1].
  double Share() const { return this->Done; }

  /// Makes the present group end soon, with an Error. Returns at once.
  void Interrupt() { this->Interrupted = true; }

  /// Waits until it is not Busy().
  /// @param tick called about ten times per second meanwhile
  void Wait(const std::function<void()>& tick);

  /// The group that has been encoded, and its number, once; none while it is Busy(), or when there
  /// is nothing new. Throws what encoding it threw, once.
  std::optional<std::pair<int, EncodedGroup>> Take();

private:
  void Encode(int number, const std::vector<double>& times,
    const std::vector<std::vector<ArrayValues>>& steps,
    const std::vector<ArrayValues>& before) noexcept;

  const SeriesIndex Plan;
  const EncodeOptions Options;
  SegmentFolder& Folder;
  ThreadPool Pool;
  LastStep Last; ///< of the group before, where groups come one after the other
  std::thread Worker;
  std::atomic<double> Done{ 0.0 };
  std::atomic<bool> Interrupted{ false };
  mutable std::mutex Mutex; ///< of all below
  std::condition_variable Ended;
  bool Working = false;
  std::optional<std::pair<int, EncodedGroup>> Result;
  std::exception_ptr Failure;
};

} // namespace banyan

#endif
