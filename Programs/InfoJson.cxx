// SPDX-License-Identifier: BSD-3-Clause
#include "InfoJson.h"

#include <nlohmann/json.hpp>

namespace banyan
{
namespace
{

using Json = nlohmann::ordered_json;

Json OrNull(const std::optional<double>& value)
{
  return value ? Json(*value) : Json(nullptr);
}

Json Range(const ValueRange& range)
{
  return range.Empty() ? Json(nullptr) : Json::array({ range.Low, range.High });
}

Json Vector(const glm::dvec3& v)
{
  return Json::array({ v.x, v.y, v.z });
}

Json GridToJson(const Grid& grid)
{
  Json json;
  const glm::ivec3 samples = grid.Samples();
  const Box& extent = grid.Extent;
  json["samples"] = { samples.x, samples.y, samples.z };
  json["extent"] = { extent.Lo.x, extent.Hi.x - 1, extent.Lo.y, extent.Hi.y - 1, extent.Lo.z,
    extent.Hi.z - 1 };
  json["origin"] = Vector(grid.Origin);
  json["spacing"] = Vector(grid.Spacing);
  // Row by row, as VTK has it.
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

Json SizeToJson(const SeriesReport& report)
{
  const double encoded = static_cast<double>(report.EncodedBytes());
  Json json;
  json["encodedBytes"] = report.EncodedBytes();
  json["indexBytes"] = report.IndexBytes;
  json["segmentBytes"] = report.SegmentBytes;
  json["payloadBytes"] = report.Index.Statistics.PayloadBytes;
  json["repeatedSegments"] = report.Index.Statistics.RepeatedSegments;
  json["repeatedBytes"] = report.Index.Statistics.RepeatedBytes;
  json["rawBytes"] = report.Index.PayloadBytesIn;
  json["values"] = report.Values();
  json["bitsPerValue"] = report.BitsPerValue();
  json["ratio"] = static_cast<double>(report.Index.PayloadBytesIn) / encoded;
  json["savedAgainstRaw"] = 1.0 - encoded / static_cast<double>(report.Index.PayloadBytesIn);
  json["savedAgainst8Bit"] = 1.0 - report.BitsPerValue() / 8.0;
  return json;
}

/// Returns what a look at one brick takes; null where the series does not say it.
Json ChainsToJson(const EncodeStatistics& statistics)
{
  if (statistics.ChainBricks == 0)
  {
    return nullptr;
  }
  return { { "mean", static_cast<double>(statistics.ChainSum) /
                       static_cast<double>(statistics.ChainBricks) },
    { "most", statistics.ChainMost } };
}

Json SizesToJson(const SeriesReport& report, const CountsBySize& counts)
{
  Json json = Json::array();
  for (std::size_t level = 0; level < counts.size(); ++level)
  {
    json.push_back({ { "voxels", report.VoxelsBelow(level) }, { "count", counts[level] } });
  }
  return json;
}

Json LevelToJson(const BrickCounts& counts)
{
  return { { "bricks", counts.Bricks }, { "macroVoxels", counts.MacroVoxels },
    { "unchanged", counts.Unchanged }, { "stored", counts.Stored }, { "shared", counts.Shared },
    { "withNonFinite", counts.NonFinite }, { "storedBytes", counts.StoredBytes } };
}

Json ErrorToJson(const ComponentReport& component)
{
  const ComponentIndex& index = component.Index;
  const double bound = index.ErrorBoundAbsolute;
  Json json;
  json["bound"] = bound;
  json["max"] = index.MeasuredMaxError;
  json["maxTransformed"] = index.MeasuredMaxErrorTransformed;
  json["maxOverBound"] =
    bound > 0.0 ? Json(index.MeasuredMaxErrorTransformed / bound) : Json(nullptr);
  json["rmse"] = component.Rmse();
  json["psnr"] = OrNull(Decibels(index.ReferenceRange().Width(), component.Rmse()));
  const StepReport* narrowest = component.NarrowestStep();
  json["narrowestStep"] = narrowest ? Json(narrowest->Step) : Json(nullptr);
  const std::optional<double> rmse = narrowest ? component.RmseOf(*narrowest) : std::nullopt;
  json["psnrOfNarrowestStep"] =
    rmse ? OrNull(Decibels(narrowest->Range.Width(), *rmse)) : Json(nullptr);
  return json;
}

/// Null where nothing is known.
Json BetweenToJson(const InterpolationError& error)
{
  if (error.Steps == 0)
  {
    return nullptr;
  }
  return { { "max", error.Largest }, { "rms", error.Rms }, { "maxLeftOut", error.LargestLeftOut },
    { "stepsLeftOut", error.Steps }, { "everyNthSample", error.EveryNth } };
}

/// How a component was quantized; null where it is as by default.
Json QuantizerToJson(const ComponentIndex& index)
{
  constexpr const char* kinds[] = { "uniform", "asinh", "table" };
  constexpr const char* ranges[] = { "data", "percentiles", "given" };
  Json json;
  json["transform"] = kinds[static_cast<int>(index.ValueTransform.Kind())];
  json["asinhScale"] = index.ValueTransform.Kind() == TransformKind::Asinh
                         ? Json(index.ValueTransform.Scale())
                         : Json(nullptr);
  json["rangeFrom"] = ranges[static_cast<int>(index.RangeFrom)];
  json["clamped"] = index.ClampOutside ? Json(index.ClampedCount) : Json(nullptr);
  json["fillValues"] = index.FillValues;
  json["fill"] = index.FillCount;
  json["opacity"] = Json::array();
  for (const OpacityKnot& knot : index.Opacity)
  {
    json["opacity"].push_back({ knot.Value, knot.Opacity });
  }
  json["invisible"] = index.InvisibleCount;
  json["opacityWeightedError"] =
    index.Opacity.empty() ? Json(nullptr) : Json(index.OpacityWeightedError());
  return json;
}

Json ComponentToJson(const SeriesReport& report, std::size_t number)
{
  const ComponentReport& component = report.Components[number];
  Json json;
  json["name"] = component.Name;
  json["type"] = NameOf(component.Type);
  json["transformed"] = !component.Index.ValueTransform.IsIdentity();
  json["quantizer"] = QuantizerToJson(component.Index);
  json["range"] = Range(component.Index.Range);
  json["promisedRange"] = Range(component.Index.PromisedRange);
  json["finite"] = component.Index.FiniteCount;
  json["nonFinite"] = component.Index.NonFiniteCount;
  json["error"] = ErrorToJson(component);
  if (component.Between)
  {
    json["estimatedBetweenSteps"] = BetweenToJson(*component.Between);
  }
  json["levels"] = Json::array();
  for (int level = 0; level < report.Index.Levels; ++level)
  {
    json["levels"].push_back(LevelToJson(component.Sum(level)));
  }
  json["macroVoxelsBySize"] = SizesToJson(report, component.MacroVoxels());
  json["unchangedBySize"] = SizesToJson(report, component.Unchanged());
  json["steps"] = Json::array();
  return json;
}

Json SummaryToJson(const TimeSummary& summary)
{
  return { { "count", summary.Count }, { "median", summary.Median }, { "mean", summary.Mean },
    { "percentile95", summary.Percentile95 } };
}

} // namespace

std::string InfoToJson(const SeriesReport& report, const DecodeTimes* times)
{
  const SeriesIndex& index = report.Index;
  Json json;
  json["file"] = report.File;
  if (index.Mesh)
  {
    json["mesh"] = { { "points", index.Mesh->Points }, { "cells", index.Mesh->Cells },
      { "bytes", index.Mesh->Bytes }, { "kind", index.Mesh->OfCells ? "cells" : "octree" },
      { "movedFiles", index.Mesh->Moved.size() }, { "movedBytes", BytesOfPoints(index) } };
  }
  if (index.Points)
  {
    const bool curvilinear = index.Points->Form.Kind == GridKind::Curvilinear;
    json["gridPoints"] = { { "kind", curvilinear ? "curvilinear" : "rectilinear" },
      { "files", index.Points->Files.size() }, { "bytes", BytesOfPoints(index) } };
  }
  json["grid"] = GridToJson(index.Domain);
  json["times"] = index.Times;
  json["segments"] = index.Segments.size();
  json["brickCells"] = index.BrickCells;
  json["levels"] = index.Levels;
  json["errorBound"] = { { "asked", index.ErrorBound },
    { "mode", index.Mode == ErrorBoundMode::Absolute ? "absolute" : "relative" } };
  json["size"] = SizeToJson(report);
  json["stepsToDecode"] = ChainsToJson(index.Statistics);
  json["components"] = Json::array();
  for (std::size_t c = 0; c < report.Components.size(); ++c)
  {
    json["components"].push_back(ComponentToJson(report, c));
  }
  const std::vector<StepColumn> columns = StepColumns(report);
  for (const StepLine& line : StepLines(report))
  {
    Json step;
    for (const StepColumn& column : columns)
    {
      step[column.Name] = OrNull(column.Value(line));
    }
    json["components"][line.Component]["steps"].push_back(std::move(step));
  }
  if (times)
  {
    json["microseconds"] = { { "warmBrick", SummaryToJson(times->Warm) },
      { "finestPlaneOfBrick", SummaryToJson(times->Finest) },
      { "coldBrick", SummaryToJson(times->Cold) }, { "open", SummaryToJson(times->Open) } };
    json["sequentialBytesPerSecond"] = times->SequentialBytesPerSecond;
  }
  return json.dump(2) + "\n";
}

} // namespace banyan
