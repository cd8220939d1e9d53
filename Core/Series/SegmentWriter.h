#ifndef banyan_Series_SegmentWriter_h
#define banyan_Series_SegmentWriter_h

#include "Series/AtomicFile.h"
#include "Series/SegmentFormat.h"
#include "Series/SeriesFile.h"

#include <string>
#include <unordered_map>
#include <vector>

namespace banyan
{

/// Writes one segment file: payloads as they come, then node tables and directory. Nothing is left
/// behind when it is destroyed before `Finish()`.
class SegmentWriter
{
public:
  /// @param folder of the series' segments
  /// @param file name of the segment in it
  SegmentWriter(const std::string& folder, const std::string& file, int firstStep);

  /// Stores a payload unless one of the same identity is already there.
  /// @param merged receives whether it was
  /// @return offset in the file
  std::uint64_t AddPayload(const Bytes& payload, const PayloadIdentity& identity, bool& merged);

  /// Adds the next table, in the order of the format. Offset and hash of the entry are set here.
  void AddTable(Bytes packed, segment::TableEntry entry);

  /// Writes what is left and gives the file its name.
  SegmentIndex Finish(int steps);

private:
  struct IdentityHash
  {
    std::size_t operator()(const PayloadIdentity& identity) const
    {
      return static_cast<std::size_t>(identity.Low);
    }
  };

  void PadTo(std::uint64_t alignment);

  std::string Name;
  AtomicFile Output;
  int FirstStep;
  std::unordered_map<PayloadIdentity, std::uint64_t, IdentityHash> Stored;
  std::vector<Bytes> Tables;
  std::vector<segment::TableEntry> Entries;
};

} // namespace banyan

#endif
