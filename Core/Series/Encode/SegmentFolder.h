// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_SegmentFolder_h
#define banyan_Series_Encode_SegmentFolder_h

#include "Base/Hash.h"
#include "Series/Points/PointsWriter.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace banyan
{

/// The folder `<series>.d` while a series is written. Segments are named by their content, so that
/// a new series never touches the segments of the one it is going to replace, the same data gives
/// the same files whoever encodes it, and what is equal is stored once, wherever it occurs.
///
/// Nothing is removed but what a save of this series wrote: each keeps a list of its files in the
/// folder, which goes at its end, so that those of one that was killed are known.
class SegmentFolder
{
public:
  /// Makes the folder where it is not there yet. Throws Error.
  explicit SegmentFolder(const std::string& seriesPath);
  ~SegmentFolder();
  SegmentFolder(const SegmentFolder&) = delete;
  SegmentFolder& operator=(const SegmentFolder&) = delete;

  const std::string& Path() const { return this->FolderPath; }

  /// A name of this run alone, for a segment that is being written.
  std::string TemporaryNameOf(int segment) const;

  /// Name of a segment whose content has this hash. Remembers it as this run's, unless a file of
  /// the name (hence of the content) is there already.
  std::string FinalNameOf(const Hash128& content);
  /// The same for the file of a mesh.
  std::string FinalNameOfMesh(const Hash128& content);
  /// Where a file of points goes, and how it is called. The folder must outlive it.
  PointsPlace PlaceOfPoints();

  /// Whether this object made the folder: of several processes that write one series together, only
  /// the first one does, unless they see different disks.
  bool MadeHere() const { return this->Made; }

  /// Removes the segments of this run but those named, and the folder if this run made it and it is
  /// empty.
  void RemoveOwn(const std::vector<std::string>& names = {}) noexcept;

  /// Removes segments of the series that was replaced. Nothing where the folder is a link to that
  /// of another series.
  /// @param old files that its index named
  /// @param names of those that stay
  void RemoveReplaced(
    const std::vector<std::string>& old, const std::vector<std::string>& names) noexcept;

  /// Removes what saves that were killed have left in a folder, but files that an index names. To
  /// be called when no save is under way.
  /// @param named none: it is not known which ones, and only unfinished files are removed
  static void RemoveLeftovers(
    const std::string& folder, const std::optional<std::vector<std::string>>& named) noexcept;

private:
  std::string NameOf(const Hash128& content, const std::string& suffix);
  std::string ListPath() const;

  std::string FolderPath;
  pid_t Process;
  std::string Run;
  std::vector<std::string> Own;
  bool Made = false;
};

} // namespace banyan

#endif
