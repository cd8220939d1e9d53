// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Steps/StepSource.h"

#include "Base/Error.h"
#include "Cache/BrickCache.h"
#include "Render/Bricks/SeriesBrickSource.h"
#include "Render/Steps/EnhancedBrickSource.h"
#include "Render/Steps/InterpolatedBrickSource.h"

#include <algorithm>
#include <utility>

namespace banyan
{
namespace
{

/// Null where there is no such step.
std::unique_ptr<BrickSource> PlainSource(
  const std::shared_ptr<const SeriesFile>& series, const FieldKey& field, int component, int step)
{
  FieldKey key = field;
  key.Step = step;
  return step < 0 || step >= series->Index().Steps()
           ? nullptr
           : std::make_unique<SeriesBrickSource>(series, key, component, BrickCache::Of(*series));
}

} // namespace

std::unique_ptr<BrickSource> MakeSeriesSource(const std::shared_ptr<const SeriesFile>& series,
  const FieldKey& field, int component, const TemporalEnhancement& how)
{
  const auto at = [&](int step) { return PlainSource(series, field, component, step); };
  std::unique_ptr<BrickSource> source;
  if (how.Strength != 0.0 && component == SampleArray::Colours)
  {
    throw Error("Temporal enhancement is of one value per point, and colours have several: switch "
                "one of the two off");
  }
  if (how.Strength == 0.0)
  {
    source = at(field.Step);
  }
  else
  {
    TemporalEnhancement complete = how;
    const ArrayIndex& array = series->Index().Arrays.at(static_cast<std::size_t>(field.Array));
    complete.NoiseFloor = EnhancementFor(array, how.Strength, component).NoiseFloor;
    source = std::make_unique<EnhancedBrickSource>(
      complete, at(field.Step - 1), at(field.Step), at(field.Step + 1));
  }
  if (source)
  {
    source->ShareBudgetOf(series->Caches());
  }
  return source;
}

std::unique_ptr<BrickSource> MakeSourceBetween(const std::shared_ptr<const SeriesFile>& series,
  const FieldKey& field, int component, double fraction)
{
  if (fraction == 0.0)
  {
    return MakeSeriesSource(series, field, component, { 0.0, 1.0, 0.0 });
  }
  const ArrayIndex& array = series->Index().Arrays.at(static_cast<std::size_t>(field.Array));
  if (!AreInterpolated(array.Type) || field.Step + 1 >= series->Index().Steps())
  {
    throw Error("Array '" + array.Name + "' has no values after step " +
                  std::to_string(field.Step) + " and before the next one",
      { series->Path() });
  }
  const int components = static_cast<int>(array.Components.size());
  const bool joins = component < 0 && components > 1;
  const auto ends = [&](int of)
  {
    InterpolatedBrickSource::Ends steps;
    steps.Earlier = PlainSource(series, field, of, field.Step);
    steps.Later = PlainSource(series, field, of, field.Step + 1);
    return steps;
  };
  std::vector<InterpolatedBrickSource::Part> parts;
  const int first = joins ? 0 : std::max(component, 0);
  for (int c = first; c < (joins ? components : first + 1); ++c)
  {
    InterpolatedBrickSource::Part& part = parts.emplace_back();
    part.Steps = ends(c);
    part.How = { fraction, array.Components.at(static_cast<std::size_t>(c)).FillValues };
  }
  auto source = std::make_unique<InterpolatedBrickSource>(array.Type, std::move(parts),
    joins ? ends(component) : InterpolatedBrickSource::Ends{}, component);
  source->ShareBudgetOf(series->Caches());
  return source;
}

} // namespace banyan
