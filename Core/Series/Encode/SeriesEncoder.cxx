// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/SeriesEncoder.h"

#include "Base/Error.h"
#include "Base/LargePages.h"
#include "Base/ThreadPool.h"
#include "Series/Encode/EncodePlan.h"
#include "Series/Encode/GroupEncoder.h"
#include "Series/Encode/SegmentFolder.h"
#include "Series/Encode/SeriesAssembly.h"
#include "Series/Encode/SeriesLock.h"
#include "Series/Format/SeriesPath.h"
#include "Series/Points/PointsWriter.h"

#include <cmath>

#include <unistd.h>

namespace banyan
{

struct SeriesEncoder::Internals
{
  Internals(const std::string& path, const Grid& grid, const std::vector<ArrayDescription>& arrays,
    const EncodeOptions& options, ThreadPool& pool);
  ~Internals();

  void CheckStep(double time, const std::vector<ArrayValues>& arrays) const;
  void Keep(const std::vector<ArrayValues>& arrays);
  /// @param last values of the last step, where they were not kept
  void EncodeKept(const std::vector<ArrayValues>& last = {});

  std::string Path;
  EncodeOptions Options;
  ThreadPool& Pool;
  std::unique_ptr<SeriesLock> Lock; ///< until the series is finished or given up
  SeriesAssembly Assembly;
  const pid_t Process = getpid();
  bool Failed = false;
  bool Finished = false;
  std::unique_ptr<SegmentFolder> Folder;
  std::string PointsOfStep;  ///< the file of points that the last step has
  std::vector<double> Times; ///< of the group under way
  using KeptArray = std::vector<std::uint8_t, InLargePages<std::uint8_t>>;
  std::vector<std::vector<KeptArray>> Values; ///< its steps and arrays
  std::vector<std::vector<KeptArray>> Spare;  ///< memory for them
  LastStep Last;                              ///< of the group before
  std::function<bool(double)> Progress;
};

SeriesEncoder::Internals::Internals(const std::string& path, const Grid& grid,
  const std::vector<ArrayDescription>& arrays, const EncodeOptions& options, ThreadPool& pool)
  : Path(FollowLinks(path))
  , Options(options)
  , Pool(pool)
  , Lock(std::make_unique<SeriesLock>(this->Path))
  , Assembly(this->Path, PlanSeries(grid, arrays, options))
{
  this->Folder = std::make_unique<SegmentFolder>(this->Path);
}

SeriesEncoder::Internals::~Internals()
{
  if (!this->Finished && this->Folder && this->Process == getpid())
  {
    this->Assembly.Withdraw();
    this->Folder->RemoveOwn();
  }
}

void SeriesEncoder::Internals::CheckStep(double time, const std::vector<ArrayValues>& arrays) const
{
  const SeriesIndex& index = this->Assembly.Index();
  const std::vector<double>& times = this->Times.empty() ? index.Times : this->Times;
  if (!std::isfinite(time) || (!times.empty() && !(time > times.back())))
  {
    throw Error("Time values must be finite and increase from step to step", { this->Path });
  }
  if (index.Points && this->PointsOfStep.empty())
  {
    throw Error("A step of a grid with points of its own needs them first", { this->Path });
  }
  if (arrays.size() != index.Arrays.size())
  {
    throw Error("A step must hold as many arrays as were described",
      { this->Path, {}, arrays.size(), index.Arrays.size() });
  }
  for (const ArrayValues& array : arrays)
  {
    if (array.Values == nullptr)
    {
      throw Error("An array of a step has no values", { this->Path });
    }
  }
}

void SeriesEncoder::Internals::Keep(const std::vector<ArrayValues>& arrays)
{
  const SeriesIndex& index = this->Assembly.Index();
  this->Values.emplace_back();
  if (!this->Spare.empty())
  {
    this->Values.back() = std::move(this->Spare.back());
    this->Spare.pop_back();
  }
  this->Values.back().resize(arrays.size());
  for (std::size_t a = 0; a < arrays.size(); ++a)
  {
    const ArrayIndex& array = index.Arrays[a];
    const std::size_t bytes = static_cast<std::size_t>(index.Domain.Extent.Count()) *
                              array.Components.size() * SizeOf(array.Type);
    const std::uint8_t* values = static_cast<const std::uint8_t*>(arrays[a].Values);
    this->Values.back()[a].assign(values, values + bytes);
  }
}

void SeriesEncoder::Internals::EncodeKept(const std::vector<ArrayValues>& last)
{
  std::vector<std::vector<ArrayValues>> steps;
  for (const auto& step : this->Values)
  {
    steps.emplace_back();
    for (const auto& values : step)
    {
      steps.back().push_back({ values.data() });
    }
  }
  if (!last.empty())
  {
    steps.push_back(last);
  }
  const int number = static_cast<int>(this->Assembly.Index().Segments.size());
  this->Assembly.Add(
    number, EncodeGroup(this->Assembly.Index(), this->Options, *this->Folder,
              { number, this->Times, steps, {} }, &this->Last, this->Pool, this->Progress));
  this->Times.clear();
  this->Spare = std::move(this->Values); // new memory takes longer than to copy
  this->Values.clear();
}

SeriesEncoder::SeriesEncoder(const std::string& path, const Grid& grid,
  const std::vector<ArrayDescription>& arrays, const EncodeOptions& options, ThreadPool& pool)
  : Self(std::make_unique<Internals>(path, grid, arrays, options, pool))
{
}

SeriesEncoder::~SeriesEncoder() = default;

void SeriesEncoder::SetActiveScalars(const std::string& name)
{
  this->Self->Assembly.SetActiveScalars(name);
}

void SeriesEncoder::SetPoints(const PointsView& points)
{
  Internals& self = *this->Self;
  if (self.Failed || self.Finished)
  {
    throw Error("The series takes no more points: it is finished or was given up after an error",
      { self.Path });
  }
  self.Failed = true;
  const SeriesIndex& index = self.Assembly.Index();
  CheckPoints(points, index);
  const int step = index.Steps() + static_cast<int>(self.Times.size());
  const PointsFile file = WritePoints(points, step, self.Folder->PlaceOfPoints(), self.Pool);
  if (self.PointsOfStep.empty() || self.PointsOfStep != file.File)
  {
    self.PointsOfStep = file.File;
    self.Assembly.AddPoints(file);
  }
  self.Failed = false;
}

void SeriesEncoder::SetMovedPoints(PointsFile points)
{
  Internals& self = *this->Self;
  const SeriesIndex& index = self.Assembly.Index();
  if (!index.Mesh || !index.Mesh->OfCells ||
      points.FirstStep != index.Steps() + static_cast<int>(self.Times.size()))
  {
    throw Error(
      "Points that have moved are those of a mesh of cells, and of its next step", { self.Path });
  }
  self.Assembly.AddPoints(std::move(points));
}

void SeriesEncoder::AddStep(double time, const std::vector<ArrayValues>& arrays)
{
  Internals& self = *this->Self;
  if (self.Failed || self.Finished)
  {
    throw Error("The series takes no more steps: it is finished or was given up after an error",
      { self.Path });
  }
  // A bad call does not spoil what was encoded, but the contract says that nothing can follow it.
  self.Failed = true;
  self.CheckStep(time, arrays);
  self.Times.push_back(time);
  if (static_cast<int>(self.Times.size()) == self.Options.KeyframeInterval)
  {
    self.EncodeKept(arrays); // these values are at hand until all is encoded
  }
  else
  {
    self.Keep(arrays);
  }
  self.Failed = false;
}

SeriesIndex SeriesEncoder::Finish()
{
  Internals& self = *this->Self;
  if (self.Failed || self.Finished)
  {
    throw Error("The series cannot be finished: it is finished already, or was given up after "
                "an error",
      { self.Path });
  }
  self.Failed = true;
  if (!self.Times.empty())
  {
    self.EncodeKept();
  }
  const SeriesIndex& index = self.Assembly.Finish();
  self.Finished = true;
  self.Folder->RemoveReplaced(self.Assembly.FilesBefore(), self.Assembly.FilesInFile());
  self.Folder.reset();
  self.Lock.reset();
  return index;
}

void SeriesEncoder::SetProgress(std::function<bool(double)> progress)
{
  this->Self->Progress = std::move(progress);
}

} // namespace banyan
