// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Communicate/Communicator.h"

#include <algorithm>

namespace banyan
{

void Communicator::LeaveTogether(const std::string&) {}

std::vector<std::string> AllGatherStrings(Communicator& communicator, const std::string& mine)
{
  const std::size_t ranks = static_cast<std::size_t>(communicator.Size());
  const std::uint64_t length = mine.size();
  std::vector<std::uint64_t> lengths(ranks);
  communicator.AllGather(&length, sizeof(length), lengths.data());

  std::vector<std::string> all(ranks);
  const std::size_t longest = *std::max_element(lengths.begin(), lengths.end());
  if (longest == 0)
  {
    return all;
  }
  std::string padded = mine;
  padded.resize(longest);
  std::string gathered(longest * ranks, '\0');
  communicator.AllGather(padded.data(), longest, &gathered[0]);
  for (std::size_t rank = 0; rank < ranks; ++rank)
  {
    all[rank] = gathered.substr(rank * longest, lengths[rank]);
  }
  return all;
}

std::vector<double> AllGatherValues(Communicator& communicator, double mine)
{
  std::vector<double> all(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&mine, sizeof(mine), all.data());
  return all;
}

double AllSum(Communicator& communicator, double mine)
{
  double sum = 0.0;
  for (const double value : AllGatherValues(communicator, mine))
  {
    sum += value;
  }
  return sum;
}

double AllMax(Communicator& communicator, double mine)
{
  const std::vector<double> all = AllGatherValues(communicator, mine);
  return *std::max_element(all.begin(), all.end());
}

std::string AgreeOnError(Communicator& communicator, const std::string& mine)
{
  const std::vector<std::string> all = AllGatherStrings(communicator, mine);
  if (all.front().rfind("Rank ", 0) == 0 &&
      std::count(all.begin(), all.end(), all.front()) == static_cast<std::ptrdiff_t>(all.size()))
  {
    return all.front(); // they have agreed on it before
  }
  for (std::size_t rank = 0; rank < all.size(); ++rank)
  {
    if (!all[rank].empty())
    {
      // Alone there is only one rank, and naming it would only puzzle.
      return all.size() == 1 ? all[rank] : "Rank " + std::to_string(rank) + ": " + all[rank];
    }
  }
  return {};
}

} // namespace banyan
