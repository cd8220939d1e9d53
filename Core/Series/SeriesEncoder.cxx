#include "Series/SeriesEncoder.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Series/EncodePlan.h"
#include "Series/GroupEncoder.h"
#include "Series/IndexText.h"
#include "Series/SegmentFolder.h"
#include "Series/AtomicFile.h"

#include <algorithm>
#include <cmath>

#include <sys/stat.h>
#include <unistd.h>

namespace banyan
{
namespace
{

bool Exists(const std::string& path)
{
  struct stat status = {};
  return lstat(path.c_str(), &status) == 0;
}

} // namespace

struct SeriesEncoder::Internals
{
  Internals(const std::string& path, const Grid& grid, const std::vector<ArrayDescription>& arrays,
    const EncodeOptions& options, ThreadPool& pool);
  ~Internals();

  void CheckStep(double time, const std::vector<ArrayValues>& arrays) const;
  void Keep(double time, const std::vector<ArrayValues>& arrays);
  void EncodeKept();

  std::string Path;
  EncodeOptions Options;
  ThreadPool& Pool;
  SeriesIndex Index;
  bool KeepOld; ///< a file of that name was there: it stays until Finish
  bool IndexWritten = false;
  bool Failed = false;
  bool Finished = false;
  std::unique_ptr<SegmentFolder> Folder;
  std::vector<double> Times;                                  ///< of the group under way
  std::vector<std::vector<std::vector<std::uint8_t>>> Values; ///< its steps and arrays
  std::function<bool(double)> Progress;
};

SeriesEncoder::Internals::Internals(const std::string& path, const Grid& grid,
  const std::vector<ArrayDescription>& arrays, const EncodeOptions& options, ThreadPool& pool)
  : Path(path)
  , Options(options)
  , Pool(pool)
  , Index(PlanSeries(grid, arrays, options))
  , KeepOld(Exists(path))
{
  (void)IndexToText(this->Index); // says now what could not be written later
  this->Folder = std::make_unique<SegmentFolder>(path);
}

SeriesEncoder::Internals::~Internals()
{
  if (!this->Finished && this->Folder)
  {
    if (this->IndexWritten)
    {
      (void)unlink(this->Path.c_str());
    }
    this->Folder->RemoveOwn();
  }
}

void SeriesEncoder::Internals::CheckStep(double time, const std::vector<ArrayValues>& arrays) const
{
  const std::vector<double>& times = this->Times.empty() ? this->Index.Times : this->Times;
  if (!std::isfinite(time) || (!times.empty() && !(time > times.back())))
  {
    throw Error("Time values must be finite and increase from step to step", { this->Path });
  }
  if (arrays.size() != this->Index.Arrays.size())
  {
    throw Error("A step must hold as many arrays as were described",
      { this->Path, {}, arrays.size(), this->Index.Arrays.size() });
  }
  for (const ArrayValues& array : arrays)
  {
    if (array.Values == nullptr)
    {
      throw Error("An array of a step has no values", { this->Path });
    }
  }
}

void SeriesEncoder::Internals::Keep(double time, const std::vector<ArrayValues>& arrays)
{
  this->Times.push_back(time);
  this->Values.emplace_back();
  for (std::size_t a = 0; a < arrays.size(); ++a)
  {
    const ArrayIndex& array = this->Index.Arrays[a];
    const std::size_t bytes = static_cast<std::size_t>(this->Index.Domain.Extent.Count()) *
                              array.Components.size() * SizeOf(array.Type);
    const std::uint8_t* values = static_cast<const std::uint8_t*>(arrays[a].Values);
    this->Values.back().emplace_back(values, values + bytes);
  }
}

void SeriesEncoder::Internals::EncodeKept()
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
  AddGroup(EncodeGroup(this->Index, this->Options, *this->Folder,
             static_cast<int>(this->Index.Segments.size()), this->Times, steps, this->Pool,
             this->Progress),
    this->Index);
  this->Times.clear();
  this->Values.clear();
  if (!this->KeepOld)
  {
    WriteFileAtomically(this->Path, IndexToText(this->Index));
    this->IndexWritten = true;
  }
}

SeriesEncoder::SeriesEncoder(const std::string& path, const Grid& grid,
  const std::vector<ArrayDescription>& arrays, const EncodeOptions& options, ThreadPool& pool)
  : Self(std::make_unique<Internals>(path, grid, arrays, options, pool))
{
}

SeriesEncoder::~SeriesEncoder() = default;

void SeriesEncoder::SetActiveScalars(const std::string& name)
{
  if (this->Self->Index.FindArray(name) < 0)
  {
    throw Error("The active array '" + name + "' is not among the arrays");
  }
  this->Self->Index.ActiveScalars = name;
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
  self.Keep(time, arrays);
  if (static_cast<int>(self.Times.size()) == self.Options.KeyframeInterval)
  {
    self.EncodeKept();
  }
  self.Failed = false;
}

SeriesIndex SeriesEncoder::Finish()
{
  Internals& self = *this->Self;
  if (self.Failed || self.Finished)
  {
    throw Error("The series cannot be finished (again): it was given up after an error or is "
                "finished already",
      { self.Path });
  }
  self.Failed = true;
  if (!self.Times.empty())
  {
    self.EncodeKept();
  }
  if (self.Index.Steps() == 0)
  {
    throw Error("A series needs at least one step", { self.Path });
  }
  WriteFileAtomically(self.Path, IndexToText(self.Index));
  self.Finished = true;
  std::vector<std::string> files;
  for (const SegmentIndex& segment : self.Index.Segments)
  {
    files.push_back(segment.File);
  }
  self.Folder->RemoveAllBut(files);
  return self.Index;
}

void SeriesEncoder::SetProgress(std::function<bool(double)> progress)
{
  this->Self->Progress = std::move(progress);
}

} // namespace banyan
