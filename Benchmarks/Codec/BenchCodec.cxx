// SPDX-License-Identifier: BSD-3-Clause
// Size, error and speed of this codec and of its peers on raw series, as CSV. See README.md.
#include "CodecOptions.h"
#include "Report.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>

namespace
{

using namespace banyan::bench;

/// Those that were asked for, in their usual order.
MethodList ChosenMethods(const CodecOptions& options)
{
  std::vector<std::string> missing;
  MethodList methods = AllMethods(missing);
  for (const std::string& peer : missing)
  {
    std::fprintf(stderr,
      "%s is not measured: it was not installed when this program was configured.\n", peer.c_str());
  }
  for (const std::string& name : options.Methods)
  {
    if (std::none_of(methods.begin(), methods.end(),
          [&](const auto& method) { return method->Name() == name; }))
    {
      throw banyan::Error("There is no method '" + name + "', or it is not installed.");
    }
  }
  const auto unwanted = [&](const auto& method)
  {
    const auto& names = options.Methods;
    return names.empty() ? method->ByNameOnly()
                         : std::find(names.begin(), names.end(), method->Name()) == names.end();
  };
  methods.erase(std::remove_if(methods.begin(), methods.end(), unwanted), methods.end());
  return methods;
}

std::ofstream OpenReport(const CodecOptions& options)
{
  const bool fresh = !options.Append || !std::filesystem::exists(options.Output);
  std::ofstream csv(options.Output, fresh ? std::ios::trunc : std::ios::app);
  if (fresh)
  {
    csv << CsvHeader() << std::endl;
  }
  if (!csv)
  {
    throw banyan::Error("The report cannot be written.", { options.Output });
  }
  return csv;
}

bool Run(CodecOptions options)
{
  if (options.Measuring.Stages && !banyan::stages::Counted())
  {
    throw banyan::Error(
      "--stages needs a build that counts them: configure with -DBANYAN_STAGES=ON.");
  }
  // Decoding through the cache of bricks uses the pool of the process.
  banyan::ThreadPool::SetProcessWidth(1);
  if (options.Measuring.WorkFolder.empty())
  {
    options.Measuring.WorkFolder =
      (std::filesystem::path(options.Output).parent_path() / "work").string();
  }
  std::filesystem::create_directories(options.Measuring.WorkFolder);
  const MethodList methods = ChosenMethods(options);
  std::ofstream csv = OpenReport(options);
  bool kept = true;
  for (const std::string& description : options.Series)
  {
    const RawSeries series = RawSeries::Open(description);
    kept = Report(series, methods, options.Bits, options.Measuring, csv, std::cerr) && kept;
  }
  return kept;
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    const CodecOptions options = ParseCodecOptions({ argv + 1, argv + argc });
    if (options.Help)
    {
      std::fputs(CodecHelp().c_str(), stdout);
      return EXIT_SUCCESS;
    }
    // Times are of one core, for every method.
    setenv("BANYAN_THREADS", "1", 1);
    return Run(options) ? EXIT_SUCCESS : EXIT_FAILURE;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "banyan-bench-codec: %s\n", error.what());
  }
  return EXIT_FAILURE;
}
