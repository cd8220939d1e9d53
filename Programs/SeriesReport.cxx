// SPDX-License-Identifier: BSD-3-Clause
#include "SeriesReport.h"

#include "Agreement.h"
#include "Base/Error.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>
#include <unordered_set>

namespace banyan
{
namespace
{

struct IdentityHash
{
  std::size_t operator()(const PayloadIdentity& identity) const
  {
    return static_cast<std::size_t>(identity.Low ^ identity.High);
  }
};

using Identities = std::unordered_set<PayloadIdentity, IdentityHash>;
using Nodes = std::shared_ptr<const std::vector<BrickNode>>;

BrickCounts CountBricks(const std::vector<BrickNode>& nodes, const std::vector<BrickNode>* previous)
{
  BrickCounts counts;
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    const BrickNode& node = nodes[i];
    ++counts.Bricks;
    counts.MacroVoxels += node.Uniform ? 1 : 0;
    counts.NonFinite += node.HasNonFinite ? 1 : 0;
    counts.Unchanged += previous && (*previous)[i].Identity == node.Identity ? 1 : 0;
  }
  return counts;
}

/// @param seen payloads that the segment has so far
void CountPayloads(const std::vector<BrickNode>& nodes, Identities& seen, BrickCounts& counts)
{
  for (const BrickNode& node : nodes)
  {
    if (!node.Uniform)
    {
      const bool stored = node.PayloadBytes > 0 && seen.insert(node.Identity).second;
      counts.Stored += stored ? 1 : 0;
      counts.Shared += stored ? 0 : 1;
      counts.StoredBytes += stored ? node.PayloadBytes : 0;
    }
  }
}

void AddTo(CountsBySize& sum, const CountsBySize& counts)
{
  sum.resize(std::max(sum.size(), counts.size()), 0);
  for (std::size_t i = 0; i < counts.size(); ++i)
  {
    sum[i] += counts[i];
  }
}

/// All components of the arrays that were asked for, without steps.
std::vector<ComponentReport> ChosenComponents(const SeriesIndex& index, const std::string& array)
{
  std::vector<ComponentReport> components;
  for (const int a : ChosenArrays(
         index, array.empty() ? std::vector<std::string>{} : std::vector<std::string>{ array }))
  {
    const ArrayIndex& found = index.Arrays[static_cast<std::size_t>(a)];
    for (std::size_t c = 0; c < found.Components.size(); ++c)
    {
      ComponentReport component;
      component.Array = a;
      component.Component = static_cast<int>(c);
      component.Name = NameOfComponent(found, c);
      component.Index = found.Components[c];
      component.Type = found.Type;
      components.push_back(std::move(component));
    }
  }
  return components;
}

/// One component's part of a step. `Stored` and the like are left to CountPayloads.
StepReport ReportStep(const SeriesFile& file, const ComponentReport& component, int step)
{
  StepReport report;
  report.Step = step;
  report.Time = file.Index().Times[static_cast<std::size_t>(step)];
  for (int level = 0; level < file.Index().Levels; ++level)
  {
    const Nodes nodes = file.Nodes({ step, component.Array, component.Component, level });
    const Nodes previous =
      step > 0 ? file.Nodes({ step - 1, component.Array, component.Component, level }) : nullptr;
    report.Levels.push_back(CountBricks(*nodes, previous.get()));
    if (level > 0)
    {
      continue;
    }
    const BrickTree tree = FuseMacroVoxels(*nodes, file.Layout(0));
    report.Range = tree.Levels.back().Nodes[0].Range;
    report.MacroVoxels = CountMacroVoxels(tree);
    report.Unchanged =
      previous ? MergeWithPrevious(tree, FuseMacroVoxels(*previous, file.Layout(0))).Subtrees
               : CountsBySize(tree.Levels.size(), 0);
  }
  return report;
}

/// Calls body(field) for all fields of a step in the order of the tables.
template <class Body>
void ForFields(const SeriesIndex& index, int step, Body&& body)
{
  for (std::size_t a = 0; a < index.Arrays.size(); ++a)
  {
    for (std::size_t c = 0; c < index.Arrays[a].Components.size(); ++c)
    {
      for (int level = 0; level < index.Levels; ++level)
      {
        body(FieldKey{ step, static_cast<int>(a), static_cast<int>(c), level });
      }
    }
  }
}

/// The counts of a field in a report, or nullptr when it was not asked for.
BrickCounts* CountsOf(SeriesReport& report, const FieldKey& field)
{
  for (ComponentReport& component : report.Components)
  {
    const bool fits = component.Array == field.Array && component.Component == field.Component;
    const std::size_t first =
      fits && !component.Steps.empty() ? static_cast<std::size_t>(component.Steps[0].Step) : 0;
    const std::size_t number = static_cast<std::size_t>(field.Step) - first;
    if (fits && number < component.Steps.size())
    {
      return &component.Steps[number].Levels[static_cast<std::size_t>(field.Level)];
    }
  }
  return nullptr;
}

/// Fills in which payloads are stored where. A segment is counted as a whole, because what its
/// first fields store the others share.
/// @param again its file is that of an earlier one, which stores all of it
void CountSegment(
  const SeriesFile& file, const SegmentIndex& segment, bool again, SeriesReport& report)
{
  Identities seen;
  for (int step = segment.FirstStep; step < segment.FirstStep + segment.Steps; ++step)
  {
    ForFields(file.Index(), step,
      [&](const FieldKey& field)
      {
        BrickCounts counts;
        CountPayloads(*file.Nodes(field), seen, counts);
        if (again)
        {
          counts.Shared += counts.Stored;
          counts.Stored = 0;
          counts.StoredBytes = 0;
        }
        if (BrickCounts* sum = CountsOf(report, field))
        {
          sum->Add(counts);
        }
      });
  }
}

} // namespace

