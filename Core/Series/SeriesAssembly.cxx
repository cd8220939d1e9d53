// SPDX-License-Identifier: BSD-3-Clause
#include "Series/SeriesAssembly.h"

#include "Base/Error.h"
#include "Series/AtomicFile.h"
#include "Series/IndexText.h"

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
  return files;
}

} // namespace banyan
