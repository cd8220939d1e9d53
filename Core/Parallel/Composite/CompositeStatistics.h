// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_CompositeStatistics_h
#define banyan_Parallel_Composite_CompositeStatistics_h

#include <cstddef>
#include <cstdint>

namespace banyan
{

/// Says what one compositing took on this rank.
struct CompositeStatistics
{
  std::uint64_t BytesSent = 0;
  std::uint64_t BytesReceived = 0;
  std::uint64_t MessagesSent = 0;

  void Sent(std::size_t bytes)
  {
    this->BytesSent += bytes;
    ++this->MessagesSent;
  }
};

} // namespace banyan

#endif
