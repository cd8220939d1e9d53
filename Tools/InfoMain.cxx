// SPDX-License-Identifier: BSD-3-Clause
#include "DecodeTimes.h"
#include "InfoJson.h"
#include "InfoOptions.h"
#include "InfoText.h"

#include "Series/AtomicFile.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <optional>

namespace
{

/// What the file says; the file is closed again, because measuring times wants it for itself.
banyan::InfoReport Collect(const banyan::InfoOptions& options)
{
  const auto file = banyan::SeriesFile::Open(options.File);
  banyan::InfoReport report;
  report.Series = banyan::ReportSeries(*file, options.Choice);
  for (const banyan::ComponentReport& component : report.Series.Components)
  {
    if (options.Octree)
    {
      report.Octrees.push_back(banyan::CompareWithOctree(*file, component.Array,
        component.Component, component.Steps.front().Step, component.Steps.back().Step + 1));
    }
  }
  return report;
}

void Inform(const banyan::InfoOptions& options)
{
  const banyan::InfoReport report = Collect(options);
  std::optional<banyan::DecodeTimes> times;
  if (options.Time)
  {
    times = banyan::MeasureDecodeTimes(options.File, report.Series.Components[0].Array, 1);
  }
  if (!options.Csv.empty())
  {
    banyan::WriteFileAtomically(options.Csv, banyan::StepCsv(report));
  }
  const banyan::DecodeTimes* measured = times ? &*times : nullptr;
  const std::string text =
    options.Json ? banyan::InfoToJson(report, measured) : banyan::InfoToText(report, measured);
  std::fputs(text.c_str(), stdout);
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    const banyan::InfoOptions options = banyan::ParseInfoOptions({ argv + 1, argv + argc });
    if (options.Help)
    {
      std::fputs(banyan::InfoHelp().c_str(), stdout);
      return EXIT_SUCCESS;
    }
    Inform(options);
    return EXIT_SUCCESS;
  }
  catch (const std::bad_alloc&)
  {
    std::fprintf(stderr, "banyan-info: There is not enough memory.\n");
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "banyan-info: %s\n", error.what());
  }
  return EXIT_FAILURE;
}
