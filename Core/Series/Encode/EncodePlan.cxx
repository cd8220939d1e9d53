// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/EncodePlan.h"

#include "Base/Error.h"
#include "Series/Format/IndexText.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

/// A bound so small that doubles lie as far apart as it is large: rounded, it might be twice what
/// was asked for.
double NotAbove(long double bound)
{
  const double rounded = static_cast<double>(bound);
  return static_cast<long double>(rounded) > bound ? std::nextafter(rounded, 0.0) : rounded;
}

double AbsoluteBound(
  const EncodeOptions& options, const Transform& transform, const ValueRange& range)
{
  if (options.Mode == ErrorBoundMode::Absolute)
  {
    return options.ErrorBound;
  }
  // Both ends by themselves: the width of a range of doubles may overflow.
  const double bound = range.Empty() ? 0.0
                                     : options.ErrorBound * transform.Forward(range.High) -
                                         options.ErrorBound * transform.Forward(range.Low);
  if (!std::isfinite(bound))
  {
    throw Error("The error bound times the range of the series is not a finite number: choose a "
                "smaller bound");
  }
  if (bound < 2 * std::numeric_limits<double>::min() && !range.Empty())
  {
    return NotAbove(static_cast<long double>(options.ErrorBound) *
                    (static_cast<long double>(transform.Forward(range.High)) -
                      static_cast<long double>(transform.Forward(range.Low))));
  }
  return bound;
}

bool IsRelative(const EncodeOptions& options)
{
  return options.Mode == ErrorBoundMode::RelativeToSeriesRange && options.ErrorBound > 0;
}

void CheckDescription(const ArrayDescription& description, const EncodeOptions& options)
{
  const std::size_t components = description.ComponentNames.size();
  const bool promised = !description.SeriesRanges.empty();
  const bool counted = !description.Histograms.empty();
  const bool given = options.QuantizerFor(description.Name).Range.From == RangeRule::Source::Given;
  if ((promised && description.SeriesRanges.size() != components) ||
      (!promised && !counted && !given && IsRelative(options)))
  {
    throw Error("The array '" + description.Name +
                "' needs one series range per component for a relative error bound");
  }
  if (counted && description.Histograms.size() != components)
  {
    throw Error("The array '" + description.Name + "' needs one histogram per component, or none");
  }
}

ArrayIndex MakeFlags(const ArrayDescription& description)
{
  ArrayIndex array;
  array.Name = description.Name;
  array.Type = description.Type;
  array.Flags = description.Flags;
  ComponentIndex component;
  const int bits = array.Flags == ArrayFlags::OfPoints ? HiddenPointBits : HiddenCellBits;
  component.PromisedRange = { 0.0, static_cast<double>(bits) };
  array.Components.push_back(std::move(component));
  return array;
}

ArrayIndex MakeArray(const ArrayDescription& description, const EncodeOptions& options)
{
  if (description.Flags != ArrayFlags::None)
  {
    return MakeFlags(description);
  }
  CheckDescription(description, options);
  ArrayIndex array;
  array.Name = description.Name;
  array.Type = description.Type;
  for (std::size_t c = 0; c < description.ComponentNames.size(); ++c)
  {
    ComponentIndex component;
    component.Name = description.ComponentNames[c];
    ApplyQuantizer(options.QuantizerFor(description.Name),
      description.Histograms.empty() ? nullptr : &description.Histograms[c],
      description.SeriesRanges.empty() ? ValueRange{} : description.SeriesRanges[c],
      IsRelative(options), component);
    // Which of two zeros was met first depends on who looked; adding a zero leaves the positive
    // one.
    component.PromisedRange.Low += 0.0;
    component.PromisedRange.High += 0.0;
    component.ErrorBoundAbsolute =
      AbsoluteBound(options, component.ValueTransform, component.PromisedRange);
    array.Components.push_back(std::move(component));
  }
  return array;
}

