// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Communicate/MpiCommunicator.h"

#include "Base/Error.h"
#include "Parallel/Watchdog/MpiError.h"
#include "Parallel/Watchdog/MpiWatchdog.h"

#include <algorithm>
#include <limits>

namespace banyan
{

namespace
{

MPI_Comm HandleAt(const void* mpiComm)
{
  if (!mpiComm)
  {
    throw Error("No MPI communicator was given.");
  }
  return *static_cast<const MPI_Comm*>(mpiComm);
}

/// Calls `part(offset, count)` for consecutive parts of at most `limit` bytes; once for 0 bytes.
template <typename Part>
void ForEachPart(std::size_t bytes, std::size_t limit, const Part& part)
{
  std::size_t offset = 0;
  do
  {
    const std::size_t count = std::min(limit, bytes - offset);
    part(offset, static_cast<int>(count));
    offset += count;
  } while (offset < bytes);
}

class MpiCommunicator final : public Communicator
{
public:
  MpiCommunicator(MPI_Comm original, std::size_t largestMessage, const MpiTimeout& timeout)
    : LargestMessage(largestMessage)
  {
    CheckMpi(MPI_Comm_dup(original, &this->Handle), "duplicate a communicator");
    // Errors of the duplicate come back as codes, to be thrown; the original keeps its handler.
    MPI_Comm_set_errhandler(this->Handle, MPI_ERRORS_RETURN);
    MPI_Comm_rank(this->Handle, &this->Self);
    MPI_Comm_size(this->Handle, &this->Ranks);
    this->Watchdog = MpiWatchdog::Attach(this->Handle, timeout);
  }

  ~MpiCommunicator() override
  {
    this->Watchdog.reset();
    int finalized = 0;
    MPI_Finalized(&finalized);
    if (finalized)
    {
      return;
    }
    // Only after an exception: nothing may be written to memory that is no longer there.
    for (std::vector<MPI_Request>* requests : { &this->Pending, &this->Awaited })
    {
      for (MPI_Request& request : *requests)
      {
        if (request != MPI_REQUEST_NULL)
        {
          MPI_Cancel(&request);
          MPI_Request_free(&request);
        }
      }
    }
    MPI_Comm_free(&this->Handle);
  }

  int Rank() const override { return this->Self; }
  int Size() const override { return this->Ranks; }

  void Send(int to, int tag, const void* data, std::size_t bytes) override
  {
    const char* begin = static_cast<const char*>(data);
    ForEachPart(bytes, this->LargestMessage,
      [&](std::size_t offset, int count)
      {
        this->Post([&](MPI_Request* request)
          { return MPI_Isend(begin + offset, count, MPI_BYTE, to, tag, this->Handle, request); });
      });
  }

  void Receive(int from, int tag, void* data, std::size_t bytes) override
  {
    char* begin = static_cast<char*>(data);
    ForEachPart(bytes, this->LargestMessage,
      [&](std::size_t offset, int count)
      {
        this->Post([&](MPI_Request* request)
          { return MPI_Irecv(begin + offset, count, MPI_BYTE, from, tag, this->Handle, request); });
        this->Expected.back() = count;
      });
  }

  void WaitAll() override
  {
    std::vector<MPI_Request> requests = std::move(this->Pending);
    const std::vector<int> expected = std::move(this->Expected);
    this->Pending.clear();
    this->Expected.clear();
    std::vector<MPI_Status> statuses(requests.size());
    const int code = this->CompleteAll(requests, statuses);
    for (std::size_t i = 0; i < statuses.size(); ++i)
    {
      CheckMpi(code == MPI_ERR_IN_STATUS ? statuses[i].MPI_ERROR : code, "complete a message");
      int count = 0;
      MPI_Get_count(&statuses[i], MPI_BYTE, &count);
      if (expected[i] >= 0 && count != expected[i])
      {
        ErrorPlace place;
        place.Found = static_cast<std::uint64_t>(count);
        place.Allowed = static_cast<std::uint64_t>(expected[i]);
        throw Error("Rank " + std::to_string(this->Self) + " received a message from rank " +
                      std::to_string(statuses[i].MPI_SOURCE) + " of another size than it expected.",
          place);
      }
    }
  }

