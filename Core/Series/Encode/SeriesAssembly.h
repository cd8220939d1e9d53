// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_SeriesAssembly_h
#define banyan_Series_Encode_SeriesAssembly_h

#include "Series/Encode/GroupEncoder.h"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace banyan
{

/// The index file of a series that is being written: takes its groups in any order, as they are
/// encoded, and puts them into the index in theirs.
///
/// Where no series of that name existed, the index file appears with the first group and is
/// replaced (in one rename) with each group that is complete in order, so that the series opens
/// with those at any time. Where one existed, it stays untouched until Finish().
class SeriesAssembly
{
public:
  /// @param path of the index file
  /// @param plan the index before the first group (see PlanSeries). Throws Error when it could not
  /// be written later.
  SeriesAssembly(const std::string& path, SeriesIndex plan);

  /// The groups so far that are complete in order.
  const SeriesIndex& Index() const { return this->Current; }

  /// Default is the first array. Throws Error when there is none of that name.
  void SetActiveScalars(const std::string& name);

  /// Says where the points of a step are: of a series whose grid has some, before the group of the
  /// step is added; in the order of steps, and only of those whose points are new.
  void AddPoints(PointsFile file);

  /// @param number of the group in the series, each once
  /// Throws Error when the index file cannot be written.
  void Add(int number, EncodedGroup group);

  /// Writes the index of the whole series. Throws Error when it has no step, when a group is
  /// missing, or when the file cannot be written.
  const SeriesIndex& Finish();

  /// Removes the index file if it was written here and is not finished.
  void Withdraw() noexcept;

  /// The segments that the index file names now, none when it is not of this series.
  std::vector<std::string> SegmentsInFile() const;
  /// The same, and the files of mesh and points.
  std::vector<std::string> FilesInFile() const;
  /// The files that the index named which was there before; none where it could not be read.
  const std::vector<std::string>& FilesBefore() const { return this->Before; }

private:
  void NamePoints();

  std::string Path;
  SeriesIndex Current;
  std::map<int, EncodedGroup> Waiting; ///< for those before them
  std::vector<PointsFile> Points;      ///< of all steps so far
  std::set<std::string> Files;         ///< that the groups in order have
  std::vector<std::string> Before;
  bool KeepOld;   ///< a file of that name was there: it stays until Finish
  int InFile = 0; ///< groups that the index file names
};

/// The files in its folder that an index file names, those of mesh and points included: none when
/// there is no such file, and nothing when it cannot be read.
std::optional<std::vector<std::string>> FilesOfIndex(const std::string& path);

} // namespace banyan

#endif
