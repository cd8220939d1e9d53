// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/Scalar/ScalarSymbols.h"

namespace banyan::scalar
{

std::vector<State> StatesFrom(const tans::Frequencies& frequencies)
{
  std::vector<int> symbolAt(512, 0);
  int place = 0;
  bool any = false;
  for (int symbol = 0; symbol < 72; ++symbol)
  {
    for (int i = 0; i < frequencies.Count[symbol]; ++i)
    {
      symbolAt[static_cast<std::size_t>(place)] = symbol;
      place = (place + 323) % 512;
      any = true;
    }
  }
  std::vector<State> states(512, { 0, 0, 0 });
  std::array<int, 72> seen = {};
  for (std::size_t i = 0; any && i < 512; ++i)
  {
    const int symbol = symbolAt[i];
    const int number = frequencies.Count[symbol] + seen[static_cast<std::size_t>(symbol)]++;
    int bits = 0;
    while (number * (1 << bits) < 512)
    {
      ++bits;
    }
    states[i] = { symbol, bits, number * (1 << bits) - 512 };
  }
  return states;
}

} // namespace banyan::scalar
