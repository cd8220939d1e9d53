// SPDX-License-Identifier: BSD-3-Clause
#include "Series/GroupEncoder.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Series/FieldLattice.h"
#include "Series/FieldOfPlan.h"
#include "Series/GroupWriter.h"
#include "Series/Hash.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace banyan
{
namespace
{

ValueRange MagnitudeRange(const std::vector<double>& squares)
{
  ValueRange range;
  for (const double square : squares)
  {
    if (std::isfinite(square))
    {
      range.Include(std::sqrt(square));
    }
  }
  return range;
}

void Measure(const EncodedField& field, ComponentIndex& component, EncodeStatistics& statistics)
{
  component.Range = field.Errors.Range;
  component.MeasuredMaxError = field.Errors.Maximum;
  component.MeasuredMaxErrorTransformed = field.Errors.MaximumTransformed;
  component.SumSquaredError = field.Errors.SumSquared;
  component.StepRmse = field.StepRmse;
  component.FiniteCount = field.Errors.Finite;
  component.NonFiniteCount = field.Errors.NonFinite;
  component.FillCount = field.Errors.Fill;
  component.InvisibleCount = field.Errors.Invisible;
  component.SumWeightedError = field.Errors.SumWeighted;
  statistics.ExceptionVoxels += field.Errors.Exceptions;
  statistics.ChainSum += field.ChainSum;
  statistics.ChainBricks += field.ChainBricks;
  statistics.ChainMost = std::max<std::int64_t>(statistics.ChainMost, field.ChainMost);
}

/// Of one component.
std::int64_t ValuesOfStep(const SeriesIndex& plan, const ArrayIndex& array)
{
  return !plan.Mesh                ? plan.Domain.Extent.Count()
         : array.CellArray.empty() ? plan.Mesh->Points
                                   : plan.Mesh->Cells;
}

/// Whether the groups of a component all have one lattice.
bool HasOneLattice(ScalarType type, const ComponentIndex& component)
{
  group::FieldHead head;
  if (IsPromised(component))
  {
    ChooseLattice(type, component.ValueTransform, component.ErrorBoundAbsolute,
      component.PromisedRange, GoesBeyond(component), head);
  }
  return IsPromised(component) && !head.Exact;
}

std::size_t BytesOf(const SeriesIndex& plan, std::size_t array)
{
  return static_cast<std::size_t>(plan.Domain.Extent.Count()) * SizeOf(plan.Arrays[array].Type) *
         plan.Arrays[array].Components.size();
}

/// What the steps before the groups decode to, one component after the other.
class StepBeforeGroup
{
public:
  /// @param last of the group before, or null
  StepBeforeGroup(const SeriesIndex& plan, const EncodeOptions& options, int group,
    const std::vector<ArrayValues>& values, LastStep* last, ThreadPool& pool)
    : Plan(plan)
    , Options(options)
    , First(group == 0)
    , Values(values)
    , Pool(pool)
  {
    if (last != nullptr && last->Group >= 0 && last->Group == group - 1)
    {
      this->Known = std::move(last->Fields);
      this->KnownValues = std::move(last->Values);
    }
    if (last != nullptr)
    {
      last->Group = -1;
      last->Fields.clear();
      last->Values.clear();
    }
  }

  /// Whether an array is the same, to the bit, in all steps as in the step before, and so is what
  /// is hidden.
  bool Rests(std::size_t array, const std::vector<std::vector<ArrayValues>>& steps) const
  {
    const int flags = this->Plan.FindFlags(ArrayFlags::OfPoints);
    return this->ValuesRest(array, steps) &&
           (flags < 0 || this->ValuesRest(static_cast<std::size_t>(flags), steps));
  }

  /// Null when the group does not refer to it; until the next call.
  /// @param number of the component among those of all arrays
  const KeyFrame* Of(std::size_t array, std::size_t component, std::size_t number)
  {
    const ArrayIndex& of = this->Plan.Arrays[array];
    if (this->First || !HasOneLattice(of.Type, of.Components[component]))
    {
      return nullptr;
    }
    if (!this->Known.empty())
    {
      this->Frame = std::move(this->Known[number]);
      return &this->Frame;
    }
    this->MustBeKnown(false);
    const FieldOfPlan made =
      MakeField(this->Plan, this->Options, array, component, { this->Values }, this->Pool);
    this->Frame = EncodeKeyFrame(made.Field, this->Pool);
    return &this->Frame;
  }

  /// The memory of what the last call gave, which must not be used any more.
  std::vector<PlaneNumbers> Release() { return std::move(this->Frame.Planes); }

private:
  bool ValuesRest(std::size_t array, const std::vector<std::vector<ArrayValues>>& steps) const
  {
    const std::vector<ComponentIndex>& components = this->Plan.Arrays[array].Components;
    if (this->First || steps.size() < 2 || this->Options.ClosedGroups ||
        !this->Options.Ideas.RestingArrays ||
        !std::all_of(components.begin(), components.end(), IsPromised))
    {
      return false;
    }
    this->MustBeKnown(!this->KnownValues.empty());
    const std::size_t bytes = BytesOf(this->Plan, array);
    const Hash128 before = this->KnownValues.empty() ? HashOf(this->Values[array].Values, bytes)
                                                     : this->KnownValues[array];
    const void* const first = steps[0][array].Values;
    return HashOf(first, bytes) == before &&
           std::all_of(steps.begin() + 1, steps.end(),
             [&](const std::vector<ArrayValues>& step)
             { return std::memcmp(step[array].Values, first, bytes) == 0; });
  }

  void MustBeKnown(bool known) const
  {
    if (!known && this->Values.empty())
    {
      throw Error("A group of steps cannot be encoded without the step before it");
    }
  }

  const SeriesIndex& Plan;
  const EncodeOptions& Options;
  bool First;
  const std::vector<ArrayValues>& Values;
  ThreadPool& Pool;
  std::vector<KeyFrame> Known;
  std::vector<Hash128> KnownValues;
  KeyFrame Frame;
};

} // namespace

bool MayReferBefore(const SeriesIndex& plan, const EncodeOptions& options)
{
  bool may = false;
  for (const ArrayIndex& array : plan.Arrays)
  {
    for (const ComponentIndex& component : array.Components)
    {
      may = may || IsPromised(component);
    }
  }
  return may && plan.KeyframeInterval > 1 && !options.ClosedGroups;
}

EncodedGroup EncodeGroup(const SeriesIndex& plan, const EncodeOptions& options,
  SegmentFolder& folder, int number, const std::vector<double>& times,
  const std::vector<std::vector<ArrayValues>>& steps, const std::vector<ArrayValues>& before,
  LastStep* last, ThreadPool& pool, const std::function<bool(double)>& tell)
{
  EncodedGroup group;
  group.Times = times;
  const std::int64_t tuples = plan.Domain.Extent.Count();
  std::size_t components = 0;
  for (const ArrayIndex& array : plan.Arrays)
  {
    components += array.Components.size();
  }
  StepBeforeGroup stepBefore(plan, options, number, before, last, pool);
  const std::int64_t count = static_cast<std::int64_t>(steps.size());
  SparePlanes own;
  SparePlanes& spare = last != nullptr ? last->Spare : own;
  std::vector<EncodedField> fields;
  for (std::size_t a = 0; a < plan.Arrays.size(); ++a)
  {
    const ArrayIndex& array = plan.Arrays[a];
    const bool vectors = array.Components.size() > 1;
    std::vector<std::vector<double>> squares;
    if (vectors)
    {
      squares.assign(steps.size(), std::vector<double>(static_cast<std::size_t>(tuples)));
    }
    group.Measured.emplace_back(array.Components.size());
    const bool rests = stepBefore.Rests(a, steps);
    if (rests && vectors)
    {
      squares.resize(1);
    }
    for (std::size_t c = 0; c < array.Components.size(); ++c)
    {
      const double done = static_cast<double>(fields.size());
      const auto tellSteps = [&](double more)
      {
        const double share = (done + more / double(steps.size())) / double(components);
        if (tell && !tell(std::min(share, 0.999999)))
        {
          throw Error("Encoding was interrupted");
        }
      };
      FieldOfPlan made = rests ? MakeField(plan, options, a, c, { steps.back() }, pool)
                               : MakeField(plan, options, a, c, steps, pool);
      made.Field.Spare = &spare;
      if (steps.size() > 1 && !rests && !options.ClosedGroups && options.Ideas.GroupBefore)
      {
        tellSteps(0);
        made.Field.Before = stepBefore.Of(a, c, fields.size());
      }
      fields.push_back(EncodeFieldGroup(made.Field, pool, vectors ? &squares : nullptr, tellSteps));
      spare.push_back(stepBefore.Release());
      if (last == nullptr || !HasOneLattice(array.Type, array.Components[c]))
      {
        spare.push_back(std::move(fields.back().Last.Planes));
        fields.back().Last = {};
      }
      if (rests)
      {
        LetRest(fields.back(), count);
      }
      Measure(fields.back(), group.Measured[a][c], group.Statistics);
      group.Measured[a][c].ClampedCount = made.Clamped.Count * (rests ? count : 1);
      group.BytesIn +=
        static_cast<std::uint64_t>(ValuesOfStep(plan, array)) * SizeOf(array.Type) * steps.size();
    }
    group.Magnitudes.emplace_back();
    for (const std::vector<double>& step : squares)
    {
      group.Magnitudes.back().push_back(MagnitudeRange(step));
    }
    if (rests && vectors)
    {
      group.Magnitudes.back().resize(steps.size(), group.Magnitudes.back()[0]);
    }
  }
  GroupWriter writer(folder, number);
  std::vector<group::FieldHead> heads;
  std::vector<group::TableShape> shapes;
  for (const EncodedField& field : fields)
  {
    heads.push_back(field.Head);
    shapes.push_back(
      group::ShapeOf(plan.Domain.Samples(), field.Head.Axes, plan.BrickCells, plan.Levels));
  }
  for (std::size_t t = 0; t < steps.size(); ++t)
  {
    for (EncodedField& field : fields)
    {
      if (field.Head.Rests)
      {
        writer.AddRestingStep(field.Steps[0], group.Statistics);
        continue;
      }
      writer.AddStep(field.Steps[t], group.Statistics);
      field.Steps[t] = {};
    }
  }
  group.Segment =
    writer.Finish(heads, shapes, number * plan.KeyframeInterval, static_cast<int>(steps.size()));
  group.Statistics.TableBytes = group.Segment.Bytes - group.Statistics.PayloadBytes;
  if (last != nullptr)
  {
    last->Group = number;
    for (std::size_t a = 0; a < plan.Arrays.size(); ++a)
    {
      last->Values.push_back(HashOf(steps.back()[a].Values, BytesOf(plan, a)));
    }
    for (EncodedField& field : fields)
    {
      last->Fields.push_back(std::move(field.Last));
    }
  }
  return group;
}

} // namespace banyan
