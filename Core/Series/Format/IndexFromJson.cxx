// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Base/Hash.h"
#include "Series/Format/IndexJson.h"
#include "Series/Format/JsonMembers.h"
#include "Series/Format/QuantizerJson.h"
#include "Series/Format/TransformJson.h"
#include "Series/Quantize/ShortNumbers.h"

#include <limits>

namespace banyan
{
namespace
{

using namespace json_members;

/// @param json the range itself
ValueRange RangeOf(const Json& json, const char* name)
{
  if (json.is_null())
  {
    return {};
  }
  if (!json.is_array() || json.size() != 2 || !(Real(json[0], name) <= Real(json[1], name)))
  {
    WrongType(name);
  }
  return { Real(json[0], name), Real(json[1], name) };
}

ValueRange RangeFromJson(const Json& json, const char* name)
{
  return RangeOf(Member(json, name), name);
}

ComponentIndex ComponentFromJson(const Json& json)
{
  ComponentIndex component;
  component.Name = TextMember(json, "name");
  component.Range = RangeFromJson(json, "range");
  component.PromisedRange = RangeFromJson(json, "promisedRange");
  component.ErrorBoundAbsolute = Real(Member(json, "errorBoundAbsolute"), "errorBoundAbsolute");
  component.MeasuredMaxError = Real(Member(json, "measuredMaxError"), "measuredMaxError");
  component.MeasuredMaxErrorTransformed =
    json.contains("measuredMaxErrorTransformed")
      ? Real(Member(json, "measuredMaxErrorTransformed"), "measuredMaxErrorTransformed")
      : component.MeasuredMaxError;
  const Json& squares = Member(json, "sumSquaredError");
  component.SumSquaredError =
    squares.is_null() ? std::numeric_limits<double>::infinity() : Real(squares, "sumSquaredError");
  if (json.contains("stepRmse"))
  {
    component.StepRmse = FromShortNumbers(TextMember(json, "stepRmse"));
  }
  component.FiniteCount = CountMember(json, "finiteCount");
  component.NonFiniteCount = CountMember(json, "nonFiniteCount");
  const auto transform = json.find("transform");
  if (transform != json.end())
  {
    component.ValueTransform = TransformFromJson(*transform);
  }
  QuantizerFromJson(json, component);
  return component;
}

ArrayIndex ArrayFromJson(const Json& json)
{
  ArrayIndex array;
  array.Name = TextMember(json, "name");
  if (json.contains("cellArray"))
  {
    array.CellArray = TextMember(json, "cellArray");
  }
  if (json.contains("flags"))
  {
    const std::string flags = TextMember(json, "flags");
    if (flags != "points" && flags != "cells")
    {
      throw Error(
        "The flags of the array '" + array.Name + "' are neither those of points nor of cells");
    }
    array.Flags = flags == "points" ? ArrayFlags::OfPoints : ArrayFlags::OfCells;
  }
  array.Type = ScalarTypeFromName(TextMember(json, "type"));
  for (const Json& component : ListMember(json, "components"))
  {
    array.Components.push_back(ComponentFromJson(component));
  }
  for (const Json& magnitude : ListMember(json, "magnitudes"))
  {
    array.Magnitudes.push_back(RangeOf(magnitude, "magnitudes"));
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

std::vector<PointsFile> FilesFromJson(const Json& json)
{
  std::vector<PointsFile> files;
  for (const Json& one : json)
  {
    PointsFile file;
    file.File = TextMember(one, "file");
    file.FirstStep = IntegerMember(one, "firstStep", 0);
    file.Bytes = static_cast<std::uint64_t>(CountMember(one, "bytes"));
    const Hash128 hash = FromHex(TextMember(one, "hash"));
    file.HashLow = hash.Low;
    file.HashHigh = hash.High;
    files.push_back(std::move(file));
  }
  return files;
}

MeshIndex MeshFromJson(const Json& json)
{
  MeshIndex mesh;
  mesh.File = TextMember(json, "file");
  mesh.Bytes = static_cast<std::uint64_t>(CountMember(json, "bytes"));
  const Hash128 hash = FromHex(TextMember(json, "hash"));
  mesh.HashLow = hash.Low;
  mesh.HashHigh = hash.High;
  mesh.Points = CountMember(json, "points");
  mesh.Cells = CountMember(json, "cells");
  if (json.contains("kind"))
  {
    if (TextMember(json, "kind") != "cells")
    {
      throw Error("The mesh is of an unknown kind");
    }
    mesh.OfCells = true;
    mesh.Moved = FilesFromJson(ListMember(json, "moved"));
  }
  return mesh;
}

PointsIndex PointsFromJson(const Json& json)
{
  PointsIndex points;
  const std::string kind = TextMember(json, "kind");
  if (kind != "rectilinear" && kind != "curvilinear")
  {
    throw Error("The grid is neither rectilinear nor curvilinear");
  }
  points.Form.Kind = kind == "rectilinear" ? GridKind::Rectilinear : GridKind::Curvilinear;
  const Json& types = ListMember(json, "types");
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    if (types.size() != 3 || !types[axis].is_string())
    {
      WrongType("types");
    }
    points.Form.Types[axis] = ScalarTypeFromName(types[axis].get<std::string>());
  }
  points.Files = FilesFromJson(ListMember(json, "files"));
  return points;
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
  statistics.Blocks = CountMember(json, "blocks");
  statistics.EmptyBlocks = CountMember(json, "emptyBlocks");
  statistics.ExceptionVoxels = CountMember(json, "exceptionVoxels");
  statistics.ChainSum = CountMember(json, "chainSum");
  statistics.ChainBricks = CountMember(json, "chainBricks");
  statistics.ChainMost = CountMember(json, "chainMost");
  statistics.RepeatedSegments = CountMember(json, "repeatedSegments");
  statistics.RepeatedBytes = static_cast<std::uint64_t>(CountMember(json, "repeatedBytes"));
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

} // namespace

SeriesIndex IndexFromJson(const Json& json)
{
  SeriesIndex index;
  index.Domain = GridFromJson(json);
  const auto mesh = json.find("mesh");
  if (mesh != json.end())
  {
    index.Mesh = MeshFromJson(*mesh);
  }
  const auto points = json.find("gridPoints");
  if (points != json.end())
  {
    index.Points = PointsFromJson(*points);
  }
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

} // namespace banyan
