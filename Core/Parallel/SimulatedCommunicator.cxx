#include "Parallel/Communicator.h"

#include "Base/Error.h"

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

  void Take(int from, int to, int tag, void* data, std::size_t bytes)
  {
    const Key key{ from, to, tag };
    std::unique_lock<std::mutex> lock(this->Mutex);
    this->Awaited[to] = key;
    this->ReleaseIfStuck();
    this->Changed.wait(lock, [&] { return this->Released || this->Arrived(key); });
    this->Awaited[to].reset();
    if (!this->Arrived(key))
    {
      throw Error(this->Released->empty() ? "Another rank failed, so this one cannot go on."
                                          : *this->Released);
    }
    std::deque<std::vector<char>>& queue = this->Messages[key];
    const std::vector<char> message = std::move(queue.front());
    queue.pop_front();
    lock.unlock();
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
      this->First = exception;
    }
    if (!this->Released)
    {
      this->Released = std::string();
    }
    this->Changed.notify_all();
  }

  std::exception_ptr FirstException() const { return this->First; }

private:
  using Key = std::tuple<int, int, int>; // from, to, tag

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
      const std::optional<Key>& key = this->Awaited[rank];
      if (this->Ended[rank])
      {
        continue;
      }
      if (!key || this->Arrived(*key))
      {
        return;
      }
      waits = key;
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
  std::vector<std::optional<Key>> Awaited;
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
    for (int rank = 0; rank < this->Size(); ++rank)
    {
      this->Shared->Put(this->Self, rank, TagGather, mine, bytes);
    }
    for (int rank = 0; rank < this->Size(); ++rank)
    {
      this->Shared->Take(
        rank, this->Self, TagGather, static_cast<char*>(all) + rank * bytes, bytes);
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
