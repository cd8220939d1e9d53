// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Hash.h"
#include "Series/Format/IndexJson.h"
#include "Series/Format/IndexText.h"
#include "Series/Format/QuantizerJson.h"
#include "Series/Format/TransformJson.h"
#include "Series/Quantize/ShortNumbers.h"

#include <cmath>

namespace banyan
{
namespace
{

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
  json["measuredMaxErrorTransformed"] = component.MeasuredMaxErrorTransformed;
  json["measuredMaxError"] = component.MeasuredMaxError;
  // The one number that may overflow: squares of large errors.
  json["sumSquaredError"] =
    std::isfinite(component.SumSquaredError) ? Json(component.SumSquaredError) : Json(nullptr);
  if (!component.StepRmse.empty())
  {
    json["stepRmse"] = ShortNumbers(component.StepRmse);
  }
  json["finiteCount"] = component.FiniteCount;
  json["nonFiniteCount"] = component.NonFiniteCount;
  if (!component.ValueTransform.IsIdentity())
  {
    json["transform"] = TransformToJson(component.ValueTransform);
  }
  QuantizerToJson(component, json);
  return json;
}

Json ArrayToJson(const ArrayIndex& array)
{
  Json json;
  json["name"] = array.Name;
  if (!array.CellArray.empty())
  {
    json["cellArray"] = array.CellArray;
  }
  if (array.Flags != ArrayFlags::None)
  {
    json["flags"] = array.Flags == ArrayFlags::OfPoints ? "points" : "cells";
  }
  json["type"] = NameOf(array.Type);
  for (const ComponentIndex& component : array.Components)
  {
    json["components"].push_back(ComponentToJson(component));
  }
  json["magnitudes"] = Json::array();
  for (const ValueRange& magnitude : array.Magnitudes)
  {
    json["magnitudes"].push_back(RangeToJson(magnitude));
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
  json["blocks"] = statistics.Blocks;
  json["emptyBlocks"] = statistics.EmptyBlocks;
  json["exceptionVoxels"] = statistics.ExceptionVoxels;
  json["chainSum"] = statistics.ChainSum;
  json["chainBricks"] = statistics.ChainBricks;
  json["chainMost"] = statistics.ChainMost;
  json["repeatedSegments"] = statistics.RepeatedSegments;
  json["repeatedBytes"] = statistics.RepeatedBytes;
  return json;
}

Json FilesToJson(const std::vector<PointsFile>& files)
{
  Json json = Json::array();
  for (const PointsFile& file : files)
  {
    Json one;
    one["file"] = file.File;
    one["firstStep"] = file.FirstStep;
    one["bytes"] = file.Bytes;
    one["hash"] = ToHex({ file.HashLow, file.HashHigh });
    json.push_back(one);
  }
  return json;
}

Json MeshToJson(const MeshIndex& mesh)
{
  Json json;
  json["file"] = mesh.File;
  json["bytes"] = mesh.Bytes;
  json["hash"] = ToHex({ mesh.HashLow, mesh.HashHigh });
  json["points"] = mesh.Points;
  json["cells"] = mesh.Cells;
  if (mesh.OfCells)
  {
    json["kind"] = "cells";
    json["moved"] = FilesToJson(mesh.Moved);
  }
  return json;
}

Json PointsToJson(const PointsIndex& points)
{
  Json json;
  json["kind"] = points.Form.Kind == GridKind::Rectilinear ? "rectilinear" : "curvilinear";
  for (const ScalarType type : points.Form.Types)
  {
    json["types"].push_back(NameOf(type));
  }
  json["files"] = FilesToJson(points.Files);
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

} // namespace

Json IndexToJson(const SeriesIndex& index)
{
  Json json;
  json["features"] = FeaturesOf(index);
  json.update(GridToJson(index.Domain));
  if (index.Mesh)
  {
    json["mesh"] = MeshToJson(*index.Mesh);
  }
  if (index.Points)
  {
    json["gridPoints"] = PointsToJson(*index.Points);
  }
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
  return json;
}

} // namespace banyan
