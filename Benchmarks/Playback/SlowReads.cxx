// SPDX-License-Identifier: BSD-3-Clause
// A disk that gives so many bytes a second, for LD_PRELOAD: reads of files wait for their turn.
// BANYAN_SLOW_MB_S says how many 10^6 bytes. What the system is told of later reads changes
// nothing, as on a file system that does not listen.
#include <dlfcn.h>
#include <sys/types.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <mutex>
#include <thread>

namespace
{

using Clock = std::chrono::steady_clock;

double BytesPerSecond()
{
  const char* const text = std::getenv("BANYAN_SLOW_MB_S");
  return text ? 1e6 * std::atof(text) : 0.0;
}

/// Waits until the disk has given these bytes, and those of all reads before.
void WaitFor(ssize_t bytes)
{
  static const double rate = BytesPerSecond();
  static std::mutex mutex;
  static Clock::time_point free = Clock::now();
  if (rate <= 0.0 || bytes <= 0)
  {
    return;
  }
  Clock::time_point done;
  {
    const std::lock_guard<std::mutex> lock(mutex);
    const auto takes = std::chrono::duration<double>(static_cast<double>(bytes) / rate);
    free = std::max(free, Clock::now()) + std::chrono::duration_cast<Clock::duration>(takes);
    done = free;
  }
  std::this_thread::sleep_until(done);
}

} // namespace

extern "C" ssize_t pread64(int file, void* to, size_t bytes, off64_t offset)
{
  using Function = ssize_t (*)(int, void*, size_t, off64_t);
  static const auto next = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "pread64"));
  const ssize_t got = next(file, to, bytes, offset);
  WaitFor(got);
  return got;
}

extern "C" ssize_t pread(int file, void* to, size_t bytes, off_t offset)
{
  return pread64(file, to, bytes, offset);
}
