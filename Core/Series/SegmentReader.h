// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_SegmentReader_h
#define banyan_Series_SegmentReader_h

#include "Series/NodeTable.h"
#include "Series/SegmentFile.h"

#include <mutex>
#include <string>

namespace banyan
{

/// One segment file of version 1. Every access is checked against the index that names it;
/// may be used from any thread.
class SegmentReader
{
public:
  /// Opens the file. Throws Error when it is missing or has another size than `index` says.
  /// @param tables number of node tables per step
  SegmentReader(const std::string& folder, const SegmentIndex& index, std::uint32_t tablesPerStep);

  const std::string& Path() const { return this->File.Path(); }

  /// Entry of a table of the segment, checked.
  segment::TableEntry Entry(std::uint32_t table) const;

  /// Reads and checks a table.
  NodeTable Table(
    const segment::TableEntry& entry, const BrickLayout& layout, ScalarType type) const;

  /// A payload of a table that `Table` returned, not checked.
  Bytes Payload(const PayloadReference& payload, std::size_t bytes) const
  {
    return this->File.Read(payload.Offset, bytes);
  }

private:
  void CheckHeader() const;

  SegmentFile File;
  SegmentIndex Index;
  std::uint32_t TableCount;
  mutable std::mutex Mutex;
  mutable bool Checked = false;
  mutable segment::Header Head;
  mutable Bytes Directory;
};

} // namespace banyan

#endif
