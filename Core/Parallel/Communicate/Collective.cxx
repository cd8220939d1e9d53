// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Communicate/Collective.h"

#include "Parallel/Communicate/Communicator.h"

#include <new>

namespace banyan
{

void Attempt(std::string& failure, const std::function<void()>& action, const std::string& noMemory)
{
  if (!failure.empty())
  {
    return;
  }
  try
  {
    action();
  }
  catch (const std::bad_alloc&)
  {
    failure = noMemory;
  }
  catch (const std::exception& error)
  {
    failure = error.what();
  }
}

void ThrowTogether(Communicator& communicator, const std::string& failure)
{
  const std::string agreed = AgreeOnError(communicator, failure);
  if (!agreed.empty())
  {
    throw CollectiveError(agreed);
  }
}

void Collective(
  Communicator& communicator, const std::function<void()>& action, const std::string& noMemory)
{
  std::string failure;
  Attempt(failure, action, noMemory);
  ThrowTogether(communicator, failure);
}

void CollectiveOn(int rank, Communicator& communicator, const std::function<void()>& action,
  const std::string& noMemory)
{
  const auto ofOne = [&]
  {
    if (rank == communicator.Rank())
    {
      action();
    }
  };
  Collective(communicator, ofOne, noMemory);
}

} // namespace banyan
