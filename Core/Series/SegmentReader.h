#ifndef banyan_Series_SegmentReader_h
#define banyan_Series_SegmentReader_h

#include "Series/NodeTable.h"

#include <mutex>
#include <string>

namespace banyan
{

/// One mapped segment file. Every access is checked against the index that names it; may be used
/// from any thread.
///
/// @par Limits: a file that another program cuts short while it is mapped kills the process, as
/// with any memory-mapped file.
class SegmentReader
{
public:
  /// Maps the file. Throws Error when it is missing or has another size than `index` says.
  /// @param tables number of node tables per step
  SegmentReader(const std::string& folder, const SegmentIndex& index, std::uint32_t tablesPerStep);
  ~SegmentReader();
  SegmentReader(const SegmentReader&) = delete;
  SegmentReader& operator=(const SegmentReader&) = delete;

  const std::string& Path() const { return this->FilePath; }

  /// Entry of a table of the segment, checked.
  segment::TableEntry Entry(std::uint32_t table) const;

  /// Reads and checks a table.
  NodeTable Table(
    const segment::TableEntry& entry, const BrickLayout& layout, ScalarType type) const;

  /// First byte of a payload of a table that `Table` returned.
  const std::uint8_t* Payload(const PayloadReference& payload) const
  {
    return this->Data + payload.Offset;
  }

  /// Takes the pages that were read out of this process's memory (the kernel keeps them as it sees
  /// fit); reading on brings them back. Safe while other threads read.
  void LetGo() const;

private:
  void Map();
  void CheckHeader() const;

  std::string FilePath;
  SegmentIndex Index;
  std::uint32_t TableCount;
  const std::uint8_t* Data = nullptr;
  mutable std::mutex Mutex;
  mutable bool Checked = false;
  mutable segment::Header Head;
};

} // namespace banyan

#endif
