// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Format_SegmentFile_h
#define banyan_Series_Format_SegmentFile_h

#include "Base/Bytes.h"
#include "Series/Format/SeriesIndex.h"

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

namespace banyan
{

/// A segment file of the size that the index says. It is read, never mapped: whatever becomes of
/// the file while it is open, reading gives bytes or throws. May be used from any thread.
///
/// A file that is open here is read on when it is deleted or replaced. A process has so many of
/// them open at once (MostOpen()); others are opened anew when they are read.
class SegmentFile
{
public:
  /// Opens the file. Throws Error when it is missing or has another size than `index` says.
  SegmentFile(const std::string& folder, const SegmentIndex& index);
  ~SegmentFile();
  SegmentFile(const SegmentFile&) = delete;
  SegmentFile& operator=(const SegmentFile&) = delete;

  const std::string& Path() const { return this->FilePath; }
  std::uint64_t Bytes() const { return this->Size; }

  /// Reads bytes that lie inside the size that the index says. Throws Error when the file does not
  /// give them any more.
  void Read(std::uint64_t offset, void* to, std::size_t bytes) const;
  banyan::Bytes Read(std::uint64_t offset, std::size_t bytes) const;

  /// Tells the system that these bytes will be read soon.
  void Expect(std::uint64_t offset, std::uint64_t bytes) const;

  /// A quarter of the files that the process may open, at most 256: others need theirs, too.
  static std::size_t MostOpen();

private:
  struct Descriptor;
  struct Pool;
  static Pool& Open();
  std::shared_ptr<const Descriptor> OpenNow() const;
  std::shared_ptr<const Descriptor> Opened() const;

  std::string FilePath;
  std::uint64_t Size;
  mutable std::shared_ptr<const Descriptor> Kept; ///< these two under the lock of the pool
  mutable std::uint64_t Used = 0;
};

} // namespace banyan

#endif
