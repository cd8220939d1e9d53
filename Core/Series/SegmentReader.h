#ifndef banyan_Series_SegmentReader_h
#define banyan_Series_SegmentReader_h

#include "Series/MappedSegment.h"
#include "Series/NodeTable.h"

#include <mutex>
#include <string>

namespace banyan
{

/// One mapped segment file of version 1. Every access is checked against the index that names it;
/// may be used from any thread.
class SegmentReader
{
public:
  /// Maps the file. Throws Error when it is missing or has another size than `index` says.
  /// @param tables number of node tables per step
  SegmentReader(const std::string& folder, const SegmentIndex& index, std::uint32_t tablesPerStep);

  const std::string& Path() const { return this->File.Path(); }

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

  /// See MappedSegment.
  void LetGo() const { this->File.LetGo(); }

private:
  void CheckHeader() const;

  MappedSegment File;
  SegmentIndex Index;
  std::uint32_t TableCount;
  const std::uint8_t* Data;
  mutable std::mutex Mutex;
  mutable bool Checked = false;
  mutable segment::Header Head;
};

} // namespace banyan

#endif
