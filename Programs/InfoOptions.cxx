// SPDX-License-Identifier: BSD-3-Clause
#include "InfoOptions.h"

#include "Arguments.h"
#include "Base/Error.h"

namespace banyan
{

InfoOptions ParseInfoOptions(const std::vector<std::string>& arguments)
{
  InfoOptions options;
  Arguments left(arguments);
  while (!left.Empty())
  {
    const std::string option = left.Next();
    if (option == "--help")
      options.Help = true;
    else if (option == "--step")
      options.Choice.Step = static_cast<int>(left.Whole(option, 0, 1 << 24));
    else if (option == "--array")
      options.Choice.Array = left.Value(option);
    else if (option == "--csv")
      options.Csv = left.Value(option);
    else if (option == "--json")
      options.Json = true;
    else if (option == "--time")
      options.Time = true;
    else if (option == "--between")
      options.Between = true;
    else if (option.rfind("--", 0) == 0)
      throw Error("There is no option \"" + option + "\"; --help lists them.");
    else if (options.File.empty())
      options.File = option;
    else
      throw Error("One series is looked at at a time, and \"" + option + "\" is a second one.");
  }
  if (options.File.empty() && !options.Help)
  {
    throw Error("The name of a series is needed: the file name.banyan.");
  }
  return options;
}

std::string InfoHelp()
{
  return "banyan-info FILE: tells what the encoded series FILE (name.banyan) holds, how small it\n"
         "is, how exact, and of what its tree is made. Nothing is decoded unless asked for.\n"
         "\n"
         "  --step N      of one time step (the first is 0) instead of all\n"
         "  --array NAME  of one array instead of all\n"
         "  --json        as JSON instead of text\n"
         "  --csv FILE    also writes a table with one line per array, component and step\n"
         "  --time        also measures how long decoding takes, for some seconds\n"
         "  --between     also estimates how far values that are interpolated between steps are\n"
         "                from the truth: steps are left out and compared, for some seconds\n"
         "  --help        this text\n";
}

} // namespace banyan
