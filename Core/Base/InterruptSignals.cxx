// SPDX-License-Identifier: BSD-3-Clause
#include "Base/InterruptSignals.h"

#include <atomic>
#include <csignal>
#include <mutex>

namespace banyan
{
namespace
{

constexpr int Signals[] = { SIGINT, SIGTERM };

// A handler may only touch what is free of locks.
std::atomic<int> Latest{ 0 };
static_assert(std::atomic<int>::is_always_lock_free);

std::mutex CountMutex;
int Count = 0;
struct sigaction Before[2] = {};

void Note(int signal)
{
  Latest = signal;
}

} // namespace

InterruptSignals::InterruptSignals()
{
  const std::lock_guard<std::mutex> lock(CountMutex);
  if (Count++ > 0)
  {
    return;
  }
  Latest = 0;
  for (int i = 0; i < 2; ++i)
  {
    struct sigaction note = {};
    note.sa_handler = Note;
    note.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
    sigemptyset(&note.sa_mask);
    sigaction(Signals[i], nullptr, &Before[i]);
    if (Before[i].sa_handler != SIG_IGN)
    {
      sigaction(Signals[i], &note, nullptr);
    }
  }
}

InterruptSignals::~InterruptSignals()
{
  const std::lock_guard<std::mutex> lock(CountMutex);
  if (--Count > 0)
  {
    return;
  }
  for (int i = 0; i < 2; ++i)
  {
    sigaction(Signals[i], &Before[i], nullptr);
  }
}

bool InterruptSignals::Came()
{
  return Latest != 0;
}

int InterruptSignals::Last()
{
  return Latest;
}

} // namespace banyan
