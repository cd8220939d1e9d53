#ifndef banyan_Series_MappedSegment_h
#define banyan_Series_MappedSegment_h

#include "Series/SeriesIndex.h"

#include <cstdint>
#include <string>

namespace banyan
{

/// A segment file in memory, of the size that the index says.
///
/// @par Limits: a file that another program cuts short while it is mapped kills the process, as
/// with any memory-mapped file.
class MappedSegment
{
public:
  /// Maps the file. Throws Error when it is missing or has another size than `index` says.
  MappedSegment(const std::string& folder, const SegmentIndex& index);
  ~MappedSegment();
  MappedSegment(const MappedSegment&) = delete;
  MappedSegment& operator=(const MappedSegment&) = delete;

  const std::string& Path() const { return this->FilePath; }
  const std::uint8_t* Data() const { return this->First; }
  std::uint64_t Bytes() const { return this->Size; }

  /// Takes the pages that were read out of this process's memory (the kernel keeps them as it sees
  /// fit); reading on brings them back. Safe while other threads read.
  void LetGo() const;

private:
  std::string FilePath;
  std::uint64_t Size;
  const std::uint8_t* First = nullptr;
};

} // namespace banyan

#endif
