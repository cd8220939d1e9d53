// SPDX-License-Identifier: BSD-3-Clause
#include "Cache/BackgroundDecoder.h"

#include "Cache/BrickCache.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace banyan
{
namespace
{

/// Threads that draw get about ten times as much of a core as those that work ahead.
constexpr int Niceness = 10;

void LowerPriority()
{
#ifdef __linux__
  // The priority is that of this thread alone. Where lowering it is not allowed, nothing but time
  // is lost.
  (void)setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), Niceness);
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

  bool HasWork() const { return this->Field < this->Wanted.size(); }

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
      const FieldBricks& wanted = this->Wanted[this->Field];
      const std::shared_ptr<const SeriesFile> series = this->Series;
      const FieldKey field = wanted.Field;
      const bool some = this->Brick < wanted.Bricks.size();
      const std::int64_t brick = some ? wanted.Bricks[this->Brick] : -1;
      this->Field += some ? 0 : 1;
      this->Brick = some ? this->Brick + 1 : 0;
      if (some)
      {
        ++this->Busy;
        lock.unlock();
        const std::uint64_t bytes = this->Decode(*series, field, brick);
        lock.lock();
        --this->Busy;
        this->Took(bytes);
      }
      this->Changed.notify_all();
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
  Internals& self = *this->Self;
  {
    const std::lock_guard<std::mutex> lock(self.Mutex);
    self.Drop();
    if (mostBytes > 0)
    {
      self.Series = std::move(series);
      self.Wanted = std::move(wanted);
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
