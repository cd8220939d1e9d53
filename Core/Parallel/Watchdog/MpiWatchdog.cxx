// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Watchdog/MpiWatchdog.h"

#include "Base/Error.h"
#include "Parallel/Watchdog/MpiError.h"

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

#include <sched.h>

namespace banyan
{
namespace
{

constexpr double LookEvery = 0.1;
/// Who waits for a lost rank ends the job, in good order. When nobody does, because ranks wait in
/// calls that are not ours, the threads that give signs end it so much later.
constexpr double SecondsForWaiters = 4.0;

/// Ranks of this machine, for as long as it takes to arrange something.
class Neighbours
{
public:
  explicit Neighbours(MPI_Comm all)
  {
    CheckMpi(MPI_Comm_split_type(all, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &this->Handle),
      "find the ranks of this machine");
    MPI_Comm_rank(this->Handle, &this->Self);
    MPI_Comm_size(this->Handle, &this->Count);
  }
  ~Neighbours() { MPI_Comm_free(&this->Handle); }
  Neighbours(const Neighbours&) = delete;
  Neighbours& operator=(const Neighbours&) = delete;

  bool All(bool mine) const
  {
    int own = mine ? 1 : 0;
    int all = 0;
    MPI_Allreduce(&own, &all, 1, MPI_INT, MPI_MIN, this->Handle);
    return all == 1;
  }

