// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/TokenHistogram.h"

namespace banyan
{

void TokenHistogram::Add(const std::vector<std::uint16_t>& tokens)
{
  std::uint32_t* const first = this->Of.data();
  std::uint32_t* const second = first + this->Of.size() / Tables;
  std::size_t i = 0;
  for (; i + 2 <= tokens.size(); i += 2)
  {
    ++first[tokens[i]];
    ++second[tokens[i + 1]];
  }
  if (i < tokens.size())
  {
    ++first[tokens[i]];
  }
}

ContextCounts TokenHistogram::Counts() const
{
  const std::uint32_t* const first = this->Of.data();
  const std::uint32_t* const second = first + this->Of.size() / Tables;
  ContextCounts counts;
  for (std::size_t c = 0; c < counts.Of.size(); ++c)
  {
    for (std::size_t s = 0; s < counts.Of[c].size(); ++s)
    {
      const std::size_t token = (c << residual::TokenShift) + s;
      counts.Of[c][s] = first[token] + second[token];
    }
  }
  return counts;
}

} // namespace banyan
