// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/DecodeStages.h"

#include <hwy/base.h>

#include <chrono>

#if HWY_ARCH_X86
#include <immintrin.h>
#endif

namespace banyan::stages
{

const char* TextOf(int stage)
{
  static const char* const texts[Count] = { "elsewhere", "tables", "asking for boxes",
    "cache of boxes", "coarser plane", "plain blocks, shared faces", "opening payloads", "edges",
    "faces: copies", "faces: passes", "faces: contexts", "references", "rows with symbols",
    "contexts", "symbols", "residuals", "interiors: passes", "order of axes", "values",
    "bricks of one value" };
  return texts[stage];
}

namespace
{

std::uint64_t Read()
{
#if HWY_ARCH_X86
  return __rdtsc();
#else
  return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
#endif
}

} // namespace

double TicksPerSecond()
{
  using Steady = std::chrono::steady_clock;
  const auto begin = Steady::now();
  const std::uint64_t ticks = Read();
  std::chrono::duration<double> passed{};
  while (passed.count() < 0.05)
  {
    passed = Steady::now() - begin;
  }
  return static_cast<double>(Read() - ticks) / passed.count();
}

#ifdef BANYAN_STAGES
thread_local Clock Own;

void Clock::Switch(int stage)
{
  const std::uint64_t now = Read();
  this->All.Ticks[this->Now] += this->Since == 0 ? 0 : now - this->Since;
  this->Since = now;
  this->Now = stage;
}

bool Counted()
{
  return true;
}
Spent OfThisThread()
{
  Own.Switch(Own.Now);
  return Own.All;
}
#else
bool Counted()
{
  return false;
}
Spent OfThisThread()
{
  return {};
}
#endif

} // namespace banyan::stages
