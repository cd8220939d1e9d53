// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Communicate/Communicator.h"

#include "Base/Error.h"

#include <algorithm>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <tuple>

namespace banyan
{
namespace
{

// Tags of the collective operations, apart from those of the caller (which are not negative).
constexpr int TagGather = -1;
constexpr int TagBroadcast = -2;

/// The mailboxes that the simulated ranks share.
class Network
{
public:
  explicit Network(int size)
    : Awaited(static_cast<std::size_t>(size))
    , Ended(static_cast<std::size_t>(size), false)
  {
  }

  int Size() const { return static_cast<int>(this->Ended.size()); }

  void Put(int from, int to, int tag, const void* data, std::size_t bytes)
  {
    const char* begin = static_cast<const char*>(data);
    std::vector<char> message(begin, begin + bytes);
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Messages[Key{ from, to, tag }].push_back(std::move(message));
    this->Changed.notify_all();
  }

  using Key = std::tuple<int, int, int>; // from, to, tag

  /// Waits until a message of one of the keys is here, and takes it.
  /// @return which key, the first one of those that have a message
  std::size_t TakeAny(int to, const std::vector<Key>& keys, std::vector<char>& message)
  {
    std::unique_lock<std::mutex> lock(this->Mutex);
    const auto arrived = [&](const Key& key) { return this->Arrived(key); };
    const auto found = [&] { return std::find_if(keys.begin(), keys.end(), arrived); };
    this->Awaited[to] = keys;
    this->ReleaseIfStuck();
    this->Changed.wait(lock, [&] { return this->Released || found() != keys.end(); });
    this->Awaited[to].clear();
    const auto key = found();
    if (key == keys.end())
    {
      throw Error(this->Released->empty() ? "Another rank failed, so this one cannot go on."
                                          : *this->Released);
    }
    this->Pop(*key, message);
    return static_cast<std::size_t>(key - keys.begin());
  }

  /// Takes a message of one of the keys if one is here. @return which key; none: how many there are
  std::size_t TakeIfHere(const std::vector<Key>& keys, std::vector<char>& message)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    const auto key = std::find_if(
      keys.begin(), keys.end(), [&](const Key& wanted) { return this->Arrived(wanted); });
    if (key != keys.end())
    {
      this->Pop(*key, message);
    }
    return static_cast<std::size_t>(key - keys.begin());
  }

  void Take(int from, int to, int tag, void* data, std::size_t bytes)
  {
    std::vector<char> message;
    this->TakeAny(to, { Key{ from, to, tag } }, message);
    if (message.size() != bytes)
    {
      ErrorPlace place;
      place.Found = message.size();
      place.Allowed = bytes;
      throw Error("Rank " + std::to_string(to) + " received a message from rank " +
                    std::to_string(from) + " of another size than it expected.",
        place);
    }
    if (bytes > 0)
    {
      std::memcpy(data, message.data(), bytes);
    }
  }

  void End(int rank)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Ended[rank] = true;
    this->ReleaseIfStuck();
  }

  void Fail(std::exception_ptr exception)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    if (!this->First)
    {
      this->First = std::move(exception);
    }
    if (!this->Released)
    {
      this->Released = std::string();
    }
    this->Changed.notify_all();
  }

  std::exception_ptr FirstException() const { return this->First; }

private:
  void Pop(const Key& key, std::vector<char>& message)
  {
    std::deque<std::vector<char>>& queue = this->Messages[key];
    message = std::move(queue.front());
    queue.pop_front();
  }

  bool Arrived(const Key& key) const
  {
    const auto found = this->Messages.find(key);
    return found != this->Messages.end() && !found->second.empty();
  }

  /// A mistake in a parallel algorithm must end a test, not hang it: when every rank has ended or
  /// waits for a message that is not there, nobody can ever send it.
  void ReleaseIfStuck()
  {
    std::optional<Key> waits;
    for (std::size_t rank = 0; rank < this->Ended.size(); ++rank)
    {
      const std::vector<Key>& keys = this->Awaited[rank];
      if (this->Ended[rank])
      {
        continue;
      }
      const auto arrived = [this](const Key& key) { return this->Arrived(key); };
      if (keys.empty() || std::any_of(keys.begin(), keys.end(), arrived))
      {
        return;
      }
      waits = keys.front();
    }
    if (waits && !this->Released)
    {
      this->Released = "All ranks wait and nobody sends: rank " +
                       std::to_string(std::get<1>(*waits)) + " expects a message from rank " +
                       std::to_string(std::get<0>(*waits)) + " with tag " +
                       std::to_string(std::get<2>(*waits)) + ".";
      this->Changed.notify_all();
    }
  }

  std::mutex Mutex;
  std::condition_variable Changed;
  std::map<Key, std::deque<std::vector<char>>> Messages;
  std::vector<std::vector<Key>> Awaited; ///< per rank that waits, for which messages
  std::vector<bool> Ended;
  std::optional<std::string> Released; ///< set: waiting is over; the reason if there is one to tell
  std::exception_ptr First;
};

class SimulatedCommunicator final : public Communicator
{
public:
  SimulatedCommunicator(std::shared_ptr<Network> network, int rank)
    : Shared(std::move(network))
    , Self(rank)
  {
  }

  int Rank() const override { return this->Self; }
  int Size() const override { return this->Shared->Size(); }

  void Send(int to, int tag, const void* data, std::size_t bytes) override
  {
    this->Check(to, tag);
    this->Shared->Put(this->Self, to, tag, data, bytes);
  }

  void Receive(int from, int tag, void* data, std::size_t bytes) override
  {
    this->Check(from, tag);
    this->Pending.push_back({ from, tag, data, bytes });
  }

