#include "GenerateOptions.h"

#include "Base/Error.h"

#include <algorithm>
#include <charconv>
#include <set>
#include <sstream>

namespace banyan
{

namespace
{

template <typename Number>
Number ParseNumber(
  const std::string& option, const std::string& text, Number smallest, Number largest)
{
  Number value{};
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end || !(value >= smallest && value <= largest))
  {
    std::ostringstream sentence;
    sentence << "Option " << option << " needs a number from " << smallest << " to " << largest
             << ", not \"" << text << "\".";
    throw Error(sentence.str());
  }
  return value;
}

std::vector<std::string> ParseArrays(const std::string& text)
{
  const std::set<std::string> known = { "temperature", "velocity", "vorticity" };
  std::vector<std::string> names;
  std::istringstream list(text);
  for (std::string name; std::getline(list, name, ',');)
  {
    if (known.count(name) == 0 || std::count(names.begin(), names.end(), name) != 0)
    {
      throw Error("Option --arrays takes temperature, velocity and vorticity, each once and "
                  "separated by commas, not \"" +
                  text + "\".");
    }
    names.push_back(name);
  }
  if (names.empty())
  {
    throw Error("Option --arrays needs at least one name.");
  }
  return names;
}

} // namespace

GenerateOptions ParseGenerateOptions(const std::vector<std::string>& arguments)
{
  GenerateOptions options;
  for (std::size_t i = 0; i < arguments.size(); ++i)
  {
    const std::string& option = arguments[i];
    if (option == "--help")
    {
      options.Help = true;
      return options;
    }
    const auto value = [&]() -> const std::string&
    {
      if (i + 1 >= arguments.size())
      {
        throw Error("Option " + option + " needs a value.");
      }
      return arguments[++i];
    };
    if (option == "--output")
      options.Output = value();
    else if (option == "--size")
      options.Size = ParseNumber(option, value(), 8, 2048);
    else if (option == "--steps")
      options.Steps = ParseNumber(option, value(), 1, 9999);
    else if (option == "--seed")
      options.Seed = ParseNumber<std::uint64_t>(option, value(), 0, UINT64_MAX);
    else if (option == "--threads")
      options.Threads = ParseNumber(option, value(), 0, 1024);
    else if (option == "--duration")
      options.Duration = ParseNumber(option, value(), 0.0, 1000.0);
    else if (option == "--arrays")
      options.Arrays = ParseArrays(value());
    else
      throw Error("There is no option \"" + option + "\"; --help lists them.");
  }
  if (options.Size % 2 != 0)
  {
    throw Error("Option --size needs an even number.");
  }
  if (options.Output.empty())
  {
    throw Error("Option --output is needed: the folder that the series goes to.");
  }
  return options;
}

std::string GenerateHelp()
{
  return "banyan-generate: simulates hot blobs that rise and roll up, and writes them as a time\n"
         "series of .vti files with a .vti.series file that ParaView opens.\n"
         "\n"
         "  --output DIR     folder for the series; made when it does not exist\n"
         "  --size N         samples per axis, even, 8 to 2048 (default 64)\n"
         "  --steps N        time steps to write, evenly spaced (default 24)\n"
         "  --duration T     simulated time of the last step (default 6)\n"
         "  --arrays A,B     of temperature, velocity, vorticity (its magnitude);\n"
         "                   the first is the one to colour by (default temperature)\n"
         "  --seed N         which blobs; equal seeds give equal bytes (default 1)\n"
         "  --threads N      0 uses all processors (default 0)\n"
         "  --help           this text\n";
}

} // namespace banyan