  void SendWhole(int to, int tag, const void* data, std::size_t bytes) override
  {
    const int count = CountOf(bytes);
    this->Post([&](MPI_Request* request)
      { return MPI_Isend(data, count, MPI_BYTE, to, tag, this->Handle, request); });
  }

  void ReceiveWhole(int from, int tag, void* data, std::size_t capacity) override
  {
    const int count = CountOf(capacity);
    if (this->Open == 0)
    {
      this->Awaited.clear();
    }
    this->Awaited.push_back(MPI_REQUEST_NULL);
    CheckMpi(MPI_Irecv(data, count, MPI_BYTE, from, tag, this->Handle, &this->Awaited.back()),
      "start a message");
    ++this->Open;
  }

  Arrival WaitAnyWhole() override
  {
    int index = MPI_UNDEFINED;
    MPI_Status status;
    if (this->Open > 0)
    {
      CheckMpi(this->CompleteAny(index, status), "complete a message");
    }
    if (index == MPI_UNDEFINED)
    {
      throw Error("Rank " + std::to_string(this->Self) + " waits, but awaits no message.");
    }
    return this->ArrivalOf(index, status);
  }

  bool TakeAnyWhole(Arrival& arrival) override
  {
    int here = 0;
    if (this->Open == 0)
    {
      // Sends get on in calls of MPI only, whichever.
      CheckMpi(
        MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, this->Handle, &here, MPI_STATUS_IGNORE), "look");
      return false;
    }
    int index = MPI_UNDEFINED;
    MPI_Status status;
    CheckMpi(MPI_Testany(static_cast<int>(this->Awaited.size()), this->Awaited.data(), &index,
               &here, &status),
      "complete a message");
    if (!here || index == MPI_UNDEFINED)
    {
      return false;
    }
    arrival = this->ArrivalOf(index, status);
    return true;
  }

  void Barrier() override
  {
    this->Collective(
      "wait for all ranks", [this] { return MPI_Barrier(this->Handle); },
      [this](MPI_Request* request) { return MPI_Ibarrier(this->Handle, request); });
  }

  void Broadcast(int root, void* data, std::size_t bytes) override
  {
    char* begin = static_cast<char*>(data);
    ForEachPart(bytes, this->LargestMessage,
      [&](std::size_t offset, int count)
      {
        char* part = begin + offset;
        this->Collective(
          "broadcast", [&] { return MPI_Bcast(part, count, MPI_BYTE, root, this->Handle); },
          [&](MPI_Request* request)
          { return MPI_Ibcast(part, count, MPI_BYTE, root, this->Handle, request); });
      });
  }

  void AllGather(const void* mine, std::size_t bytes, void* all) override
  {
    if (bytes <= this->LargestMessage)
    {
      const int count = static_cast<int>(bytes);
      this->Collective(
        "gather",
        [&] { return MPI_Allgather(mine, count, MPI_BYTE, all, count, MPI_BYTE, this->Handle); },
        [&](MPI_Request* request) {
          return MPI_Iallgather(mine, count, MPI_BYTE, all, count, MPI_BYTE, this->Handle, request);
        });
      return;
    }
    char* target = static_cast<char*>(all);
    std::copy_n(static_cast<const char*>(mine), bytes, target + this->Self * bytes);
    for (int rank = 0; rank < this->Ranks; ++rank)
    {
      this->Broadcast(rank, target + rank * bytes, bytes);
    }
  }

  int RanksOnThisNode() override
  {
    MPI_Comm node = MPI_COMM_NULL;
    CheckMpi(MPI_Comm_split_type(this->Handle, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node),
      "find the ranks of this node");
    int ranks = 1;
    MPI_Comm_size(node, &ranks);
    MPI_Comm_free(&node);
    return ranks;
  }

