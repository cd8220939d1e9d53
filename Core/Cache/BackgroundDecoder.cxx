// SPDX-License-Identifier: BSD-3-Clause
#include "Cache/BackgroundDecoder.h"

#include "Cache/BrickCache.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include <pthread.h>
#include <sched.h>

namespace banyan
{
namespace
{

/// Others who want the core get it. Where the system cannot do that, nothing but time is lost.
void LowerPriority()
{
#ifdef SCHED_IDLE
  const sched_param none{};
  (void)pthread_setschedparam(pthread_self(), SCHED_IDLE, &none);
#endif
}

} // namespace

struct BackgroundDecoder::Internals
{
  BrickCache& Cache;
  int Width;
  std::vector<std::thread> Threads;

  std::mutex Mutex;
  std::condition_variable Changed;
  std::shared_ptr<const SeriesFile> Series;
  FindWanted Find; ///< gives Wanted; empty when it is known
  std::uint64_t Starts = 0;
  std::vector<FieldBricks> Wanted;
  std::size_t Field = 0; ///< the next brick to decode
  std::size_t Brick = 0;
  std::uint64_t BytesLeft = 0;
  int Busy = 0;
  bool Ends = false;

  Internals(BrickCache& cache, int width)
    : Cache(cache)
    , Width(std::max(width, 1))
  {
  }

  bool HasWork() const { return this->Find || this->Field < this->Wanted.size(); }

  void Work()
  {
    LowerPriority();
    std::unique_lock<std::mutex> lock(this->Mutex);
    while (true)
    {
      this->Changed.wait(lock, [this] { return this->Ends || this->HasWork(); });
      if (this->Ends)
      {
        return;
      }
      (this->Find ? LookForWork : DecodeNext)(*this, lock);
      this->Changed.notify_all();
    }
  }

  /// Under the lock, which is given up meanwhile.
  static void LookForWork(Internals& self, std::unique_lock<std::mutex>& lock)
  {
    const FindWanted find = std::exchange(self.Find, nullptr);
    const std::uint64_t start = self.Starts;
    ++self.Busy;
    lock.unlock();
    std::vector<FieldBricks> wanted;
    try
    {
      wanted = find();
    }
    catch (const std::exception&)
    {
      wanted.clear(); // whoever asks is told
    }
    lock.lock();
    --self.Busy;
    if (start == self.Starts)
    {
      self.Wanted = std::move(wanted);
    }
  }

  static void DecodeNext(Internals& self, std::unique_lock<std::mutex>& lock)
  {
    const FieldBricks& wanted = self.Wanted[self.Field];
    const std::shared_ptr<const SeriesFile> series = self.Series;
    const FieldKey field = wanted.Field;
    const bool some = self.Brick < wanted.Bricks.size();
    const std::int64_t brick = some ? wanted.Bricks[self.Brick] : -1;
    self.Field += some ? 0 : 1;
    self.Brick = some ? self.Brick + 1 : 0;
    if (some)
    {
      ++self.Busy;
      lock.unlock();
      const std::uint64_t bytes = self.Decode(*series, field, brick);
      lock.lock();
      --self.Busy;
      self.Took(bytes);
    }
  }

  void Took(std::uint64_t bytes)
  {
    this->BytesLeft -= std::min(this->BytesLeft, bytes);
    if (this->BytesLeft == 0)
    {
      this->Wanted.clear();
      this->Field = 0;
    }
  }

  /// @return bytes that the cache holds more
  std::uint64_t Decode(const SeriesFile& series, const FieldKey& field, std::int64_t brick)
  {
    try
    {
      return this->Cache.GetAhead(series, field, brick);
    }
    catch (const std::exception&)
    {
      return 0; // whoever asks for the brick is told
    }
  }

  void Drop()
  {
    ++this->Starts;
    this->Find = nullptr;
    this->Wanted.clear();
    this->Field = this->Brick = 0;
  }
};

BackgroundDecoder::BackgroundDecoder(BrickCache& cache, int threads)
  : Self(std::make_unique<Internals>(cache, threads))
{
}

BackgroundDecoder::~BackgroundDecoder()
{
  {
    const std::lock_guard<std::mutex> lock(this->Self->Mutex);
    this->Self->Drop();
    this->Self->Ends = true;
  }
  this->Self->Changed.notify_all();
  for (std::thread& thread : this->Self->Threads)
  {
    thread.join();
  }
}

void BackgroundDecoder::Start(std::shared_ptr<const SeriesFile> series,
  std::vector<FieldBricks> wanted, std::uint64_t mostBytes)
{
  this->Start(
    std::move(series), [wanted = std::move(wanted)] { return wanted; }, mostBytes);
}

void BackgroundDecoder::Start(
  std::shared_ptr<const SeriesFile> series, FindWanted findWanted, std::uint64_t mostBytes)
{
  Internals& self = *this->Self;
  {
    const std::lock_guard<std::mutex> lock(self.Mutex);
    self.Drop();
    if (mostBytes > 0)
    {
      self.Series = std::move(series);
      self.Find = std::move(findWanted);
      self.BytesLeft = mostBytes;
    }
  }
  while (static_cast<int>(self.Threads.size()) < self.Width)
  {
    self.Threads.emplace_back([&self] { self.Work(); });
  }
  self.Changed.notify_all();
}

void BackgroundDecoder::Stop()
{
  const std::lock_guard<std::mutex> lock(this->Self->Mutex);
  this->Self->Drop();
  this->Self->Series.reset();
}

void BackgroundDecoder::Finish()
{
  std::unique_lock<std::mutex> lock(this->Self->Mutex);
  this->Self->Changed.wait(
    lock, [this] { return this->Self->Busy == 0 && !this->Self->HasWork(); });
}

} // namespace banyan
