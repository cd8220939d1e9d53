// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Progress.h"

namespace banyan
{
namespace
{

thread_local const char ThisThread = 0;
/// Which thread draws: the address of its own; null for none.
std::atomic<const char*> Drawing{ nullptr };

} // namespace

const char* NameOf(Phase phase)
{
  switch (phase)
  {
    case Phase::Beginning:
      return "beginning a frame";
    case Phase::Fetching:
      return "fetching bricks";
    case Phase::Sampling:
      return "finding out how to sample";
    case Phase::Casting:
      return "casting rays";
    case Phase::Compositing:
      return "compositing";
    case Phase::Balancing:
      return "balancing zones";
    default:
      return "outside of drawing";
  }
}

std::atomic<std::uint64_t>& Progress::Count() noexcept
{
  static std::atomic<std::uint64_t> count{ 0 };
  return count;
}

std::atomic<Phase>& Progress::Current() noexcept
{
  static std::atomic<Phase> phase{ Phase::Outside };
  return phase;
}

std::atomic<std::uint32_t>& Progress::Waited() noexcept
{
  static std::atomic<std::uint32_t> waited{ 0 };
  return waited;
}

PhaseScope::PhaseScope(Phase phase)
{
  const char* nobody = nullptr;
  this->First = Drawing.compare_exchange_strong(nobody, &ThisThread);
  this->Counts = this->First || Drawing == &ThisThread;
  if (this->Counts)
  {
    Progress::Note();
    this->Before = Progress::Current().exchange(phase);
  }
}

PhaseScope::~PhaseScope()
{
  if (this->Counts)
  {
    Progress::Note();
    Progress::Current() = this->Before;
  }
  if (this->First)
  {
    Drawing = nullptr;
  }
}

} // namespace banyan
