// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/FieldToEncode.h"

#include "Base/ThreadPool.h"
#include "Series/Quantize/ComponentRange.h"
#include "Series/Quantize/FillValues.h"

#include <algorithm>

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
    for (std::size_t s = 0; s < field.Steps.size(); ++s)
    {
      CountComponent(field.Type, field.Steps[s], tuples, field.Components, 0, field.FillValues,
        values, field.HiddenAt(s));
    }
    return values.Range();
  }
  for (std::size_t s = 0; s < field.Steps.size(); ++s)
  {
    range.Include(RangeOfComponent(
      field.Type, field.Steps[s], tuples, field.Components, 0, pool, field.HiddenAt(s)));
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
        component.PromisedRange, component.FillValues, field.HiddenAt(s), clamped.Values[s].data());
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

/// The flags of points, of each step; null where none is hidden.
std::vector<const std::uint8_t*> HiddenOf(
  const std::vector<std::vector<ArrayValues>>& steps, std::size_t flags, std::int64_t tuples)
{
  std::vector<const std::uint8_t*> hidden;
  for (const std::vector<ArrayValues>& step : steps)
  {
    const auto* const bytes = static_cast<const std::uint8_t*>(step[flags].Values);
    const bool some =
      std::any_of(bytes, bytes + tuples, [](std::uint8_t flag) { return flag != 0; });
    hidden.push_back(some ? bytes : nullptr);
  }
  return hidden;
}

} // namespace

FieldToEncode MakeField(const SeriesIndex& plan, const EncodeOptions& options, std::size_t array,
  std::size_t component, const std::vector<std::vector<ArrayValues>>& steps, ThreadPool& pool)
{
  const ArrayIndex& of = plan.Arrays[array];
  const ComponentIndex& index = of.Components[component];
  const std::int64_t tuples = plan.Domain.Extent.Count();
  FieldToEncode made;
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
  field.Ablation = options.Ablation;
  field.CompressionLevel = options.CompressionLevel;
  field.FillValues = index.FillValues;
  field.Beyond = GoesBeyond(index);
  const int flags = plan.FindFlags(ArrayFlags::OfPoints);
  if (flags >= 0 && of.Flags == ArrayFlags::None)
  {
    field.Hidden = HiddenOf(steps, static_cast<std::size_t>(flags), tuples);
  }
  field.Expected = IsPromised(index) ? index.PromisedRange : RangeOfGroup(field, tuples, pool);
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
