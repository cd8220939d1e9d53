// SPDX-License-Identifier: BSD-3-Clause
#include "SeriesChanges.h"

#include <algorithm>

namespace banyan
{

void SeriesChanges::Compare(const StepAgreement& now, const std::string& named) const
{
  const std::string change = ChangeBetween(this->First, now);
  if (!change.empty())
  {
    throw CollectiveError("The data change at " + named + ": " + change +
                          ". All steps of a series need the same grid and the same arrays.");
  }
}

void SeriesChanges::Add(int step, const StepAgreement& now, const std::string& named)
{
  if (step > 0)
  {
    this->Compare(now, named);
  }
  else
  {
    this->First = now;
  }
  this->First.HidesPoints = this->First.HidesPoints || now.HidesPoints;
  this->First.HidesCells = this->First.HidesCells || now.HidesCells;
  this->WarnOf(step, now, named);
}

void SeriesChanges::IncludeRanges(const StepAgreement& now)
{
  for (WrittenArray& array : this->First.Arrays)
  {
    // The same arrays, but perhaps in another order.
    const auto same = std::find_if(now.Arrays.begin(), now.Arrays.end(),
      [&](const WrittenArray& other) { return other.Name == array.Name; });
    for (std::size_t c = 0; c < array.Ranges.size(); ++c)
    {
      array.Ranges[c].Include(same->Ranges[c]);
    }
  }
}

/// Warns of arrays that were not there to be chosen, and of those that cannot be written.
void SeriesChanges::WarnOf(int step, const StepAgreement& now, const std::string& named)
{
  std::string warning = this->Warned.insert(now.Warning).second ? now.Warning : "";
  for (const std::string& name : now.NotChosen)
  {
    // Who left out some of the first step's arrays does not want all of them.
    if (step > 0 && this->First.NotChosen.empty() && this->Warned.insert(name).second)
    {
      warning += "The " + name + " first appears at " + named +
                 " and is not written: a series has the arrays of its first step, at all steps. ";
    }
  }
  if (!warning.empty())
  {
    this->Warn(warning);
  }
}

/// Files that are being written say what is hidden from their first step on.
void SeriesChanges::MustHideAlready(int step, const StepAgreement& now) const
{
  if (step > 0 && ((now.HidesPoints && !this->First.HidesPoints) ||
                    (now.HidesCells && !this->First.HidesCells)))
  {
    throw LateHiding("");
  }
}

} // namespace banyan
