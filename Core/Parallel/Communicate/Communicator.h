// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Communicate_Communicator_h
#define banyan_Parallel_Communicate_Communicator_h

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace banyan
{

/// Offers what the parallel algorithms need of a message-passing library: ranks, bytes and nothing
/// else. Implementations: MPI, one process alone, and simulated ranks (threads) for tests. Only one
/// thread per rank may use it (the main thread: ParaView initialises MPI as single-threaded);
/// others have that of a CollectiveTask. On one process any thread may call what is collective.
class Communicator
{
public:
  virtual ~Communicator() = default;
  virtual int Rank() const = 0;
  virtual int Size() const = 0;

  /// Non-blocking; `data` must stay until `WaitAll()`. Messages between a pair of ranks with equal
  /// tags arrive in order. More than 2^31 bytes are allowed.
  virtual void Send(int to, int tag, const void* data, std::size_t bytes) = 0;
  virtual void Receive(int from, int tag, void* data, std::size_t bytes) = 0;
  /// Until all sends and receives posted by this rank are complete, but for `ReceiveWhole`.
  virtual void WaitAll() = 0;

  /// A message whose size its receiver does not know, less than 2^31 bytes. `SendWhole` is complete
  /// with `WaitAll()`, `ReceiveWhole` with `WaitAnyWhole()`. The tag must not be one that `Send`
  /// uses at the same time.
  virtual void SendWhole(int to, int tag, const void* data, std::size_t bytes) = 0;
  /// Non-blocking. A message of more than `capacity` bytes is an Error.
  virtual void ReceiveWhole(int from, int tag, void* data, std::size_t capacity) = 0;
  struct Arrival
  {
    std::size_t Posted = 0; ///< the how manieth call of `ReceiveWhole` since none was open, from 0
    std::size_t Bytes = 0;
  };
  /// Until one of the messages of `ReceiveWhole` is here. Throws Error when none is awaited.
  virtual Arrival WaitAnyWhole() = 0;
  /// The same, but does not wait: gives messages that are under way a push, and says whether one of
  /// `ReceiveWhole` is here. False when none is awaited.
  virtual bool TakeAnyWhole(Arrival& arrival) = 0;

  virtual void Barrier() = 0;
  virtual void Broadcast(int root, void* data, std::size_t bytes) = 0;
  /// `all` receives Size() * bytes.
  virtual void AllGather(const void* mine, std::size_t bytes, void* all) = 0;

  /// Collective: runs a part with messages between single ranks as a whole, in a thread that may
  /// send them. Whoever draws sends such messages in a part, and completes them there.
  /// @param part is given the communicator to use in it
  /// Throws what the part throws.
  virtual void Together(const std::function<void(Communicator& ranks)>& part) { part(*this); }
  /// Whether messages between single ranks may be sent outside of such a part, too.
  virtual bool SendsAtOnce() const { return true; }

  /// Collective: ranks on this machine, this one included. Simulated ranks are on one machine.
  virtual int RanksOnThisNode() { return this->Size(); }

  /// Collective among ranks that give up what they were at, each by an error. Where that can be
  /// found out (MPI), the job ends when the others have not failed and would wait for ever.
  /// @param why this rank's error
  virtual void LeaveTogether(const std::string& why);
};

std::unique_ptr<Communicator> MakeSelfCommunicator();

/// Runs `body` on `size` simulated ranks (one thread each) and returns when all have ended; the
/// first exception is thrown again (and the other ranks are released with an Error).
void RunOnSimulatedRanks(int size, const std::function<void(Communicator&)>& body);

/// Gathers one string per rank, on every rank.
std::vector<std::string> AllGatherStrings(Communicator& communicator, const std::string& mine);

/// The strings that rank 0 gives, on every rank; those of the others do not count.
std::vector<std::string> BroadcastStrings(
  Communicator& communicator, std::vector<std::string> ofRankZero);

/// Collective. Returns when all ranks have called it. MPI's own calls keep a core busy while they
/// wait; this one sleeps, so that threads which work in the background get it. No message of
/// `ReceiveWhole` may be open.
/// @param tick called again and again meanwhile
void Meet(Communicator& communicator, const std::function<void()>& tick);

/// Sum or maximum over all ranks, on every rank (summed in rank order: the same bits everywhere).
double AllSum(Communicator& communicator, double mine);
double AllMax(Communicator& communicator, double mine);
std::vector<double> AllGatherValues(Communicator& communicator, double mine);

/// Collective: all ranks learn whether one of them failed.
/// @param mine this rank's error sentence; empty if all is well
/// @return empty if no rank failed; else the sentence of the lowest failing rank, which names it
/// once: what all ranks have agreed on before stays as it is
std::string AgreeOnError(Communicator& communicator, const std::string& mine);

/// The same for those who have gathered the sentences with other things.
/// @param all the sentences of the ranks, in their order
std::string AgreedError(const std::vector<std::string>& all);

} // namespace banyan

#endif
