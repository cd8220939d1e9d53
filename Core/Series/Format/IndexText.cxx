// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Format/IndexText.h"

#include "Base/Error.h"
#include "Base/Hash.h"
#include "Series/Format/IndexJson.h"
#include "Series/Format/JsonMembers.h"

#include <algorithm>
#include <iterator>

#include <fcntl.h>
#include <unistd.h>

namespace banyan
{
namespace
{

const std::string Word = "BanyanSeries ";
const std::string DevelopmentWord = "banyan-series "; ///< before there was a version 1
constexpr int Version = 1;
constexpr const char* Features[] = { "mesh", "cell arrays", "hidden", "grid points", "any cells" };

/// Splits off the first line, having checked that it fits the rest.
std::string CheckedBody(const std::string& text)
{
  if (text.compare(0, DevelopmentWord.size(), DevelopmentWord) == 0)
  {
    throw Error(
      "This series was written by a development version of Banyan, before version 1 of the "
      "format, and cannot be read: encode it anew from the original data");
  }
  if (text.compare(0, Word.size(), Word) != 0)
  {
    throw Error("This is not a Banyan series: it does not start with 'BanyanSeries'");
  }
  const std::size_t end = text.find_first_of(" \n", Word.size());
  const std::string version =
    end == std::string::npos ? "" : text.substr(Word.size(), end - Word.size());
  if (version.empty() || version[0] == '0' || version.size() > 9 ||
      version.find_first_not_of("0123456789") != std::string::npos)
  {
    throw Error("The first line of the index is damaged");
  }
  if (std::stoi(version) > Version)
  {
    throw Error("This series needs a newer Banyan: it has format version " + version +
                ", and this Banyan reads version " + std::to_string(Version));
  }
  const std::size_t start = end + 1 + 32 + 1;
  if (text[end] != ' ' || text.size() < start || text[start - 1] != '\n')
  {
    throw Error("The first line of the index is damaged");
  }
  if (text.compare(end + 1, 32, ToHex(HashOf(text.data() + start, text.size() - start))) != 0)
  {
    throw Error("The index is damaged or cut short: its checksum does not fit");
  }
  return text.substr(start);
}

/// Before anything else, so that a newer index is not said to be damaged.
void CheckFeatures(const Json& json)
{
  if (!json.is_object())
  {
    throw Error("The index is not a JSON object");
  }
  for (const Json& feature : json_members::ListMember(json, "features"))
  {
    const std::string name = feature.is_string() ? feature.get<std::string>() : feature.dump();
    if (std::find(std::begin(Features), std::end(Features), name) == std::end(Features))
    {
      throw Error("This series needs a newer Banyan, which knows '" + name + "'");
    }
  }
}

} // namespace

std::vector<std::string> KnownFeatures()
{
  return { std::begin(Features), std::end(Features) };
}

std::vector<std::string> FeaturesOf(const SeriesIndex& index)
{
  bool cellArrays = false;
  bool hidden = false;
  for (const ArrayIndex& array : index.Arrays)
  {
    cellArrays = cellArrays || !array.CellArray.empty();
    hidden = hidden || array.Flags != ArrayFlags::None;
  }
  const bool has[] = { index.Mesh.has_value(), cellArrays, hidden, index.Points.has_value(),
    index.Mesh && index.Mesh->OfCells };
  std::vector<std::string> features;
  for (std::size_t i = 0; i < std::size(Features); ++i)
  {
    if (has[i])
    {
      features.push_back(Features[i]);
    }
  }
  return features;
}

bool BeginsAsSeries(const std::string& path)
{
  // Not blocking: a pipe of that name must not hang the caller.
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0)
  {
    return false;
  }
  std::string begin(DevelopmentWord.size(), '\0');
  const ssize_t got = read(descriptor, begin.data(), begin.size());
  (void)close(descriptor);
  begin.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  return begin.compare(0, Word.size(), Word) == 0 || begin == DevelopmentWord;
}

std::string IndexToText(const SeriesIndex& index)
{
  CheckIndex(index);
  const Json json = IndexToJson(index);
  std::string body;
  try
  {
    body = json.dump(1) + "\n";
  }
  catch (const nlohmann::json::exception&)
  {
    throw Error("The name of an array or component is not valid UTF-8");
  }
  return Word + std::to_string(Version) + " " + ToHex(HashOf(body.data(), body.size())) + "\n" +
         body;
}

SeriesIndex IndexFromText(const std::string& text, const std::string& path)
{
  try
  {
    const Json json = Json::parse(CheckedBody(text));
    CheckFeatures(json);
    SeriesIndex index = IndexFromJson(json);
    CheckIndex(index);
    if (json.at("features").get<std::vector<std::string>>() != FeaturesOf(index))
    {
      throw Error("The features that the index names are not those that the series has");
    }
    return index;
  }
  catch (const nlohmann::json::exception& failure)
  {
    throw Error(std::string("The index cannot be understood: ") + failure.what(), { path });
  }
  catch (const Error& failure)
  {
    throw Error(failure.what(), { path });
  }
}

} // namespace banyan
