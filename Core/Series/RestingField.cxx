// SPDX-License-Identifier: BSD-3-Clause
#include "Series/FieldGroupEncoder.h"

#include <algorithm>

namespace banyan
{

void LetRest(EncodedField& field, std::int64_t steps)
{
  field.Head.Rests = true;
  field.Head.Open = false;
  field.Head.Exact = false;
  for (std::vector<tans::Frequencies>& set : field.Head.Frequencies)
  {
    std::fill(set.begin(), set.end(), tans::Frequencies{});
  }
  FieldErrors& errors = field.Errors;
  for (std::int64_t* count :
    { &errors.Finite, &errors.NonFinite, &errors.Exceptions, &errors.Fill, &errors.Invisible })
  {
    *count *= steps;
  }
  errors.SumSquared *= static_cast<double>(steps);
  errors.SumWeighted *= static_cast<double>(steps);
  field.StepRmse.assign(static_cast<std::size_t>(steps), field.StepRmse.at(0));
  field.ChainSum *= steps;
  field.ChainBricks *= steps;
}

} // namespace banyan
