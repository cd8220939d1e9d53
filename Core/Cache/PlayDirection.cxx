// SPDX-License-Identifier: BSD-3-Clause
#include "Cache/PlayDirection.h"

#include "Series/Decode/SeriesFile.h"

namespace banyan
{

int PlayDirection::Asked(const SeriesFile& series, int step)
{
  if (series.Id() != this->SeriesId)
  {
    this->SeriesId = series.Id();
    this->Steps = series.Index().Steps();
    this->Step = -1;
    this->Apart = 0;
  }
  if (step != this->Step)
  {
    // One that was expected is no turn, though it may be the first one again.
    if (this->Step >= 0 && step != this->After(this->Step))
    {
      this->Apart = step - this->Step;
    }
    this->Step = step;
  }
  return this->After(step);
}

int PlayDirection::After(int step) const
{
  const int next = step + this->Apart;
  int after = next;
  if (this->Apart == 0 || this->Steps < 2)
  {
    after = -1;
  }
  else if (next >= this->Steps)
  {
    after = 0;
  }
  else if (next < 0)
  {
    after = this->Steps - 1;
  }
  return after;
}

} // namespace banyan
