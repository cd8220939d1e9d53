// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Watchdog/Heartbeat.h"

#include "Base/Error.h"
#include "Base/Timer.h"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <csignal>
#include <cstring>
#include <ctime>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace banyan
{
namespace
{

constexpr std::chrono::milliseconds BeatEvery{ 100 };

/// In shared memory: only what works there without locks.
struct alignas(64) Slot
{
  std::atomic<std::int32_t> Rank; ///< + 1, so that fresh memory means none
  std::atomic<std::int32_t> Process;
  std::atomic<std::uint32_t> Beats;
  std::atomic<std::uint32_t> Waits;
  std::atomic<std::uint32_t> StallMilliseconds;
  std::atomic<Phase> Doing;
  std::atomic<std::int32_t> Ended;
};
static_assert(std::atomic<std::int32_t>::is_always_lock_free);
static_assert(std::atomic<Phase>::is_always_lock_free);

[[noreturn]] void Fail(const std::string& action)
{
  throw Error("The memory in which ranks of one machine see each other could not be " + action +
              ": " + std::strerror(errno) + ".");
}

double ProcessorSeconds()
{
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

} // namespace

struct Heartbeat::Internals
{
  Slot* Slots = nullptr;
  std::size_t Ranks = 0;
  std::size_t Place = 0;
  double Limit = 0;
  std::function<void(const std::string&)> Lost;
  std::mutex Mutex;
  std::condition_variable Wake;
  bool Stop = false;
  std::thread Thread;

  RankState StateOf(std::size_t place) const
  {
    const Slot& slot = this->Slots[place];
    return { slot.Rank - 1, slot.Process, slot.Beats, slot.Waits, slot.StallMilliseconds,
      slot.Doing, slot.Ended != 0 };
  }

  std::vector<RankState> States() const
  {
    std::vector<RankState> states;
    for (std::size_t place = 0; place < this->Ranks; ++place)
    {
      states.push_back(this->StateOf(place));
    }
    return states;
  }

  void Beat()
  {
    StallTimer clock;
    LostRankDetector others(this->Limit, false);
    const Timer timer;
    double last = timer.Seconds();
    double lastUsed = ProcessorSeconds();
    std::unique_lock<std::mutex> lock(this->Mutex);
    while (!this->Stop)
    {
      const double now = timer.Seconds();
      const double used = ProcessorSeconds();
      const double stuck = this->Show(clock, now - last, used - lastUsed);
      std::string sentence = others.Tick(now - last, this->Place, this->States(), false);
      if (stuck >= this->Limit)
      {
        sentence = "Rank " + std::to_string(this->Slots[this->Place].Rank - 1) +
                   " has not got on for " + std::to_string(std::lround(stuck)) +
                   " s while it was " + NameOf(Progress::Now()) + ".";
      }
      if (!sentence.empty() && this->Lost)
      {
        std::exchange(this->Lost, nullptr)(sentence);
      }
      last = now;
      lastUsed = used;
      this->Wake.wait_for(lock, BeatEvery, [this] { return this->Stop; });
    }
  }

  /// @return seconds that this rank has not got on
  double Show(StallTimer& clock, double seconds, double processorSeconds)
  {
    Slot& own = this->Slots[this->Place];
    const std::uint32_t waits = Progress::Waits();
    const Phase doing = Progress::Now();
    const double stuck = clock.Tick(
      seconds, processorSeconds, doing != Phase::Outside && waits % 2 == 0, Progress::Noted());
    own.Waits = waits;
    own.Doing = doing;
    own.StallMilliseconds = static_cast<std::uint32_t>(std::lround(1e3 * stuck));
    ++own.Beats;
    return stuck;
  }
};

std::string Heartbeat::MakeMemory(int ranks)
{
  static std::atomic<int> number{ 0 };
  const std::string name = "/banyan-" + std::to_string(getpid()) + "-" + std::to_string(++number);
  shm_unlink(name.c_str()); // of a process of the same number that ended too early
  const int file = shm_open(name.c_str(), O_CREAT | O_EXCL | O_RDWR, 0600);
  if (file < 0)
  {
    Fail("made");
  }
  // Not ftruncate: where there is no room, the first write would then kill the process.
  const int problem = posix_fallocate(file, 0, static_cast<off_t>(sizeof(Slot)) * ranks);
  close(file);
  if (problem != 0)
  {
    ForgetName(name);
    errno = problem;
    Fail("made");
  }
  return name;
}

void Heartbeat::ForgetName(const std::string& name)
{
  shm_unlink(name.c_str());
}

Heartbeat::Heartbeat(const std::string& name, int ranks, int place, int rank, double limitSeconds,
  std::function<void(const std::string&)> lost)
  : Self(std::make_unique<Internals>())
{
  const int file = shm_open(name.c_str(), O_RDWR, 0600);
  if (file < 0)
  {
    Fail("opened");
  }
  Internals& self = *this->Self;
  self.Ranks = static_cast<std::size_t>(ranks);
  self.Place = static_cast<std::size_t>(place);
  void* memory =
    mmap(nullptr, sizeof(Slot) * self.Ranks, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  close(file);
  if (memory == MAP_FAILED)
  {
    Fail("mapped");
  }
  self.Slots = static_cast<Slot*>(memory);
  self.Limit = limitSeconds;
  self.Lost = std::move(lost);
  self.Slots[self.Place].Process = static_cast<std::int32_t>(getpid());
  self.Slots[self.Place].Rank = rank + 1;
  // Signals are for the threads that were there before.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  try
  {
    self.Thread = std::thread([&self] { self.Beat(); });
  }
  catch (const std::exception& error)
  {
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    munmap(memory, sizeof(Slot) * self.Ranks);
    throw Error(
      std::string("The thread that watches for lost ranks could not be started: ") + error.what());
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

Heartbeat::~Heartbeat()
{
  {
    const std::lock_guard<std::mutex> lock(this->Self->Mutex);
    this->Self->Stop = true;
  }
  this->Self->Wake.notify_all();
  this->Self->Thread.join();
  this->Self->Slots[this->Self->Place].Ended = 1;
  munmap(this->Self->Slots, sizeof(Slot) * this->Self->Ranks);
}

std::size_t Heartbeat::Place() const
{
  return this->Self->Place;
}

std::vector<RankState> Heartbeat::States() const
{
  return this->Self->States();
}

} // namespace banyan
