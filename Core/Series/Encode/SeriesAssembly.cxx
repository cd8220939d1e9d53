// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/SeriesAssembly.h"

#include "Base/Error.h"
#include "Series/Format/AtomicFile.h"
#include "Series/Format/IndexText.h"

#include <algorithm>

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

/// Adds a group to the index; groups in order.
void AddGroup(const EncodedGroup& group, SeriesIndex& index)
{
  index.Segments.push_back(group.Segment);
  index.Times.insert(index.Times.end(), group.Times.begin(), group.Times.end());
  for (std::size_t a = 0; a < index.Arrays.size(); ++a)
  {
    ArrayIndex& array = index.Arrays[a];
    array.Magnitudes.insert(
      array.Magnitudes.end(), group.Magnitudes[a].begin(), group.Magnitudes[a].end());
    for (std::size_t c = 0; c < array.Components.size(); ++c)
    {
      ComponentIndex& to = array.Components[c];
      const ComponentIndex& from = group.Measured[a][c];
      to.Range.Include(from.Range);
      to.MeasuredMaxError = std::max(to.MeasuredMaxError, from.MeasuredMaxError);
      to.MeasuredMaxErrorTransformed =
        std::max(to.MeasuredMaxErrorTransformed, from.MeasuredMaxErrorTransformed);
      to.SumSquaredError += from.SumSquaredError;
      to.StepRmse.insert(to.StepRmse.end(), from.StepRmse.begin(), from.StepRmse.end());
      to.FiniteCount += from.FiniteCount;
      to.NonFiniteCount += from.NonFiniteCount;
      to.ClampedCount += from.ClampedCount;
      to.FillCount += from.FillCount;
      to.InvisibleCount += from.InvisibleCount;
      to.SumWeightedError += from.SumWeightedError;
    }
  }
  EncodeStatistics& to = index.Statistics;
  const EncodeStatistics& from = group.Statistics;
  to.Bricks += from.Bricks;
  to.MacroVoxelBricks += from.MacroVoxelBricks;
  to.UnchangedBricks += from.UnchangedBricks;
  to.MergedBricks += from.MergedBricks;
  to.RawBricks += from.RawBricks;
  to.PayloadBytes += from.PayloadBytes;
  to.TableBytes += from.TableBytes;
  to.Blocks += from.Blocks;
  to.EmptyBlocks += from.EmptyBlocks;
  to.ExceptionVoxels += from.ExceptionVoxels;
  to.ChainSum += from.ChainSum;
  to.ChainBricks += from.ChainBricks;
  to.ChainMost = std::max(to.ChainMost, from.ChainMost);
  to.RepeatedSegments += from.RepeatedSegments;
  to.RepeatedBytes += from.RepeatedBytes;
  index.PayloadBytesIn += group.BytesIn;
}

} // namespace

SeriesAssembly::SeriesAssembly(const std::string& path, SeriesIndex plan)
  : Path(path)
  , Current(std::move(plan))
  , Before(FilesOfIndex(path).value_or(std::vector<std::string>{}))
  , KeepOld(Exists(path))
{
  (void)IndexToText(this->Current); // says now what could not be written later
}

std::optional<std::vector<std::string>> FilesOfIndex(const std::string& path)
{
  std::vector<std::string> files;
  if (!Exists(path))
  {
    return files;
  }
  try
  {
    const SeriesIndex index = IndexFromText(ReadWholeFile(path, GreatestIndexBytes), path);
    for (const SegmentIndex& segment : index.Segments)
    {
      files.push_back(segment.File);
    }
    if (index.Mesh)
    {
      files.push_back(index.Mesh->File);
    }
    for (const PointsFile& points : index.FilesOfPoints())
    {
      files.push_back(points.File);
    }
  }
  catch (const Error&)
  {
    return std::nullopt;
  }
  return files;
}

void SeriesAssembly::SetActiveScalars(const std::string& name)
{
  if (this->Current.FindArray(name) < 0)
  {
    throw Error("The active array '" + name + "' is not among the arrays");
  }
  this->Current.ActiveScalars = name;
}

void SeriesAssembly::AddPoints(PointsFile file)
{
  this->Points.push_back(std::move(file));
}

/// The points of the steps that the index has, and no others.
void SeriesAssembly::NamePoints()
{
  if (this->Current.Points || this->Current.Mesh)
  {
    std::vector<PointsFile>& named =
      this->Current.Points ? this->Current.Points->Files : this->Current.Mesh->Moved;
    while (named.size() < this->Points.size() &&
           this->Points[named.size()].FirstStep < this->Current.Steps())
    {
      named.push_back(this->Points[named.size()]);
    }
  }
}

void SeriesAssembly::Add(int number, EncodedGroup group)
{
  this->Waiting.emplace(number, std::move(group));
  const std::size_t before = this->Current.Segments.size();
  for (auto next = this->Waiting.begin();
       next != this->Waiting.end() &&
       next->first == static_cast<int>(this->Current.Segments.size());
       next = this->Waiting.erase(next))
  {
    EncodedGroup& added = next->second;
    if (!this->Files.insert(added.Segment.File).second)
    {
      added.Statistics.RepeatedSegments = 1;
      added.Statistics.RepeatedBytes = added.Segment.Bytes;
      added.Statistics.PayloadBytes = 0;
      added.Statistics.TableBytes = 0;
    }
    AddGroup(added, this->Current);
  }
  this->NamePoints();
  if (!this->KeepOld && this->Current.Segments.size() > before)
  {
    WriteFileAtomically(this->Path, IndexToText(this->Current));
    this->InFile = static_cast<int>(this->Current.Segments.size());
  }
}

const SeriesIndex& SeriesAssembly::Finish()
{
  if (!this->Waiting.empty())
  {
    throw Error("A group of steps of the series is missing",
      { this->Path, {}, this->Current.Segments.size(), this->Waiting.rbegin()->first + 1 });
  }
  if (this->Current.Steps() == 0)
  {
    throw Error("A series needs at least one step", { this->Path });
  }
  WriteFileAtomically(this->Path, IndexToText(this->Current));
  this->KeepOld = true;
  this->InFile = static_cast<int>(this->Current.Segments.size());
  return this->Current;
}

void SeriesAssembly::Withdraw() noexcept
{
  if (!this->KeepOld && this->InFile > 0)
  {
    (void)unlink(this->Path.c_str());
    this->InFile = 0;
  }
}

std::vector<std::string> SeriesAssembly::SegmentsInFile() const
{
  std::vector<std::string> files;
  for (int i = 0; i < this->InFile; ++i)
  {
    files.push_back(this->Current.Segments[static_cast<std::size_t>(i)].File);
  }
  return files;
}

std::vector<std::string> SeriesAssembly::FilesInFile() const
{
  std::vector<std::string> files = this->SegmentsInFile();
  if (this->InFile > 0 && this->Current.Mesh)
  {
    files.push_back(this->Current.Mesh->File);
  }
  if (this->InFile > 0)
  {
    const SegmentIndex& last = this->Current.Segments[static_cast<std::size_t>(this->InFile) - 1];
    for (const PointsFile& points : this->Current.FilesOfPoints())
    {
      if (points.FirstStep < last.FirstStep + last.Steps)
      {
        files.push_back(points.File);
      }
    }
  }
  return files;
}

} // namespace banyan
