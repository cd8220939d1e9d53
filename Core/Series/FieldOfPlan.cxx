#include "Series/FieldOfPlan.h"

#include "Base/ThreadPool.h"
#include "Series/ComponentRange.h"
#include "Series/FillValues.h"

namespace banyan
{
namespace
{

ValueRange RangeOfGroup(const FieldGroup& field, std::int64_t tuples, ThreadPool& pool)
{
  ValueRange range;
  if (!field.FillValues.empty())
  {
    ValueHistogram values;
    for (const void* step : field.Steps)
    {
      CountComponent(field.Type, step, tuples, field.Components, 0, field.FillValues, values);
    }
    return values.Range();
  }
  for (const void* step : field.Steps)
  {
    range.Include(RangeOfComponent(field.Type, step, tuples, field.Components, 0, pool));
  }
  return range;
}

/// Replaces the values of a field by clamped copies.
ClampedSteps Clamp(
  const ComponentIndex& component, std::int64_t tuples, ThreadPool& pool, FieldGroup& field)
{
  ClampedSteps clamped;
  clamped.Values.resize(field.Steps.size());
  std::vector<std::int64_t> counts(field.Steps.size());
  pool.ParallelFor(static_cast<std::int64_t>(field.Steps.size()),
    [&](std::int64_t step)
    {
      const std::size_t s = static_cast<std::size_t>(step);
      clamped.Values[s].resize(static_cast<std::size_t>(tuples) * SizeOf(field.Type));
      counts[s] = ClampComponent(field.Type, field.Steps[s], field.Components, tuples,
        component.PromisedRange, component.FillValues, clamped.Values[s].data());
      field.Steps[s] = clamped.Values[s].data();
    });
  for (const std::int64_t count : counts)
  {
    clamped.Count += count;
  }
  field.Components = 1;
  field.Component = 0;
  return clamped;
}

} // namespace

FieldOfPlan MakeField(const SeriesIndex& plan, const EncodeOptions& options, std::size_t array,
  std::size_t component, const std::vector<std::vector<ArrayValues>>& steps, ThreadPool& pool)
{
  const ArrayIndex& of = plan.Arrays[array];
  const ComponentIndex& index = of.Components[component];
  const std::int64_t tuples = plan.Domain.Extent.Count();
  FieldOfPlan made;
  FieldGroup& field = made.Field;
  field.Type = of.Type;
  for (const std::vector<ArrayValues>& step : steps)
  {
    field.Steps.push_back(
      static_cast<const char*>(step[array].Values) + component * SizeOf(of.Type));
  }
  field.Components = static_cast<int>(of.Components.size());
  field.Component = static_cast<int>(component);
  field.Samples = plan.Domain.Samples();
  field.BrickCells = plan.BrickCells;
  field.Levels = plan.Levels;
  field.Map = index.ValueTransform;
  field.Bound = index.ErrorBoundAbsolute;
  field.Profile = options.Profile;
  field.Ideas = options.Ideas;
  field.CompressionLevel = options.CompressionLevel;
  field.FillValues = index.FillValues;
  field.Expected = IsPromised(index) ? index.PromisedRange : RangeOfGroup(field, tuples, pool);
  field.Beyond = GoesBeyond(index);
  if (options.Mesh)
  {
    const auto& needed = of.CellArray.empty() ? options.Mesh->Needed : options.Mesh->NeededOfCells;
    field.Needed = needed->data();
  }
  if (!index.Opacity.empty())
  {
    field.Opacity.emplace(index.Opacity);
  }
  if (index.ClampOutside)
  {
    made.Clamped = Clamp(index, tuples, pool, field);
  }
  return made;
}

} // namespace banyan
