// SPDX-License-Identifier: BSD-3-Clause
#include "Base/LineRate.h"

#include <algorithm>

namespace banyan
{

void LineRate::Came(int burst, std::size_t bytes, double seconds)
{
  constexpr std::size_t few = 20000; // say little about a line
  constexpr double shortest = 0.001; // what lay here in a buffer comes in no time
  constexpr double mostOfLine = 1e9;
  if (burst != this->Burst)
  {
    this->Burst = burst;
    this->First = seconds;
    this->SinceFirst = 0;
    this->Before = this->Rate;
    return;
  }
  this->SinceFirst += bytes;
  if (this->SinceFirst >= few)
  {
    const double now =
      static_cast<double>(this->SinceFirst) / std::max(shortest, seconds - this->First);
    this->Rate = std::min({ 0.5 * (this->Before + now), 2.0 * this->Before, mostOfLine });
  }
}

int LineRate::Credit(double seconds) const
{
  constexpr double part = 0.75;
  constexpr double least = 12000.0;
  constexpr double most = 1e8;
  return static_cast<int>(std::clamp(part * this->Rate * seconds, least, most));
}

} // namespace banyan
