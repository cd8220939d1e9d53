// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Communicate/CollectiveTask.h"

#include "Parallel/Communicate/Collective.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

namespace banyan
{
namespace
{

/// Is told by main threads to each other.
struct RankState
{
  bool Asks = false; ///< whether the thread waits for an operation
  bool Ended = false;
  bool Leaves = false; ///< on rank 0
};

} // namespace

/// What the thread asks the main thread for.
class CollectiveTask::Requests final : public Communicator
{
public:
  explicit Requests(Communicator& ranks)
    : Real(ranks)
    , Self(ranks.Rank())
    , Ranks(ranks.Size())
  {
  }

  int Rank() const override { return this->Self; }
  int Size() const override { return this->Ranks; }
  bool SendsAtOnce() const override { return false; }

  void Send(int, int, const void*, std::size_t) override { Refuse(); }
  void Receive(int, int, void*, std::size_t) override { Refuse(); }
  void WaitAll() override { Refuse(); }
  void SendWhole(int, int, const void*, std::size_t) override { Refuse(); }
  void ReceiveWhole(int, int, void*, std::size_t) override { Refuse(); }
  Arrival WaitAnyWhole() override { Refuse(); }
  bool TakeAnyWhole(Arrival&) override { Refuse(); }

  void Together(const std::function<void(Communicator&)>& part) override { this->Ask(part); }
  void Barrier() override
  {
    this->Ask([](Communicator& ranks) { ranks.Barrier(); });
  }
  void Broadcast(int root, void* data, std::size_t bytes) override
  {
    this->Ask([&](Communicator& ranks) { ranks.Broadcast(root, data, bytes); });
  }
  void AllGather(const void* mine, std::size_t bytes, void* all) override
  {
    this->Ask([&](Communicator& ranks) { ranks.AllGather(mine, bytes, all); });
  }
  int RanksOnThisNode() override
  {
    int count = 0;
    this->Ask([&](Communicator& ranks) { count = ranks.RanksOnThisNode(); });
    return count;
  }
  void LeaveTogether(const std::string& why) override
  {
    this->Ask([&](Communicator& ranks) { ranks.LeaveTogether(why); });
  }

  // From here on by the main thread.

  /// Until the thread asks for something, or not any more, or until time is up.
  /// @param asked whether it did when it was looked at last
  /// @return whether it does
  bool AwaitOther(bool asked, std::chrono::microseconds most)
  {
    std::unique_lock<std::mutex> lock(this->Mutex);
    this->Changed.wait_for(lock, most, [&] { return (this->Wanted != nullptr) != asked; });
    return this->Wanted != nullptr;
  }

  /// Does what the thread waits for.
  void Do()
  {
    std::exception_ptr failure;
    try
    {
      (*this->Wanted)(this->Real);
    }
    catch (...)
    {
      failure = std::current_exception();
    }
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Failure = std::move(failure);
    this->Wanted = nullptr;
    this->Changed.notify_all();
  }

  /// Does nothing any more.
  void Close()
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Closed = true;
    this->Changed.notify_all();
  }

private:
  using Operation = std::function<void(Communicator&)>;

  [[noreturn]] static void Refuse()
  {
    throw Error("A thread beside the main thread cannot send messages to single ranks, but in a "
                "part of Communicator::Together.");
  }

  void Ask(const Operation& operation)
  {
    std::unique_lock<std::mutex> lock(this->Mutex);
    this->Wanted = &operation;
    this->Changed.notify_all();
    this->Changed.wait(lock, [&] { return this->Wanted == nullptr || this->Closed; });
    // What was done counts even if somebody has closed since: it was done on all ranks.
    if (std::exchange(this->Wanted, nullptr) != nullptr)
    {
      throw Interruption("The work was stopped.");
    }
    if (const std::exception_ptr failure = std::exchange(this->Failure, nullptr))
    {
      std::rethrow_exception(failure);
    }
  }

  Communicator& Real;
  int Self;
  int Ranks;
  std::mutex Mutex;
  std::condition_variable Changed;
  const Operation* Wanted = nullptr; ///< of the thread that waits
  std::exception_ptr Failure;        ///< of what was done last
  bool Closed = false;
};

CollectiveTask::CollectiveTask(Communicator& ranks)
  : Ranks(ranks)
{
}

CollectiveTask::~CollectiveTask()
{
  this->Stop();
}

void CollectiveTask::Start(Task task)
{
  this->Stop();
  this->OfThread = std::make_unique<Requests>(this->Ranks);
  Attempt(this->Failure,
    [&]
    {
      this->Thread.Start([ranks = this->OfThread.get(), work = std::move(task)](
                           const StopFlag& stop) { work(*ranks, stop); });
    });
}

void CollectiveTask::Stop()
{
  if (this->OfThread)
  {
    this->OfThread->Close();
  }
  this->Thread.Stop();
  this->OfThread.reset();
  this->Failure.clear();
}

/// Collective, when no rank can go on.
void CollectiveTask::End()
{
  std::string failure = this->Failure;
  if (this->Thread.HasEnded())
  {
    Attempt(failure, [&] { this->Thread.Wait(); });
  }
  this->Stop();
  ThrowTogether(this->Ranks, failure);
}

bool CollectiveTask::Serve(const std::function<bool()>& leave)
{
  using std::chrono::microseconds;
  // Threads that work need the cores, which MPI's own calls would keep busy.
  constexpr microseconds longest{ 500 };
  constexpr microseconds shortest{ 20 };
  microseconds pause = shortest;
  RankState mine;
  std::vector<RankState> all(static_cast<std::size_t>(this->Ranks.Size()));
  while (true)
  {
    mine.Asks = this->OfThread && this->OfThread->AwaitOther(mine.Asks, pause);
    mine.Ended = !this->Thread.IsStarted() || this->Thread.HasEnded();
    mine.Leaves = this->Ranks.Rank() == 0 && leave();
    pause = std::min(2 * pause, longest);
    this->Ranks.AllGather(&mine, sizeof(mine), all.data());
    const auto asks = [](const RankState& rank) { return rank.Asks; };
    const auto ended = [](const RankState& rank) { return rank.Ended; };
    if (std::all_of(all.begin(), all.end(), ended))
    {
      this->End();
      return true;
    }
    if (std::any_of(all.begin(), all.end(), ended) && std::any_of(all.begin(), all.end(), asks))
    {
      this->End();
      throw CollectiveError(
        "Some ranks have done their part of the work, and others wait for them");
    }
    if (all.front().Leaves)
    {
      return false;
    }
    if (std::all_of(all.begin(), all.end(), asks))
    {
      this->OfThread->Do();
      mine.Asks = false;
      pause = shortest;
    }
  }
}

} // namespace banyan
