// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/GroupEncoder.h"

#include "Base/Error.h"
#include "Base/Hash.h"
#include "Base/ThreadPool.h"
#include "Series/Encode/FieldGroupEncoder.h"
#include "Series/Encode/FieldToEncode.h"
#include "Series/Encode/GroupWriter.h"
#include "Series/Format/FieldLattice.h"

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

/// Returns the number of values of one component.
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

/// Gives what the steps before the groups decode to, one component after the other.
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
  bool IsStatic(std::size_t array, const std::vector<std::vector<ArrayValues>>& steps) const
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
    const FieldToEncode made =
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
        !this->Options.Ablation.StaticArrays ||
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

/// Encodes one group: the fields first, then its segment.
class GroupEncoding
{
public:
  GroupEncoding(const SeriesIndex& plan, const EncodeOptions& options, const GroupSteps& steps,
    LastStep* last, ThreadPool& pool, const std::function<bool(double)>& tell)
    : Plan(plan)
    , Options(options)
    , Steps(steps)
    , Last(last)
    , Pool(pool)
    , Tell(tell)
    , Before(plan, options, steps.Number, steps.Before, last, pool)
    , Spare(last != nullptr ? last->Spare : this->OwnSpare)
  {
    for (const ArrayIndex& array : plan.Arrays)
    {
      this->Components += array.Components.size();
    }
  }

  EncodedGroup Run(SegmentFolder& folder)
  {
    this->Group.Times = this->Steps.Times;
    for (std::size_t a = 0; a < this->Plan.Arrays.size(); ++a)
    {
      this->EncodeArray(a);
    }
    this->Write(folder);
    this->KeepLastStep();
    return std::move(this->Group);
  }

private:
  std::size_t Count() const { return this->Steps.Values.size(); }

  void EncodeArray(std::size_t a)
  {
    const ArrayIndex& array = this->Plan.Arrays[a];
    const bool rests = this->Before.IsStatic(a, this->Steps.Values);
    std::vector<std::vector<double>> squares; // of the lengths of vectors, by step
    if (array.Components.size() > 1)
    {
      const auto tuples = static_cast<std::size_t>(this->Plan.Domain.Extent.Count());
      squares.assign(rests ? 1 : this->Count(), std::vector<double>(tuples));
    }
    this->Group.Measured.emplace_back(array.Components.size());
    for (std::size_t c = 0; c < array.Components.size(); ++c)
    {
      this->EncodeComponent(a, c, rests, squares.empty() ? nullptr : &squares);
    }
    std::vector<ValueRange>& magnitudes = this->Group.Magnitudes.emplace_back();
    for (const std::vector<double>& step : squares)
    {
      magnitudes.push_back(MagnitudeRange(step));
    }
    if (!magnitudes.empty())
    {
      magnitudes.resize(this->Count(), ValueRange(magnitudes[0]));
    }
  }

  void EncodeComponent(
    std::size_t a, std::size_t c, bool rests, std::vector<std::vector<double>>* squares)
  {
    const ArrayIndex& array = this->Plan.Arrays[a];
    const double done = static_cast<double>(this->Fields.size());
    const auto tell = [&](double more)
    {
      const double share =
        (done + more / static_cast<double>(this->Count())) / static_cast<double>(this->Components);
      if (this->Tell && !this->Tell(std::min(share, 0.999999)))
      {
        throw Error("Encoding was interrupted");
      }
    };
    FieldToEncode made =
      rests ? MakeField(this->Plan, this->Options, a, c, { this->Steps.Values.back() }, this->Pool)
            : MakeField(this->Plan, this->Options, a, c, this->Steps.Values, this->Pool);
    made.Field.Spare = &this->Spare;
    if (this->Count() > 1 && !rests && !this->Options.ClosedGroups &&
        this->Options.Ablation.GroupBefore)
    {
      tell(0);
      made.Field.Before = this->Before.Of(a, c, this->Fields.size());
    }
    EncodedField& field =
      this->Fields.emplace_back(EncodeFieldGroup(made.Field, this->Pool, squares, tell));
    this->Spare.push_back(this->Before.Release());
    if (this->Last == nullptr || !HasOneLattice(array.Type, array.Components[c]))
    {
      this->Spare.push_back(std::move(field.Last.Planes));
      field.Last = {};
    }
    const auto count = static_cast<std::int64_t>(this->Count());
    if (rests)
    {
      MarkStatic(field, count);
    }
    ComponentIndex& measured = this->Group.Measured[a][c];
    Measure(field, measured, this->Group.Statistics);
    measured.ClampedCount = made.Clamped.Count * (rests ? count : 1);
    this->Group.BytesIn += static_cast<std::uint64_t>(ValuesOfStep(this->Plan, array)) *
                           SizeOf(array.Type) * this->Count();
  }

  /// Frees the tables of the fields on its way.
  void Write(SegmentFolder& folder)
  {
    GroupWriter writer(folder, this->Steps.Number);
    std::vector<group::FieldHead> heads;
    std::vector<group::TableShape> shapes;
    for (const EncodedField& field : this->Fields)
    {
      heads.push_back(field.Head);
      shapes.push_back(group::ShapeOf(
        this->Plan.Domain.Samples(), field.Head.Axes, this->Plan.BrickCells, this->Plan.Levels));
    }
    EncodeStatistics& statistics = this->Group.Statistics;
    for (std::size_t t = 0; t < this->Count(); ++t)
    {
      for (EncodedField& field : this->Fields)
      {
        if (field.Head.Static)
        {
          writer.AddStaticStep(field.Steps[0], statistics);
          continue;
        }
        writer.AddStep(field.Steps[t], statistics);
        field.Steps[t] = {};
      }
    }
    this->Group.Segment = writer.Finish(heads, shapes,
      this->Steps.Number * this->Plan.KeyframeInterval, static_cast<int>(this->Count()));
    statistics.TableBytes = this->Group.Segment.Bytes - statistics.PayloadBytes;
  }

  void KeepLastStep()
  {
    if (this->Last == nullptr)
    {
      return;
    }
    this->Last->Group = this->Steps.Number;
    for (std::size_t a = 0; a < this->Plan.Arrays.size(); ++a)
    {
      this->Last->Values.push_back(
        HashOf(this->Steps.Values.back()[a].Values, BytesOf(this->Plan, a)));
    }
    for (EncodedField& field : this->Fields)
    {
      this->Last->Fields.push_back(std::move(field.Last));
    }
  }

  const SeriesIndex& Plan;
  const EncodeOptions& Options;
  const GroupSteps& Steps;
  LastStep* Last;
  ThreadPool& Pool;
  const std::function<bool(double)>& Tell;
  StepBeforeGroup Before;
  SparePlanes OwnSpare;
  SparePlanes& Spare;
  std::size_t Components = 0; ///< of all arrays
  std::vector<EncodedField> Fields;
  EncodedGroup Group;
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
  SegmentFolder& folder, const GroupSteps& steps, LastStep* last, ThreadPool& pool,
  const std::function<bool(double)>& tell)
{
  return GroupEncoding(plan, options, steps, last, pool, tell).Run(folder);
}

} // namespace banyan
