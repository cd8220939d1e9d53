#include "Series/IndexText.h"

#include "Base/Error.h"
#include "Series/Hash.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

using Json = nlohmann::ordered_json;

const std::string Word = "banyan-series ";
constexpr int Version = 1;

std::string ToHex(const Hash128& hash)
{
  static const char digits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint64_t half : { hash.High, hash.Low })
  {
    for (int shift = 60; shift >= 0; shift -= 4)
    {
      text += digits[half >> shift & 15];
    }
  }
  return text;
}

std::uint64_t HexHalf(const std::string& text, std::size_t start)
{
  std::uint64_t half = 0;
  for (std::size_t i = start; i < start + 16; ++i)
  {
    const char c = text[i];
    const bool digit = c >= '0' && c <= '9';
    if (!digit && !(c >= 'a' && c <= 'f'))
    {
      throw Error("A hash is not made of lower-case hexadecimal digits");
    }
    half = half << 4 | static_cast<std::uint64_t>(digit ? c - '0' : c - 'a' + 10);
  }
  return half;
}

Hash128 FromHex(const std::string& text)
{
  if (text.size() != 32)
  {
    throw Error("A hash does not have 32 digits");
  }
  return { HexHalf(text, 16), HexHalf(text, 0) };
}

// ---- writing

Json RangeToJson(const ValueRange& range)
{
  return range.Empty() ? Json(nullptr) : Json::array({ range.Low, range.High });
}

Json VectorToJson(const glm::dvec3& v)
{
  return Json::array({ v.x, v.y, v.z });
}

Json ComponentToJson(const ComponentIndex& component)
{
  Json json;
  json["name"] = component.Name;
  json["range"] = RangeToJson(component.Range);
  json["promisedRange"] = RangeToJson(component.PromisedRange);
  json["errorBoundAbsolute"] = component.ErrorBoundAbsolute;
  json["measuredMaxError"] = component.MeasuredMaxError;
  // The one number that may overflow: squares of large errors.
  json["sumSquaredError"] =
    std::isfinite(component.SumSquaredError) ? Json(component.SumSquaredError) : Json(nullptr);
  json["finiteCount"] = component.FiniteCount;
  json["nonFiniteCount"] = component.NonFiniteCount;
  return json;
}

Json ArrayToJson(const ArrayIndex& array)
{
  Json json;
  json["name"] = array.Name;
  json["type"] = NameOf(array.Type);
  for (const ComponentIndex& component : array.Components)
  {
    json["components"].push_back(ComponentToJson(component));
  }
  return json;
}

Json SegmentToJson(const SegmentIndex& segment)
{
  Json json;
  json["file"] = segment.File;
  json["firstStep"] = segment.FirstStep;
  json["steps"] = segment.Steps;
  json["bytes"] = segment.Bytes;
  json["hash"] = ToHex({ segment.HashLow, segment.HashHigh });
  return json;
}

Json StatisticsToJson(const EncodeStatistics& statistics)
{
  Json json;
  json["bricks"] = statistics.Bricks;
  json["macroVoxelBricks"] = statistics.MacroVoxelBricks;
  json["unchangedBricks"] = statistics.UnchangedBricks;
  json["mergedBricks"] = statistics.MergedBricks;
  json["rawBricks"] = statistics.RawBricks;
  json["payloadBytes"] = statistics.PayloadBytes;
  json["tableBytes"] = statistics.TableBytes;
  return json;
}

Json GridToJson(const Grid& grid)
{
  Json json;
  json["extent"] = Json::array();
  for (int axis = 0; axis < 3; ++axis)
  {
    json["extent"].push_back(grid.Extent.Lo[axis]);
    json["extent"].push_back(grid.Extent.Hi[axis] - 1);
  }
  json["origin"] = VectorToJson(grid.Origin);
  json["spacing"] = VectorToJson(grid.Spacing);
  json["direction"] = Json::array();
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      json["direction"].push_back(grid.Direction[column][row]);
    }
  }
  return json;
}

// ---- reading: every access checks the type, because nlohmann::json converts numbers silently

const Json& Member(const Json& json, const char* name)
{
  const auto found = json.find(name);
  if (found == json.end())
  {
    throw Error(std::string("The member '") + name + "' is missing");
  }
  return *found;
}

