// SPDX-License-Identifier: BSD-3-Clause
#include "Series/IndexText.h"

#include "Base/Error.h"
#include "Series/Hash.h"
#include "Series/IndexJson.h"

#include <fcntl.h>
#include <unistd.h>

namespace banyan
{
namespace
{

const std::string Word = "banyan-series ";
constexpr int OldestVersion = 1;
constexpr int NewestVersion = 5;

/// Splits off the first line, having checked that it fits the rest.
std::string CheckedBody(const std::string& text, int& formatVersion)
{
  if (text.compare(0, Word.size(), Word) != 0)
  {
    throw Error("This is not a Banyan series: it does not start with 'banyan-series'");
  }
  const std::size_t end = text.find_first_of(" \n", Word.size());
  const std::string version =
    end == std::string::npos ? "" : text.substr(Word.size(), end - Word.size());
  if (version.empty() || version.size() > 9 ||
      version.find_first_not_of("0123456789") != std::string::npos)
  {
    throw Error("The first line of the index is damaged");
  }
  formatVersion = std::stoi(version);
  if (formatVersion < OldestVersion || formatVersion > NewestVersion)
  {
    throw Error("The series has format version " + version + ", and this Banyan reads versions " +
                std::to_string(OldestVersion) + " to " + std::to_string(NewestVersion));
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

} // namespace

bool BeginsAsSeries(const std::string& path)
{
  // Not blocking: a pipe of that name must not hang the caller.
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0)
  {
    return false;
  }
  std::string begin(Word.size(), '\0');
  const ssize_t got = read(descriptor, begin.data(), begin.size());
  (void)close(descriptor);
  return got == static_cast<ssize_t>(begin.size()) && begin == Word;
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
  return Word + std::to_string(index.FormatVersion) + " " +
         ToHex(HashOf(body.data(), body.size())) + "\n" + body;
}

SeriesIndex IndexFromText(const std::string& text, const std::string& path)
{
  try
  {
    int version = 0;
    const std::string body = CheckedBody(text, version);
    SeriesIndex index = IndexFromJson(Json::parse(body));
    index.FormatVersion = version;
    CheckIndex(index);
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
