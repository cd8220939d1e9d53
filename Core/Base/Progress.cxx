#include "Base/Progress.h"

namespace banyan
{

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

} // namespace banyan
