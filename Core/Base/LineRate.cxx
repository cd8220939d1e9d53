// SPDX-License-Identifier: BSD-3-Clause
#include "Base/LineRate.h"

#include <algorithm>

namespace banyan
{

void LineRate::Came(const Message& message)
{
  constexpr std::size_t few = 20000; // say little about a line
  constexpr double shortest = 0.001; // what lay here in a buffer comes in no time
  constexpr double mostOfLine = 1e9;
  if (message.Burst != this->First.Burst)
  {
    this->First = message;
    this->SinceFirst = 0;
    this->Before = this->Rate;
    return;
  }
  this->SinceFirst += message.Bytes;
  if (this->SinceFirst < few)
  {
    return;
  }
  const auto bytes = static_cast<double>(this->SinceFirst);
  const double longest = message.Latest - this->First.Earliest; // that they may have taken
  const double slowest = bytes / std::max(shortest, longest);
  double quickest = mostOfLine;
  if (message.Earliest > this->First.Latest)
  {
    const double least = message.Earliest - this->First.Latest;
    quickest = bytes / std::max(shortest, 0.5 * (least + longest));
  }
  const double wanted = message.IsCut ? 2.0 * this->Before : this->Before;
  this->Rate = std::min(std::max(std::min(wanted, quickest), slowest), mostOfLine);
}

int LineRate::Credit(double seconds) const
{
  constexpr double part = 0.75;
  constexpr double least = 12000.0;
  constexpr double most = 1e8;
  return static_cast<int>(std::clamp(part * this->Rate * seconds, least, most));
}

} // namespace banyan
