// SPDX-License-Identifier: BSD-3-Clause
#include "VerifyOptions.h"

#include "Arguments.h"
#include "Base/Error.h"

#include <sstream>
#include <utility>

namespace banyan
{
namespace
{

bool EndsWith(const std::string& text, const std::string& end)
{
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

void CheckTogether(const VerifyOptions& options)
{
  if (options.File.empty())
  {
    throw Error("The name of a series is needed: the file name.banyan.");
  }
  if (options.Against.empty() != options.Stream)
  {
    throw Error("Option --against is needed: the file or files that the series was made from.");
  }
  if (options.RawType.has_value() != options.Dims.has_value())
  {
    throw Error("Options --raw-type and --dims are needed together: raw files say neither.");
  }
  if (options.Stream || options.RawType)
  {
    return;
  }
  for (const std::string& file : options.Against)
  {
    if (!EndsWith(file, ".banyan"))
    {
      throw Error("\"" + file +
                  "\" is not a series of Banyan: raw files need --raw-type and "
                  "--dims, and all others Utilities/verify.sh, which reads them with "
                  "ParaView.");
    }
  }
  if (options.Against.size() > 1)
  {
    throw Error("One series at a time can be compared with.");
  }
}

} // namespace

OpacityFunction OpacityFrom(const std::string& text)
{
  std::vector<OpacityKnot> knots;
  std::istringstream list(text);
  for (std::string knot; std::getline(list, knot, ',');)
  {
    const std::size_t colon = knot.find(':');
    if (colon == std::string::npos)
    {
      throw Error(
        "Option --opacity needs pairs value:opacity, separated by commas, not \"" + knot + "\".");
    }
    knots.push_back({ NumberFrom(knot.substr(0, colon), "Option --opacity"),
      NumberFrom(knot.substr(colon + 1), "Option --opacity") });
  }
  return OpacityFunction(std::move(knots));
}

VerifyOptions ParseVerifyOptions(const std::vector<std::string>& arguments)
{
  VerifyOptions options;
  Arguments left(arguments);
  while (!left.Empty())
  {
    const std::string option = left.Next();
    if (option == "--help")
    {
      options.Help = true;
      return options;
    }
    if (option == "--against")
    {
      options.Against.push_back(left.Value(option));
      while (left.NextIsValue())
      {
        options.Against.push_back(left.Next());
      }
    }
    else if (option == "--stream")
      options.Stream = true;
    else if (option == "--array")
      options.Arrays.push_back(left.Value(option));
    else if (option == "--raw-type")
      options.RawType = ScalarTypeFromName(left.Value(option));
    else if (option == "--dims")
    {
      options.Dims = glm::ivec3(0);
      for (int axis = 0; axis < 3; ++axis)
      {
        (*options.Dims)[axis] = static_cast<int>(left.Whole(option, 1, 1 << 30));
      }
    }
    else if (option == "--opacity")
      options.Opacity = OpacityFrom(left.Value(option));
    else if (option == "--json")
      options.Json = true;
    else if (option.rfind("--", 0) == 0)
      throw Error("There is no option \"" + option + "\"; --help lists them.");
    else if (options.File.empty())
      options.File = option;
    else
      throw Error("One series is verified at a time, and \"" + option + "\" is a second one.");
  }
  CheckTogether(options);
  return options;
}

std::string VerifyHelp()
{
  return "banyan-verify FILE --against SOURCE...: proves that each value of the encoded series\n"
         "FILE (name.banyan) is within its error bound of the source, and that NaN and infinities\n"
         "are the same bits. Exit status 0: proven; 1: not so; 2: they cannot be compared.\n"
         "\n"
         "  --against SOURCE...  another series of Banyan, or raw files in order of time\n"
         "  --raw-type T         type of raw values: int8, uint8, ... int64, float32, float64\n"
         "  --dims X Y Z         samples of raw files per axis; x fastest\n"
         "  --stream             the source comes through standard input, as\n"
         "                       Utilities/verify/stream_source.py sends it\n"
         "  --array NAME         compares this array alone; may be given several times\n"
         "  --opacity V:O,V:O    opacities over values, linear in between, that weigh the errors;\n"
         "                       a ramp over the range of each component by default\n"
         "  --json               the report as JSON instead of text\n"
         "  --help               this text\n";
}

} // namespace banyan
