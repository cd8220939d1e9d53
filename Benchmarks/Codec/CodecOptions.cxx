// SPDX-License-Identifier: BSD-3-Clause
#include "CodecOptions.h"

#include "OptionValues.h"

#include "Base/Error.h"

namespace banyan::bench
{

CodecOptions ParseCodecOptions(const std::vector<std::string>& arguments)
{
  CodecOptions options;
  for (std::size_t i = 0; i < arguments.size(); ++i)
  {
    const std::string& option = arguments[i];
    const auto value = [&]() -> const std::string& { return ValueBehind(arguments, i); };
    if (option == "--help")
      options.Help = true;
    else if (option == "--append")
      options.Append = true;
    else if (option == "--stages")
      options.Measuring.Stages = true;
    else if (option == "--output")
      options.Output = value();
    else if (option == "--work")
      options.Measuring.WorkFolder = value();
    else if (option == "--methods")
      options.Methods = SplitAtCommas(value());
    else if (option == "--repeat")
      options.Measuring.Repeat = CountIn(option, value(), 1, 1000);
    else if (option == "--bricks")
      options.Measuring.Bricks = CountIn(option, value(), 0, 1000000);
    else if (option == "--bits")
    {
      options.Bits.clear();
      for (const std::string& bits : SplitAtCommas(value()))
        options.Bits.push_back(CountIn(option, bits, 1, 16));
    }
    else if (option.rfind("--", 0) == 0)
      throw Error("There is no option '" + option + "'; --help lists them.");
    else
      options.Series.push_back(option);
  }
  if (!options.Help && (options.Output.empty() || options.Series.empty()))
  {
    throw Error("--output and at least one description of a series are needed.");
  }
  return options;
}

std::string CodecHelp()
{
  return "banyan-bench-codec --output FILE.csv [OPTIONS] SERIES.json...\n"
         "  Measures size, error and speed of this codec and of its peers, one line per dataset,\n"
         "  accuracy and method. Fails when one of ours exceeds its error bound.\n"
         "  SERIES.json     describes a file of raw float32 values beside it:\n"
         "                  {\"name\": ..., \"file\": ..., \"samples\": [nx, ny, nz], \"steps\": "
         "n,\n"
         "                  \"range_percentile\": 100}\n"
         "  --append        adds to FILE.csv instead of writing it anew\n"
         "  --bits LIST     bits of accuracy (default 6,8,10,12)\n"
         "  --methods LIST  only these (default all but banyan-without-IDEA: activity, sharing, axes,\n"
         "                  group-before, modes or trials)\n"
         "  --repeat N      timed passes of each kind, of which the median counts (default 3)\n"
         "  --bricks N      random bricks per pass (default 2000; 0 leaves them out)\n"
         "  --stages        prints the time of each stage of decoding; needs a build with\n"
         "                  -DBANYAN_STAGES=ON, whose other times are a little longer\n"
         "  --work FOLDER   for encoded files (default: the folder of FILE.csv)\n";
}

} // namespace banyan::bench