void CheckOptions(const EncodeOptions& options)
{
  if (!std::isfinite(options.ErrorBound) || options.ErrorBound < 0)
  {
    throw Error("The error bound must be a finite number that is not negative, and is " +
                std::to_string(options.ErrorBound));
  }
  if (options.CompressionLevel < 1 || options.CompressionLevel > 19)
  {
    throw Error("The compression level must be from 1 to 19");
  }
}

void AddMesh(const MeshPlan& plan, SeriesIndex& index)
{
  index.Mesh = plan.Index;
  bool cellArrays = false;
  for (ArrayIndex& array : index.Arrays)
  {
    const auto found = plan.CellArrays.find(array.Name);
    if (found != plan.CellArrays.end())
    {
      array.CellArray = found->second;
      cellArrays = true;
    }
  }
  const auto samples = static_cast<std::size_t>(index.Domain.Extent.Count());
  const bool told = plan.Needed && plan.Needed->size() == samples;
  const bool toldOfCells = plan.NeededOfCells && plan.NeededOfCells->size() == samples;
  if (!told || (cellArrays && !toldOfCells))
  {
    throw Error("It must be said of each sample whether it stands for a point or cell of the mesh");
  }
}

} // namespace

const QuantizerOptions& EncodeOptions::QuantizerFor(const std::string& array) const
{
  const auto own = this->QuantizerOfArray.find(array);
  return own == this->QuantizerOfArray.end() ? this->Quantizer : own->second;
}

ArrayDescription DescriptionOfFlags(ArrayFlags flags)
{
  ArrayDescription description;
  description.Name = flags == ArrayFlags::OfPoints ? FlagsName : CellFlagsName;
  description.Type = ScalarType::UInt8;
  description.ComponentNames = { "" };
  description.Flags = flags;
  return description;
}

bool EncodeOptions::NeedsHistogram(const std::string& array) const
{
  return this->QuantizerFor(array).NeedsHistogram(IsRelative(*this));
}

int ChooseBrickCells(const glm::ivec3& samples)
{
  constexpr std::int64_t large = std::int64_t{ 1 } << 24;
  return std::int64_t{ samples.x } * samples.y * samples.z >= large ? 32 : 16;
}

SeriesIndex PlanSeries(
  const Grid& grid, const std::vector<ArrayDescription>& arrays, const EncodeOptions& options)
{
  CheckOptions(options);
  CheckGrid(grid, options.BrickCells == 0 ? 16 : options.BrickCells);
  SeriesIndex index;
  index.Domain = grid;
  index.BrickCells =
    options.BrickCells == 0 ? ChooseBrickCells(grid.Samples()) : options.BrickCells;
  index.Levels = BrickLayout::LevelCount(grid.Samples(), index.BrickCells);
  index.KeyframeInterval = options.KeyframeInterval;
  index.ErrorBound = options.ErrorBound;
  index.Mode = options.Mode;
  for (const ArrayDescription& array : arrays)
  {
    index.Arrays.push_back(MakeArray(array, options));
  }
  for (const auto& own : options.QuantizerOfArray)
  {
    if (index.FindArray(own.first) < 0)
    {
      throw Error("There are quantizer options for the array '" + own.first +
                  "', and the series has no such array");
    }
  }
  if (options.Mesh)
  {
    AddMesh(*options.Mesh, index);
  }
  if (options.Points)
  {
    index.Points = PointsIndex{ *options.Points, {} };
  }
  // Cell arrays are numbers of blocks and the like as often as not.
  const auto ofPoints = std::find_if(index.Arrays.begin(), index.Arrays.end(),
    [](const ArrayIndex& array)
    { return array.CellArray.empty() && array.Flags == ArrayFlags::None; });
  index.ActiveScalars = ofPoints != index.Arrays.end() ? ofPoints->Name
                        : arrays.empty()               ? ""
                                                       : arrays[0].Name;
  return index;
}

} // namespace banyan
