// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Decode_PayloadPages_h
#define banyan_Series_Decode_PayloadPages_h

#include "Series/Format/SegmentFile.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace banyan
{

class PayloadPages;

/// The payloads of several segments, which together keep no more than a budget. Beyond, all pages
/// of the segment that was used least recently go, and are read and checked again. Thread-safe.
class PayloadMemory
{
public:
  explicit PayloadMemory(std::uint64_t budgetBytes)
    : Budget(budgetBytes)
  {
  }

  std::uint64_t BudgetBytes() const { return this->Budget; }
  /// Bytes of pages in memory.
  std::uint64_t Bytes() const { return this->Total; }
  /// Lets go of what was used least recently until so many bytes are left.
  void Shrink(std::uint64_t most);

private:
  friend class PayloadPages;

  const std::uint64_t Budget;
  std::atomic<std::uint64_t> Total{ 0 };
  std::atomic<std::uint64_t> Clock{ 0 };
  std::mutex Mutex;
  std::vector<PayloadPages*> All;
};

/// The payloads of a segment in memory of this process. Pages are read when they are
/// needed first, and their checksums are those of what was read: what happens to the file later
/// does not matter. May be used from any thread.
class PayloadPages
{
public:
  /// Keeps pages where they are.
  class Memory;
  using Hold = std::shared_ptr<Memory>;

  /// @param together lives longer
  /// @param file lives longer
  /// @param end of the payloads in the file
  /// @param hashes of the pages; as many as there are
  PayloadPages(PayloadMemory& together, const SegmentFile& file, std::uint64_t end,
    std::vector<std::uint32_t> hashes);
  ~PayloadPages();
  PayloadPages(const PayloadPages&) = delete;
  PayloadPages& operator=(const PayloadPages&) = delete;

  /// The memory of now.
  Hold InMemory();

  /// First of some bytes, valid as long as `hold`. Throws Error when they are damaged or cannot be
  /// read.
  /// @param offset and @param bytes lie between the header and the end of the payloads
  const std::uint8_t* At(const Hold& hold, std::uint64_t offset, std::uint64_t bytes);

private:
  friend class PayloadMemory;

  void ReadIn(Memory& memory, std::uint64_t page, std::uint64_t end);

  PayloadMemory& Together;
  const SegmentFile& File;
  std::uint64_t End;
  std::uint64_t PageBytes;
  std::vector<std::uint32_t> Hashes;
  std::mutex Mutex;
  Hold Now; ///< may be null
  std::atomic<std::uint64_t> Used{ 0 };
};

} // namespace banyan

#endif