  void LeaveTogether(const std::string& why) override
  {
    if (this->Watchdog)
    {
      this->Watchdog->LeaveTogether(why);
    }
  }

private:
  /// Returns the arrival of a complete message of ReceiveWhole.
  Arrival ArrivalOf(int index, const MPI_Status& status)
  {
    --this->Open;
    int count = 0;
    MPI_Get_count(&status, MPI_BYTE, &count);
    return { static_cast<std::size_t>(index), static_cast<std::size_t>(count) };
  }

  /// Waits as MPI_Waitall does. @return MPI's code
  int CompleteAll(std::vector<MPI_Request>& requests, std::vector<MPI_Status>& statuses)
  {
    const int count = static_cast<int>(requests.size());
    if (!this->Watchdog)
    {
      return MPI_Waitall(count, requests.data(), statuses.data());
    }
    int code = MPI_SUCCESS;
    this->Watchdog->Until(
      [&]
      {
        int done = 0;
        code = MPI_Testall(count, requests.data(), &done, statuses.data());
        return done != 0 || code != MPI_SUCCESS;
      });
    return code;
  }

  /// Waits as MPI_Waitany does, for the messages of ReceiveWhole.
  int CompleteAny(int& index, MPI_Status& status)
  {
    const int count = static_cast<int>(this->Awaited.size());
    if (!this->Watchdog)
    {
      return MPI_Waitany(count, this->Awaited.data(), &index, &status);
    }
    int code = MPI_SUCCESS;
    this->Watchdog->Until(
      [&]
      {
        int done = 0;
        code = MPI_Testany(count, this->Awaited.data(), &index, &done, &status);
        return done != 0 || code != MPI_SUCCESS;
      });
    return code;
  }

  /// @param wait the call that waits, as long as it takes
  /// @param start the same call that does not
  template <typename Wait, typename Start>
  void Collective(const char* action, const Wait& wait, const Start& start)
  {
    if (!this->Watchdog)
    {
      CheckMpi(wait(), action);
      return;
    }
    MPI_Request request = MPI_REQUEST_NULL;
    CheckMpi(start(&request), action);
    this->Watchdog->Until(
      [&]
      {
        int done = 0;
        CheckMpi(MPI_Test(&request, &done, MPI_STATUS_IGNORE), action);
        return done != 0;
      });
  }

  static int CountOf(std::size_t bytes)
  {
    constexpr std::size_t most = std::numeric_limits<int>::max();
    if (bytes > most)
    {
      ErrorPlace place;
      place.Found = bytes;
      place.Allowed = most;
      throw Error("A message that travels in one piece is too long.", place);
    }
    return static_cast<int>(bytes);
  }

  /// Makes room first: a request that has been started must never be forgotten.
  template <typename Start>
  void Post(const Start& start)
  {
    this->Pending.push_back(MPI_REQUEST_NULL);
    this->Expected.push_back(-1);
    const int code = start(&this->Pending.back());
    if (code != MPI_SUCCESS)
    {
      this->Pending.pop_back();
      this->Expected.pop_back();
      CheckMpi(code, "start a message");
    }
  }

  MPI_Comm Handle = MPI_COMM_NULL;
  int Self = 0;
  int Ranks = 1;
  std::size_t LargestMessage;
  std::unique_ptr<MpiWatchdog> Watchdog; ///< null: ranks are waited for as long as it takes
  std::vector<MPI_Request> Pending;
  std::vector<MPI_Request> Awaited; ///< of ReceiveWhole, since none was open
  std::size_t Open = 0;             ///< of these
  std::vector<int> Expected; ///< per pending request: bytes that must arrive, or -1 for a send
};

} // namespace

std::unique_ptr<Communicator> MakeMpiCommunicator(
  const void* mpiComm, std::size_t largestMessageBytes, const MpiTimeout& timeout)
{
  if (largestMessageBytes < 1 || largestMessageBytes > (std::size_t{ 1 } << 30))
  {
    ErrorPlace place;
    place.Found = largestMessageBytes;
    place.Allowed = std::size_t{ 1 } << 30;
    throw Error("One MPI message must hold between 1 byte and 1 GiB.", place);
  }
  return std::make_unique<MpiCommunicator>(HandleAt(mpiComm), largestMessageBytes, timeout);
}

} // namespace banyan
