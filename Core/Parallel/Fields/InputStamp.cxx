// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/InputStamp.h"

#include "Parallel/Communicate/Communicator.h"

#include <utility>

namespace banyan
{

bool InputStamp::Become(Communicator& communicator, InputStamp now)
{
  const bool changed = *this != now;
  *this = std::move(now);
  return AllMax(communicator, changed ? 1.0 : 0.0) > 0.0;
}

} // namespace banyan