[[noreturn]] void WrongType(const char* name)
{
  throw Error(std::string("The member '") + name + "' is not what it should be");
}

double Real(const Json& json, const char* name)
{
  if (!json.is_number())
  {
    WrongType(name);
  }
  return json.get<double>();
}

std::int64_t Integer(const Json& json, const char* name, std::int64_t least, std::int64_t greatest)
{
  const bool fits = json.is_number_integer() &&
                    (!json.is_number_unsigned() ||
                      json.get<std::uint64_t>() <=
                        static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()));
  if (!fits || json.get<std::int64_t>() < least || json.get<std::int64_t>() > greatest)
  {
    WrongType(name);
  }
  return json.get<std::int64_t>();
}

int IntegerMember(const Json& json, const char* name, int least)
{
  return static_cast<int>(
    Integer(Member(json, name), name, least, std::numeric_limits<int>::max()));
}

std::int64_t CountMember(const Json& json, const char* name)
{
  return Integer(Member(json, name), name, 0, std::numeric_limits<std::int64_t>::max());
}

std::string TextMember(const Json& json, const char* name)
{
  const Json& member = Member(json, name);
  if (!member.is_string())
  {
    WrongType(name);
  }
  return member.get<std::string>();
}

const Json& ListMember(const Json& json, const char* name)
{
  const Json& member = Member(json, name);
  if (!member.is_array())
  {
    WrongType(name);
  }
  return member;
}

std::vector<double> Reals(const Json& json, const char* name, std::size_t count)
{
  const Json& list = ListMember(json, name);
  if (list.size() != count)
  {
    WrongType(name);
  }
  std::vector<double> values;
  for (const Json& item : list)
  {
    values.push_back(Real(item, name));
  }
  return values;
}

ValueRange RangeFromJson(const Json& json, const char* name)
{
  if (Member(json, name).is_null())
  {
    return {};
  }
  const std::vector<double> ends = Reals(json, name, 2);
  if (!(ends[0] <= ends[1]))
  {
    WrongType(name);
  }
  return { ends[0], ends[1] };
}

ComponentIndex ComponentFromJson(const Json& json)
{
  ComponentIndex component;
  component.Name = TextMember(json, "name");
  component.Range = RangeFromJson(json, "range");
  component.PromisedRange = RangeFromJson(json, "promisedRange");
  component.ErrorBoundAbsolute = Real(Member(json, "errorBoundAbsolute"), "errorBoundAbsolute");
  component.MeasuredMaxError = Real(Member(json, "measuredMaxError"), "measuredMaxError");
  const Json& squares = Member(json, "sumSquaredError");
  component.SumSquaredError =
    squares.is_null() ? std::numeric_limits<double>::infinity() : Real(squares, "sumSquaredError");
  component.FiniteCount = CountMember(json, "finiteCount");
  component.NonFiniteCount = CountMember(json, "nonFiniteCount");
  return component;
}

ArrayIndex ArrayFromJson(const Json& json)
{
  ArrayIndex array;
  array.Name = TextMember(json, "name");
  array.Type = ScalarTypeFromName(TextMember(json, "type"));
  for (const Json& component : ListMember(json, "components"))
  {
    array.Components.push_back(ComponentFromJson(component));
  }
  return array;
}

SegmentIndex SegmentFromJson(const Json& json)
{
  SegmentIndex segment;
  segment.File = TextMember(json, "file");
  segment.FirstStep = IntegerMember(json, "firstStep", 0);
  segment.Steps = IntegerMember(json, "steps", 1);
  segment.Bytes = static_cast<std::uint64_t>(CountMember(json, "bytes"));
  const Hash128 hash = FromHex(TextMember(json, "hash"));
  segment.HashLow = hash.Low;
  segment.HashHigh = hash.High;
  return segment;
}

EncodeStatistics StatisticsFromJson(const Json& json)
{
  EncodeStatistics statistics;
  statistics.Bricks = CountMember(json, "bricks");
  statistics.MacroVoxelBricks = CountMember(json, "macroVoxelBricks");
  statistics.UnchangedBricks = CountMember(json, "unchangedBricks");
  statistics.MergedBricks = CountMember(json, "mergedBricks");
  statistics.RawBricks = CountMember(json, "rawBricks");
  statistics.PayloadBytes = static_cast<std::uint64_t>(CountMember(json, "payloadBytes"));
  statistics.TableBytes = static_cast<std::uint64_t>(CountMember(json, "tableBytes"));
  return statistics;
}

