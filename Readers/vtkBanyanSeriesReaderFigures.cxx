// SPDX-License-Identifier: BSD-3-Clause
// The reader tells of its work here.
#include "SeriesReaderInternals.h"

#include "Cache/BrickCache.h"

vtkIdType vtkBanyanSeriesReader::GetBricksReadAhead()
{
  return static_cast<vtkIdType>(banyan::BrickCache::Process().GetAheadStatistics().Hits);
}

double vtkBanyanSeriesReader::GetLoadSeconds()
{
  return this->Self->LoadSeconds;
}

vtkIdType vtkBanyanSeriesReader::GetBricksDecoded()
{
  return this->Self->Series ? static_cast<vtkIdType>(this->Self->Series->BricksDecoded()) : 0;
}
