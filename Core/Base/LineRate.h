// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_LineRate_h
#define banyan_Base_LineRate_h

#include <cstddef>

namespace banyan
{

/// How many bytes a second a line takes, measured where messages arrive. They are sent in bursts:
/// each by itself as fast as the line takes them.
class LineRate
{
public:
  /// A message has come.
  /// @param burst number of its burst
  /// @param seconds by any clock
  void Came(int burst, std::size_t bytes, double seconds);

  /// Bytes a second. Before anything was measured, those of a slow line; it at most doubles from
  /// burst to burst.
  double BytesPerSecond() const { return this->Rate; }

  /// What may be sent in an interval, so that a quarter of the line is left to others.
  /// @param seconds that nothing else is sent for
  /// @return at least one message's bytes
  int Credit(double seconds) const;

private:
  double Rate = 1e6;
  int Burst = 0;
  double First = 0.0;         ///< second of the burst's first message
  std::size_t SinceFirst = 0; ///< bytes of the messages after it
  double Before = 1e6;        ///< the burst
};

} // namespace banyan

#endif