  MPI_Comm Handle = MPI_COMM_NULL;
  int Self = 0;
  int Count = 1;
};

/// Collective. Null on all ranks of the machine where there is no memory that they could share.
std::unique_ptr<Heartbeat> MakeHeartbeat(const Neighbours& here, int rank, double limitSeconds,
  const std::function<void(const std::string&)>& lost)
{
  std::array<char, 128> name{};
  std::unique_ptr<Heartbeat> beat;
  try
  {
    if (here.Self == 0)
    {
      const std::string made = Heartbeat::MakeMemory(here.Count);
      std::strncpy(name.data(), made.c_str(), name.size() - 1);
    }
  }
  catch (const Error&)
  {
    name[0] = 0;
  }
  MPI_Bcast(name.data(), static_cast<int>(name.size()), MPI_BYTE, 0, here.Handle);
  if (name[0] == 0)
  {
    return nullptr;
  }
  try
  {
    beat =
      std::make_unique<Heartbeat>(name.data(), here.Count, here.Self, rank, limitSeconds, lost);
  }
  catch (const std::exception&) // no thread of its own, for example
  {
    beat.reset();
  }
  const bool all = here.All(beat != nullptr);
  if (here.Self == 0)
  {
    Heartbeat::ForgetName(name.data());
  }
  return all ? std::move(beat) : nullptr;
}

} // namespace

double MpiTimeout::FromEnvironment()
{
  const char* text = std::getenv("BANYAN_RANK_LIMIT_SECONDS");
  if (!text || !*text)
  {
    return DefaultSeconds;
  }
  char* end = nullptr;
  const double seconds = std::strtod(text, &end);
  if (*end != 0 || !(seconds == 0.0 || (seconds >= 1.0 && seconds <= 1e6)))
  {
    throw Error("BANYAN_RANK_LIMIT_SECONDS is '" + std::string(text) +
                "'; it takes 0 for no limit, or from 1 to 1000000 seconds.");
  }
  return seconds;
}

std::unique_ptr<MpiWatchdog> MpiWatchdog::Attach(MPI_Comm handle, const MpiTimeout& timeout)
{
  MpiTimeout common = timeout;
  int ranks = 1;
  MPI_Comm_size(handle, &ranks);
  CheckMpi(MPI_Bcast(&common.Seconds, 1, MPI_DOUBLE, 0, handle), "broadcast");
  return ranks == 1 || !(common.Seconds > 0.0)
           ? nullptr
           : std::unique_ptr<MpiWatchdog>(new MpiWatchdog(handle, common));
}

MpiWatchdog::MpiWatchdog(MPI_Comm handle, const MpiTimeout& timeout)
  : Handle(handle)
  , Timeout(timeout)
{
  int ranks = 1;
  MPI_Comm_rank(handle, &this->Self);
  MPI_Comm_size(handle, &ranks);
  CheckMpi(MPI_Comm_dup(handle, &this->Leaving), "duplicate a communicator");
  MPI_Comm_set_errhandler(this->Leaving, MPI_ERRORS_RETURN);
  const Neighbours here(handle);
  this->Beat = MakeHeartbeat(here, this->Self, this->Timeout.Seconds + SecondsForWaiters,
    [this](const std::string& sentence)
    {
      int finalized = 0;
      MPI_Finalized(&finalized);
      if (finalized)
      {
        return;
      }
      // Not the thread that speaks MPI, but that one will not speak any more.
      std::fprintf(stderr, "banyan: %s The job ends.\n", sentence.c_str());
      MPI_Abort(this->Handle, EXIT_FAILURE);
    });
  this->Lost = std::make_unique<LostRankDetector>(this->Timeout.Seconds, here.Count == ranks);
}

MpiWatchdog::~MpiWatchdog()
{
  this->Beat.reset(); // its thread knows the handle
  int finalized = 0;
  MPI_Finalized(&finalized);
  if (!finalized && this->Leaving != MPI_COMM_NULL)
  {
    MPI_Comm_free(&this->Leaving);
  }
}

void MpiWatchdog::Pause(double waited)
{
  // Short waits are those of a frame, where each microsecond counts; long ones are for somebody who
  // still draws, perhaps on this processor.
  constexpr double spinning = 2e-3;
  if (waited < spinning)
  {
    sched_yield();
    return;
  }
  std::this_thread::sleep_for(std::chrono::microseconds(waited < 0.05 ? 20 : 200));
  if (this->SinceLook.Seconds() >= LookEvery)
  {
    this->LookAround(waited);
  }
}

void MpiWatchdog::LookAround(double waited)
{
  const double seconds = this->SinceLook.Seconds();
  this->SinceLook.Restart();
  if (!this->Beat)
  {
    return;
  }
  const std::string lost = this->Lost->Tick(seconds, this->Beat->Place(), this->Beat->States());
  if (!lost.empty())
  {
    this->EndJob(lost + " Rank " + std::to_string(this->Self) + " has waited for " +
                 std::to_string(std::lround(waited)) + " s while it was " +
                 NameOf(Progress::Now()) + ".");
  }
}

bool MpiWatchdog::OthersWork() const
{
  if (!this->Beat)
  {
    return false;
  }
  const std::vector<RankState> states = this->Beat->States();
  for (std::size_t i = 0; i < states.size(); ++i)
  {
    if (i != this->Beat->Place() && states[i].Doing != Phase::Outside && states[i].Waits % 2 == 0)
    {
      return true;
    }
  }
  return false;
}

void MpiWatchdog::LeaveTogether(const std::string& why)
{
  MPI_Request request = MPI_REQUEST_NULL;
  CheckMpi(MPI_Ibarrier(this->Leaving, &request), "wait for all ranks");
  Timer quiet;
  this->Until(
    [&]
    {
      int done = 0;
      CheckMpi(MPI_Test(&request, &done, MPI_STATUS_IGNORE), "wait for all ranks");
      if (done)
      {
        return true;
      }
      if (this->OthersWork())
      {
        quiet.Restart();
      }
      if (quiet.Seconds() >= 0.5 * this->Timeout.Seconds)
      {
        this->EndJob("Rank " + std::to_string(this->Self) +
                     " failed alone, and the others wait for it. " + why);
      }
      return false;
    });
}

void MpiWatchdog::EndJob(const std::string& sentence) const
{
  const std::string whole =
    sentence +
    " The job ends. (BANYAN_RANK_LIMIT_SECONDS says how long ranks are waited for; 0 is for ever.)";
  if (this->Timeout.Tell)
  {
    this->Timeout.Tell(whole);
  }
  std::fprintf(stderr, "banyan: %s\n", whole.c_str());
  std::fflush(stderr);
  MPI_Abort(this->Handle, EXIT_FAILURE);
  std::abort(); // MPI_Abort does not return
}

} // namespace banyan
