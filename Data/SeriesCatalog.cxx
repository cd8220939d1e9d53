// SPDX-License-Identifier: BSD-3-Clause
#include "SeriesCatalog.h"

#include "ConvectionSeries.h"
#include "EarthquakeSeries.h"
#include "FewChangesSeries.h"
#include "HotBlobsSeries.h"
#include "JetSeries.h"
#include "StandardSeries.h"
#include "TurbulenceSeries.h"
#include "WaveSeries.h"

#include "Base/Error.h"

namespace banyan
{

const std::vector<SeriesKind>& SeriesCatalog()
{
  // One per line, in the order of the help text.
  static const std::vector<SeriesKind> kinds = {
    HotBlobsSeries(),
    TurbulenceSeries(),
    JetSeries(),
    ConvectionSeries(),
    WaveSeries(),
    ClippedWaveSeries(),
    StandardSeries(),
    FewChangesSeries(),
    EarthquakeSeries(),
  };
  return kinds;
}

const SeriesKind& FindSeriesKind(const std::string& name)
{
  std::string names;
  for (const SeriesKind& kind : SeriesCatalog())
  {
    if (kind.Name == name)
    {
      return kind;
    }
    names += (names.empty() ? "" : ", ") + kind.Name;
  }
  throw Error("There is no series \"" + name + "\"; there are: " + names + ".");
}

double TimeOfStep(const GenerateOptions& options, int step)
{
  return options.Steps > 1 ? options.Duration * step / (options.Steps - 1) : options.Duration;
}

} // namespace banyan
