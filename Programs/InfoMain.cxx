// SPDX-License-Identifier: BSD-3-Clause
#include "DecodeTimes.h"
#include "InfoJson.h"
#include "InfoOptions.h"
#include "InfoText.h"

#include "Series/Format/AtomicFile.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <optional>

namespace
{

void Inform(const banyan::InfoOptions& options)
{
  // Closed again at once: measuring times wants the file for itself.
  banyan::SeriesReport report;
  {
    const auto file = banyan::SeriesFile::Open(options.File);
    report = banyan::ReportSeries(*file, options.Choice);
    for (banyan::ComponentReport& component : report.Components)
    {
      if (options.Between)
      {
        component.Between =
          banyan::EstimateInterpolation(*file, component.Array, component.Component);
      }
    }
  }
  std::optional<banyan::DecodeTimes> times;
  if (options.Time)
  {
    times = banyan::MeasureDecodeTimes(options.File, report.Components[0].Array, 1);
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
