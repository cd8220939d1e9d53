#include "Series/EncodePlan.h"

#include "Base/Error.h"
#include "Series/IndexText.h"

#include <cmath>

namespace banyan
{
namespace
{

double AbsoluteBound(const EncodeOptions& options, const ValueRange& range)
{
  if (options.Mode == ErrorBoundMode::Absolute)
  {
    return options.ErrorBound;
  }
  // Both ends by themselves: the width of a range of doubles may overflow.
  const double bound =
    range.Empty() ? 0.0 : options.ErrorBound * range.High - options.ErrorBound * range.Low;
  if (!std::isfinite(bound))
  {
    throw Error("The error bound times the range of the series is not a finite number");
  }
  return bound;
}

ArrayIndex MakeArray(const ArrayDescription& description, const EncodeOptions& options)
{
  ArrayIndex array;
  array.Name = description.Name;
  array.Type = description.Type;
  const std::size_t components = description.ComponentNames.size();
  const bool promised = !description.SeriesRanges.empty();
  if ((promised && description.SeriesRanges.size() != components) ||
      (!promised && options.Mode == ErrorBoundMode::RelativeToSeriesRange &&
        options.ErrorBound > 0))
  {
    throw Error("The array '" + description.Name +
                "' needs one series range per component for a relative error bound");
  }
  for (std::size_t c = 0; c < components; ++c)
  {
    ComponentIndex component;
    component.Name = description.ComponentNames[c];
    component.PromisedRange = promised ? description.SeriesRanges[c] : ValueRange{};
    // Which of two zeros was met first depends on who looked; adding a zero leaves the positive one.
    component.PromisedRange.Low += 0.0;
    component.PromisedRange.High += 0.0;
    component.ErrorBoundAbsolute = AbsoluteBound(options, component.PromisedRange);
    array.Components.push_back(component);
  }
  return array;
}

void CheckOptions(const EncodeOptions& options)
{
  if (!std::isfinite(options.ErrorBound) || options.ErrorBound < 0)
  {
    throw Error("The error bound must be a finite number that is not negative");
  }
  if (options.CompressionLevel < 1 || options.CompressionLevel > 19)
  {
    throw Error("The compression level must be from 1 to 19");
  }
}

} // namespace

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
  index.ActiveScalars = arrays.empty() ? "" : arrays[0].Name;
  return index;
}

} // namespace banyan
