// SPDX-License-Identifier: BSD-3-Clause
#include "GenerateOptions.h"

#include "SeriesCatalog.h"

#include "Base/Error.h"

#include <algorithm>
#include <charconv>
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

std::string Joined(const std::vector<std::string>& names)
{
  std::string text;
  for (const std::string& name : names)
  {
    text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

std::vector<std::string> ParseNames(const std::string& text)
{
  std::vector<std::string> names;
  std::istringstream list(text);
  for (std::string name; std::getline(list, name, ',');)
  {
    names.push_back(name);
  }
  if (names.empty())
  {
    throw Error("Option --arrays needs at least one name.");
  }
  return names;
}

void CheckArrays(const std::vector<std::string>& names, const SeriesKind& kind)
{
  for (const std::string& name : names)
  {
    if (std::count(kind.Arrays.begin(), kind.Arrays.end(), name) == 0 ||
        std::count(names.begin(), names.end(), name) != 1)
    {
      throw Error("Option --arrays of the series " + kind.Name + " takes " + Joined(kind.Arrays) +
                  ", each at most once and separated by commas, not \"" + Joined(names) + "\".");
    }
  }
}

/// As below, for what series on meshes have and others have not.
void CompleteMesh(GenerateOptions& options, const SeriesKind& kind)
{
  if (!kind.GenerateMesh)
  {
    if (options.Cells > 0 || options.Slowest > 0.0 || !options.Format.empty() || options.Voxels)
    {
      throw Error(
        "Options --cells, --slowest, --format and --voxels are for the series on meshes; " +
        kind.Name + " takes --size.");
    }
    return;
  }
  if (options.Size > 0)
  {
    throw Error("Option --size is for images; the series " + kind.Name + " takes --cells.");
  }
  options.Cells = options.Cells > 0 ? options.Cells : kind.DefaultCells;
  options.Slowest = options.Slowest > 0.0 ? options.Slowest : 500.0;
  options.Format = options.Format.empty() ? options.Voxels ? "vtu" : "exodus" : options.Format;
  if (options.Format != "exodus" && options.Format != "vtu")
  {
    throw Error("Option --format takes exodus or vtu, not \"" + options.Format + "\".");
  }
  if (options.Voxels && options.Format != "vtu")
  {
    throw Error("Option --voxels needs --format vtu: Exodus has no voxels.");
  }
  if (options.Arrays.empty())
  {
    options.Arrays = kind.Arrays;
  }
}

/// Sets what the arguments left out, and checks what only makes sense together.
void Complete(GenerateOptions& options)
{
  const SeriesKind& kind =
    FindSeriesKind(options.Series.empty() ? SeriesCatalog().at(0).Name : options.Series);
  options.Series = kind.Name;
  CompleteMesh(options, kind);
  options.Size = options.Size > 0 ? options.Size : kind.DefaultSize;
  options.Steps = options.Steps > 0 ? options.Steps : kind.DefaultSteps;
  options.Duration = options.Duration >= 0.0 ? options.Duration : kind.DefaultDuration;
  if (options.Arrays.empty())
  {
    options.Arrays = { kind.Arrays.at(0) };
  }
  CheckArrays(options.Arrays, kind);
  if (options.Size % 2 != 0)
  {
    throw Error("Option --size needs an even number.");
  }
  if (options.Output.empty() && options.Raw.empty())
  {
    throw Error("Option --output is needed: the folder that the series goes to. "
                "(Or --raw: a file for its first array alone.)");
  }
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
    if (option == "--series")
      options.Series = value();
    else if (option == "--output")
      options.Output = value();
    else if (option == "--raw")
      options.Raw = value();
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
    else if (option == "--cells")
      options.Cells = ParseNumber<std::int64_t>(option, value(), 1000, 200000000);
    else if (option == "--slowest")
      options.Slowest = ParseNumber(option, value(), 100.0, 1500.0);
    else if (option == "--format")
      options.Format = value();
    else if (option == "--voxels")
      options.Voxels = true;
    else if (option == "--arrays")
      options.Arrays = ParseNames(value());
    else
      throw Error("There is no option \"" + option + "\"; --help lists them.");
  }
  Complete(options);
  return options;
}

std::string GenerateHelp()
{
  std::ostringstream text;
  text
    << "banyan-generate: simulates a physical process and writes it as a time series of .vti\n"
       "files with a .vti.series file that ParaView opens.\n"
       "\n"
       "  --series NAME    which process, see below (default "
    << SeriesCatalog().at(0).Name
    << ")\n"
       "  --output DIR     folder for the series; made when it does not exist\n"
       "  --raw FILE       writes the first array of all steps as little-endian float32 without\n"
       "                   a header, x fastest, steps slowest; with or instead of --output\n"
       "  --size N         samples per axis, even, 8 to 2048\n"
       "  --steps N        time steps to write, evenly spaced\n"
       "  --duration T     simulated time from the first step to the last\n"
       "  --arrays A,B     which arrays; the first is the one to colour by\n"
       "  --seed N         chance's share; equal seeds give equal bytes (default 1)\n"
       "  --threads N      0 uses all processors (default 0)\n"
       "  --cells N        of a series on a mesh, instead of --size: about so many, 1000 to 2e8\n"
       "  --format NAME    of a series on a mesh: exodus (default; one .exo file with the mesh "
       "once)\n"
       "                   or vtu (.vtu files with a .vtu.series file, the mesh in each)\n"
       "  --voxels         cells of .vtu files are VTK_VOXEL instead of VTK_HEXAHEDRON\n"
       "  --slowest V      speed of S waves in the softest sediments, m/s, 100 to 1500 (default "
       "500)\n"
       "  --help           this text\n"
       "\n"
       "The series, with their defaults and arrays (the first alone, unless told):\n";
  for (const SeriesKind& kind : SeriesCatalog())
  {
    text << "\n  " << kind.Name << ": " << kind.Description << "\n      "
         << (kind.GenerateMesh ? "--cells " : "--size ")
         << (kind.GenerateMesh ? kind.DefaultCells : kind.DefaultSize) << " --steps "
         << kind.DefaultSteps << " --duration " << kind.DefaultDuration
         << "; arrays: " << Joined(kind.Arrays) << "\n";
  }
  return text.str();
}

} // namespace banyan
