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
    this->Step = -1;
    this->Apart = 0;
  }
  if (step != this->Step)
  {
    this->Apart = this->Step < 0 ? 0 : step - this->Step;
    this->Step = step;
  }
  const int next = step + this->Apart;
  return this->Apart != 0 && next >= 0 && next < series.Index().Steps() ? next : -1;
}

} // namespace banyan
