// SPDX-License-Identifier: BSD-3-Clause
#include "RawSource.h"
#include "SeriesSource.h"
#include "StreamSource.h"
#include "VerifyOptions.h"
#include "VerifyReport.h"

#include "Agreement.h"
#include "Base/Error.h"

#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <new>

#include <unistd.h>

namespace
{

enum ExitStatus
{
  Proven = 0,
  NotProven = 1,
  NotComparable = 2
};

/// Raw files have no names for what they hold: it is the one array that is meant.
banyan::SourceArray RawArray(const banyan::SeriesIndex& index, const banyan::VerifyOptions& options)
{
  const std::vector<int> chosen = banyan::ChosenArrays(index, options.Arrays);
  if (chosen.size() != 1)
  {
    throw banyan::Error("The series holds several arrays, and raw files one: --array NAME says "
                        "which.");
  }
  const banyan::ArrayIndex& array = index.Arrays[static_cast<std::size_t>(chosen[0])];
  return { array.Name, *options.RawType, static_cast<int>(array.Components.size()) };
}

std::unique_ptr<banyan::SourceSteps> OpenSource(
  const banyan::SeriesIndex& index, const banyan::VerifyOptions& options)
{
  if (options.Stream)
  {
    return std::make_unique<banyan::StreamSource>(std::cin);
  }
  if (options.RawType)
  {
    return std::make_unique<banyan::RawSource>(
      options.Against, RawArray(index, options), *options.Dims);
  }
  return std::make_unique<banyan::SeriesSource>(banyan::SeriesFile::Open(options.Against[0]));
}

ExitStatus Verify(const banyan::VerifyOptions& options)
{
  const auto series = banyan::SeriesFile::Open(options.File);
  const auto source = OpenSource(series->Index(), options);
  const bool watched = isatty(STDERR_FILENO) != 0;
  const int steps = series->Index().Steps();
  const banyan::Verification result =
    banyan::Verify(*series, *source, { options.Arrays, options.Opacity },
      [&](int done)
      {
        if (watched)
        {
          std::fprintf(stderr, "\rstep %d of %d%s", done, steps, done == steps ? "\n" : "");
        }
      });
  const std::string text = options.Json ? banyan::VerificationToJson(result, options.File)
                                        : banyan::VerificationToText(result, options.File);
  std::fputs(text.c_str(), stdout);
  return result.Proven() ? Proven : NotProven;
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    std::ios::sync_with_stdio(false);
    const banyan::VerifyOptions options = banyan::ParseVerifyOptions({ argv + 1, argv + argc });
    if (options.Help)
    {
      std::fputs(banyan::VerifyHelp().c_str(), stdout);
      return Proven;
    }
    return Verify(options);
  }
  catch (const std::bad_alloc&)
  {
    std::fprintf(stderr, "banyan-verify: There is not enough memory.\n");
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "banyan-verify: %s\n", error.what());
  }
  return NotComparable;
}