Grid GridFromJson(const Json& json)
{
  Grid grid;
  const Json& extent = ListMember(json, "extent");
  if (extent.size() != 6)
  {
    WrongType("extent");
  }
  const std::int64_t limit = std::numeric_limits<int>::max() - 1;
  const std::vector<double> origin = Reals(json, "origin", 3);
  const std::vector<double> spacing = Reals(json, "spacing", 3);
  const std::vector<double> direction = Reals(json, "direction", 9);
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::size_t a = static_cast<std::size_t>(axis);
    grid.Extent.Lo[axis] = static_cast<int>(Integer(extent[2 * a], "extent", -limit, limit));
    grid.Extent.Hi[axis] =
      static_cast<int>(Integer(extent[2 * a + 1], "extent", -limit, limit)) + 1;
    grid.Origin[axis] = origin[a];
    grid.Spacing[axis] = spacing[a];
    for (int column = 0; column < 3; ++column)
    {
      grid.Direction[column][axis] = direction[3 * a + static_cast<std::size_t>(column)];
    }
  }
  return grid;
}

SeriesIndex IndexFromJson(const Json& json)
{
  if (!json.is_object())
  {
    throw Error("The index is not a JSON object");
  }
  SeriesIndex index;
  index.Domain = GridFromJson(json);
  index.BrickCells = IntegerMember(json, "brickCells", 1);
  index.Levels = IntegerMember(json, "levels", 1);
  index.KeyframeInterval = IntegerMember(json, "keyframeInterval", 1);
  index.ErrorBound = Real(Member(json, "errorBound"), "errorBound");
  const std::string mode = TextMember(json, "errorBoundMode");
  if (mode != "relative" && mode != "absolute")
  {
    WrongType("errorBoundMode");
  }
  index.Mode =
    mode == "relative" ? ErrorBoundMode::RelativeToSeriesRange : ErrorBoundMode::Absolute;
  index.ActiveScalars = TextMember(json, "activeScalars");
  for (const Json& array : ListMember(json, "arrays"))
  {
    index.Arrays.push_back(ArrayFromJson(array));
  }
  index.Times = Reals(json, "times", ListMember(json, "times").size());
  for (const Json& segment : ListMember(json, "segments"))
  {
    index.Segments.push_back(SegmentFromJson(segment));
  }
  index.PayloadBytesIn = static_cast<std::uint64_t>(CountMember(json, "payloadBytesIn"));
  index.Statistics = StatisticsFromJson(Member(json, "statistics"));
  return index;
}

/// Splits off the first line, having checked that it fits the rest.
std::string CheckedBody(const std::string& text)
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
  if (version != std::to_string(Version))
  {
    throw Error("The series has format version " + version + ", and this Banyan reads version " +
                std::to_string(Version));
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

std::string IndexToText(const SeriesIndex& index)
{
  CheckIndex(index);
  Json json = GridToJson(index.Domain);
  json["brickCells"] = index.BrickCells;
  json["levels"] = index.Levels;
  json["keyframeInterval"] = index.KeyframeInterval;
  json["errorBound"] = index.ErrorBound;
  json["errorBoundMode"] =
    index.Mode == ErrorBoundMode::RelativeToSeriesRange ? "relative" : "absolute";
  json["activeScalars"] = index.ActiveScalars;
  json["arrays"] = Json::array();
  for (const ArrayIndex& array : index.Arrays)
  {
    json["arrays"].push_back(ArrayToJson(array));
  }
  json["times"] = index.Times;
  json["segments"] = Json::array();
  for (const SegmentIndex& segment : index.Segments)
  {
    json["segments"].push_back(SegmentToJson(segment));
  }
  json["payloadBytesIn"] = index.PayloadBytesIn;
  json["statistics"] = StatisticsToJson(index.Statistics);
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
    const SeriesIndex index = IndexFromJson(Json::parse(CheckedBody(text)));
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
