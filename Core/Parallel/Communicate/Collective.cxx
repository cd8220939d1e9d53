// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Communicate/Collective.h"

#include "Parallel/Communicate/Communicator.h"

namespace banyan
{

void ThrowTogether(Communicator& communicator, const std::string& failure)
{
  const std::string agreed = AgreeOnError(communicator, failure);
  if (!agreed.empty())
  {
    throw CollectiveError(agreed);
  }
}

void Collective(Communicator& communicator, const std::function<void()>& action)
{
  std::string failure;
  try
  {
    action();
  }
  catch (const std::exception& error)
  {
    failure = error.what();
  }
  ThrowTogether(communicator, failure);
}

} // namespace banyan
