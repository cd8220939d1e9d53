// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_LineRate_h
#define banyan_Base_LineRate_h

#include <cstddef>

namespace banyan
{

/// How many bytes a second a line takes, measured where messages arrive. They are sent in bursts:
/// each by itself as fast as the line takes them. Whoever measures looks at the line now and then,
/// so that he knows between which seconds a message has come, and no more.
class LineRate
{
public:
  struct Message
  {
    int Burst; ///< its number
    std::size_t Bytes;
    double Earliest;    ///< second before which it was not there, by any clock
    double Latest;      ///< second at which it was
    bool IsCut = false; ///< whether more would have been sent, if there had been credit
  };

  /// A message has come.
  void Came(const Message& message);

  /// Bytes a second. Before anything was measured, those of a slow line. It is never less than what
  /// has certainly come, and doubles with bursts that had too little credit, while nothing says
  /// that the line is slower.
  double BytesPerSecond() const { return this->Rate; }

  /// What may be sent in an interval, so that a quarter of the line is left to others.
  /// @param seconds that nothing else is sent for
  /// @return at least one message's bytes
  int Credit(double seconds) const;

private:
  double Rate = 1e6;
  double Before = 1e6; ///< the burst
  Message First{ 0, 0, 0.0, 0.0 };
  std::size_t SinceFirst = 0; ///< bytes of the messages after it
};

} // namespace banyan

#endif