  void WaitAll() override
  {
    // Taken away first, so that an exception leaves nothing behind that points to dead memory.
    const std::vector<PostedReceive> pending = std::move(this->Pending);
    this->Pending.clear();
    for (const PostedReceive& posted : pending)
    {
      this->Shared->Take(posted.From, this->Self, posted.Tag, posted.Data, posted.Bytes);
    }
  }

  void SendWhole(int to, int tag, const void* data, std::size_t bytes) override
  {
    this->Send(to, tag, data, bytes);
  }

  void ReceiveWhole(int from, int tag, void* data, std::size_t capacity) override
  {
    this->Check(from, tag);
    if (this->OpenKeys.empty())
    {
      this->Posted.clear();
    }
    this->OpenKeys.push_back(Network::Key{ from, this->Self, tag });
    this->OpenIndices.push_back(this->Posted.size());
    this->Posted.push_back({ from, tag, data, capacity });
  }

  Arrival WaitAnyWhole() override
  {
    if (this->OpenKeys.empty())
    {
      throw Error("Rank " + std::to_string(this->Self) + " waits, but awaits no message.");
    }
    std::vector<char> message;
    const std::size_t which = this->Shared->TakeAny(this->Self, this->OpenKeys, message);
    return this->Deliver(which, message);
  }

  bool TakeAnyWhole(Arrival& arrival) override
  {
    std::vector<char> message;
    const std::size_t which = this->Shared->TakeIfHere(this->OpenKeys, message);
    const bool here = which < this->OpenKeys.size();
    if (here)
    {
      arrival = this->Deliver(which, message);
    }
    return here;
  }

  void Barrier() override
  {
    const char mine = 0;
    std::vector<char> all(static_cast<std::size_t>(this->Size()));
    this->AllGather(&mine, 1, all.data());
  }

  void Broadcast(int root, void* data, std::size_t bytes) override
  {
    this->Check(root, 0);
    if (this->Self != root)
    {
      this->Shared->Take(root, this->Self, TagBroadcast, data, bytes);
      return;
    }
    for (int rank = 0; rank < this->Size(); ++rank)
    {
      if (rank != root)
      {
        this->Shared->Put(root, rank, TagBroadcast, data, bytes);
      }
    }
  }

  void AllGather(const void* mine, std::size_t bytes, void* all) override
  {
    char* const places = static_cast<char*>(all);
    for (int rank = 0; rank < this->Size(); ++rank)
    {
      if (rank != this->Self)
      {
        this->Shared->Put(this->Self, rank, TagGather, mine, bytes);
      }
    }
    std::copy_n(static_cast<const char*>(mine), bytes, places + this->Self * bytes);
    for (int rank = 0; rank < this->Size(); ++rank)
    {
      if (rank != this->Self)
      {
        this->Shared->Take(rank, this->Self, TagGather, places + rank * bytes, bytes);
      }
    }
  }

private:
  struct PostedReceive
  {
    int From;
    int Tag;
    void* Data;
    std::size_t Bytes;
  };

  /// The message of one of OpenKeys goes to where it was posted.
  Arrival Deliver(std::size_t which, const std::vector<char>& message)
  {
    const std::size_t index = this->OpenIndices[which];
    const PostedReceive posted = this->Posted[index];
    this->OpenKeys.erase(this->OpenKeys.begin() + static_cast<std::ptrdiff_t>(which));
    this->OpenIndices.erase(this->OpenIndices.begin() + static_cast<std::ptrdiff_t>(which));
    if (message.size() > posted.Bytes)
    {
      ErrorPlace place;
      place.Found = message.size();
      place.Allowed = posted.Bytes;
      throw Error("Rank " + std::to_string(this->Self) + " received a message from rank " +
                    std::to_string(posted.From) + " that is longer than it expected.",
        place);
    }
    std::copy(message.begin(), message.end(), static_cast<char*>(posted.Data));
    return { index, message.size() };
  }

  void Check(int rank, int tag) const
  {
    if (rank < 0 || rank >= this->Size())
    {
      throw Error("There is no rank " + std::to_string(rank) + " among " +
                  std::to_string(this->Size()) + " ranks.");
    }
    if (tag < 0)
    {
      throw Error("A message tag must not be negative, as " + std::to_string(tag) + " is.");
    }
  }

  std::shared_ptr<Network> Shared;
  int Self;
  std::vector<PostedReceive> Pending;
  std::vector<PostedReceive> Posted;    ///< by ReceiveWhole, since none was open
  std::vector<Network::Key> OpenKeys;   ///< of those not here yet
  std::vector<std::size_t> OpenIndices; ///< and which they are in Posted
};

} // namespace

std::unique_ptr<Communicator> MakeSelfCommunicator()
{
  return std::make_unique<SimulatedCommunicator>(std::make_shared<Network>(1), 0);
}

void RunOnSimulatedRanks(int size, const std::function<void(Communicator&)>& body)
{
  if (size < 1)
  {
    throw Error("At least one rank is needed, not " + std::to_string(size) + ".");
  }
  const auto network = std::make_shared<Network>(size);
  const auto run = [&](int rank)
  {
    SimulatedCommunicator communicator(network, rank);
    try
    {
      body(communicator);
    }
    catch (...)
    {
      network->Fail(std::current_exception());
    }
    network->End(rank);
  };
  std::vector<std::thread> others;
  for (int rank = 1; rank < size; ++rank)
  {
    others.emplace_back(run, rank);
  }
  run(0);
  for (std::thread& other : others)
  {
    other.join();
  }
  if (network->FirstException())
  {
    std::rethrow_exception(network->FirstException());
  }
}

} // namespace banyan
