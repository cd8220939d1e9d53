#ifndef banyan_Series_SegmentFolder_h
#define banyan_Series_SegmentFolder_h

#include <string>
#include <vector>

namespace banyan
{

/// The folder `<series>.d` while a series is written. File names are unique per run, so that a new
/// series never touches the segments of the one it is going to replace.
class SegmentFolder
{
public:
  /// Makes the folder where it is not there yet. Throws Error.
  explicit SegmentFolder(const std::string& seriesPath);

  const std::string& Path() const { return this->FolderPath; }

  /// File name of a segment of this run.
  std::string NameOf(int segment) const;

  /// Removes the segments of this run, and the folder if this run made it and it is empty.
  void RemoveOwn() noexcept;

  /// Removes segments (whole or unfinished) of any run but those named. Other files stay.
  void RemoveAllBut(const std::vector<std::string>& names) noexcept;

private:
  std::string FolderPath;
  std::string Run;
  bool Made = false;
};

} // namespace banyan

#endif