void BrickCounts::Add(const BrickCounts& other)
{
  this->Bricks += other.Bricks;
  this->MacroVoxels += other.MacroVoxels;
  this->NonFinite += other.NonFinite;
  this->Unchanged += other.Unchanged;
  this->Stored += other.Stored;
  this->Shared += other.Shared;
  this->StoredBytes += other.StoredBytes;
}

double ComponentReport::Rmse() const
{
  const double count = static_cast<double>(this->Index.FiniteCount);
  return count > 0 ? std::sqrt(this->Index.SumSquaredError / count) : 0.0;
}

std::optional<double> ComponentReport::RmseOf(const StepReport& step) const
{
  const std::size_t number = static_cast<std::size_t>(step.Step);
  return number < this->Index.StepRmse.size() ? std::optional<double>(this->Index.StepRmse[number])
                                              : std::nullopt;
}

const StepReport* ComponentReport::NarrowestStep() const
{
  const StepReport* narrowest = nullptr;
  for (const StepReport& step : this->Steps)
  {
    const double width = step.Range.Width();
    if (width > 0 && (!narrowest || width < narrowest->Range.Width()))
    {
      narrowest = &step;
    }
  }
  return narrowest;
}

BrickCounts ComponentReport::Sum(int level) const
{
  BrickCounts sum;
  for (const StepReport& step : this->Steps)
  {
    sum.Add(step.Levels[static_cast<std::size_t>(level)]);
  }
  return sum;
}

CountsBySize ComponentReport::MacroVoxels() const
{
  CountsBySize sum;
  for (const StepReport& step : this->Steps)
  {
    AddTo(sum, step.MacroVoxels);
  }
  return sum;
}

CountsBySize ComponentReport::Unchanged() const
{
  CountsBySize sum;
  for (const StepReport& step : this->Steps)
  {
    AddTo(sum, step.Unchanged);
  }
  return sum;
}

std::int64_t SeriesReport::Values() const
{
  std::int64_t values = 0;
  for (const ArrayIndex& array : this->Index.Arrays)
  {
    const std::int64_t tuples = !this->Index.Mesh         ? this->Index.Domain.Extent.Count()
                                : array.CellArray.empty() ? this->Index.Mesh->Points
                                                          : this->Index.Mesh->Cells;
    values += tuples * static_cast<std::int64_t>(array.Components.size());
  }
  return values * this->Index.Steps();
}

double SeriesReport::BitsPerValue() const
{
  return 8.0 * static_cast<double>(this->EncodedBytes()) / static_cast<double>(this->Values());
}

std::int64_t SeriesReport::VoxelsOf(std::int64_t edge) const
{
  std::int64_t voxels = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    voxels *= this->Index.Domain.Samples()[axis] == 1 ? 1 : edge;
  }
  return voxels;
}

std::int64_t SeriesReport::VoxelsBelow(std::size_t level) const
{
  return this->VoxelsOf(std::int64_t{ this->Index.BrickCells } << level);
}

SeriesReport ReportSeries(const SeriesFile& file, const ReportChoice& choice)
{
  SeriesReport report;
  report.File = file.Path();
  report.Index = file.Index();
  if (choice.Step >= 0)
  {
    (void)report.Index.SegmentOf(choice.Step); // throws when there is no such step
  }
  report.IndexBytes = std::filesystem::file_size(file.Path());
  std::set<std::string> files;
  std::vector<bool> again;
  for (const SegmentIndex& segment : report.Index.Segments)
  {
    again.push_back(!files.insert(segment.File).second);
    report.SegmentBytes += again.back() ? 0 : segment.Bytes;
  }
  report.Components = ChosenComponents(report.Index, choice.Array);
  if (report.Components.empty() || report.Index.Steps() == 0)
  {
    throw Error("The series holds no values", { file.Path() });
  }
  const int first = std::max(choice.Step, 0);
  const int end = choice.Step < 0 ? report.Index.Steps() : choice.Step + 1;
  for (ComponentReport& component : report.Components)
  {
    for (int step = first; step < end; ++step)
    {
      component.Steps.push_back(ReportStep(file, component, step));
    }
  }
  for (std::size_t i = 0; i < again.size(); ++i)
  {
    const SegmentIndex& segment = report.Index.Segments[i];
    if (segment.FirstStep < end && segment.FirstStep + segment.Steps > first)
    {
      CountSegment(file, segment, again[i], report);
    }
  }
  return report;
}

std::optional<double> Decibels(double width, double rmse)
{
  if (!(width > 0.0) || !(rmse > 0.0))
  {
    return std::nullopt;
  }
  return 20.0 * std::log10(width / rmse);
}

} // namespace banyan
