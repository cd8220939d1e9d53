// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Decode/PayloadPages.h"

#include "Base/Error.h"
#include "Base/Hash.h"
#include "Series/Decode/BlockAllocator.h"
#include "Series/Format/GroupFormat.h"
#include "Series/Format/SegmentFormat.h"

#include <algorithm>
#include <map>
#include <utility>

namespace banyan
{
namespace
{

/// A page that is missing brings so many bytes of the file to the system's memory: blocks are
/// decoded backwards, which the system does not foresee.
constexpr std::uint64_t WindowBytes = 128 * 1024;
/// Memory is taken in pieces of so many bytes, or of a page where that is larger.
constexpr std::uint64_t PieceBytes = 64 * 1024;
constexpr std::size_t LockCount = 16;

} // namespace

class PayloadPages::Memory
{
public:
  Memory(std::atomic<std::uint64_t>& total, std::uint64_t end, std::uint64_t pages,
    std::uint64_t pageBytes)
    : Total(total)
    , EachBytes(std::max(PieceBytes, pageBytes))
    , Pieces(static_cast<std::size_t>((end + EachBytes - 1) / EachBytes))
    , Good(static_cast<std::size_t>(pages))
    , Expected(static_cast<std::size_t>(end / WindowBytes + 1))
  {
  }
  ~Memory()
  {
    for (const std::atomic<std::uint8_t*>& piece : this->Pieces)
    {
      if (piece != nullptr)
      {
        BlockAllocator::Free(piece, static_cast<std::size_t>(this->EachBytes));
      }
    }
    this->Total -= this->Taken;
  }
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  std::uint8_t* At(std::uint64_t offset) const
  {
    return this->Pieces[static_cast<std::size_t>(offset / this->EachBytes)].load(
             std::memory_order_acquire) +
           offset % this->EachBytes;
  }
  bool Has(std::uint64_t page) const
  {
    return this->Good[static_cast<std::size_t>(page)].load(std::memory_order_acquire);
  }
  void Count(std::uint64_t bytes)
  {
    this->Taken += bytes;
    this->Total += bytes;
  }
  /// Makes room for what lies in the piece at an offset. Under the lock of the piece.
  void MakeRoom(std::uint64_t offset)
  {
    std::atomic<std::uint8_t*>& piece =
      this->Pieces[static_cast<std::size_t>(offset / this->EachBytes)];
    if (piece == nullptr)
    {
      piece = static_cast<std::uint8_t*>(
        BlockAllocator::Allocate(static_cast<std::size_t>(this->EachBytes)));
      this->Count(this->EachBytes);
    }
  }
  /// Bytes that lie in several pieces, in one.
  const std::uint8_t* Joined(std::uint64_t offset, std::uint64_t bytes)
  {
    std::lock_guard<std::mutex> lock(this->JoinedMutex);
    Bytes& all = this->JoinedParts[{ offset, bytes }];
    if (all.empty())
    {
      this->Count(bytes);
      all.reserve(static_cast<std::size_t>(bytes));
      for (const std::uint64_t end = offset + bytes; offset < end;)
      {
        const std::uint64_t next = std::min((offset / this->EachBytes + 1) * this->EachBytes, end);
        const std::uint8_t* const from = this->At(offset);
        all.insert(all.end(), from, from + (next - offset));
        offset = next;
      }
    }
    return all.data();
  }

  std::atomic<std::uint64_t>& Total; ///< of all segments
  const std::uint64_t EachBytes;     ///< of a piece
  std::vector<std::atomic<std::uint8_t*>> Pieces;
  std::vector<std::atomic<bool>> Good;     ///< by page: it was read and checked
  std::vector<std::atomic<bool>> Expected; ///< by window: the system was told
  std::mutex Locks[LockCount];             ///< of pieces in which something is read
  std::mutex JoinedMutex;
  std::map<std::pair<std::uint64_t, std::uint64_t>, Bytes> JoinedParts;
  std::atomic<std::uint64_t> Taken{ 0 };
};

PayloadPages::PayloadPages(PayloadMemory& together, const SegmentFile& file, std::uint64_t end,
  std::vector<std::uint32_t> hashes)
  : Together(together)
  , File(file)
  , End(end)
  , PageBytes(PageBytesOf(end))
  , Hashes(std::move(hashes))
{
  std::lock_guard<std::mutex> lock(together.Mutex);
  together.All.push_back(this);
}

PayloadPages::~PayloadPages()
{
  std::lock_guard<std::mutex> lock(this->Together.Mutex);
  auto& all = this->Together.All;
  all.erase(std::remove(all.begin(), all.end(), this), all.end());
}

PayloadPages::Hold PayloadPages::InMemory()
{
  this->Used.store(this->Together.Clock.load(std::memory_order_relaxed), std::memory_order_relaxed);
  std::lock_guard<std::mutex> lock(this->Mutex);
  if (!this->Now)
  {
    this->Now = std::make_shared<Memory>(
      this->Together.Total, this->End, this->Hashes.size(), this->PageBytes);
  }
  return this->Now;
}

const std::uint8_t* PayloadPages::At(const Hold& hold, std::uint64_t offset, std::uint64_t bytes)
{
  Memory& memory = *hold;
  const std::uint64_t last = (offset + bytes - 1) / this->PageBytes;
  const std::uint64_t together = memory.EachBytes / this->PageBytes;
  for (std::uint64_t page = offset / this->PageBytes; page <= last; ++page)
  {
    if (memory.Has(page))
    {
      continue;
    }
    // Pages that others decode from must not be written.
    const std::uint64_t piece = page / together;
    std::lock_guard<std::mutex> lock(memory.Locks[piece % LockCount]);
    const std::uint64_t most = std::min(last + 1, (piece + 1) * together);
    std::uint64_t end = page;
    while (end < most && !memory.Has(end))
    {
      ++end;
    }
    if (end > page)
    {
      this->ReadIn(memory, page, end);
    }
  }
  return offset / memory.EachBytes == (offset + bytes - 1) / memory.EachBytes
           ? memory.At(offset)
           : memory.Joined(offset, bytes);
}

/// @param end of pages in one piece
void PayloadPages::ReadIn(Memory& memory, std::uint64_t page, std::uint64_t end)
{
  const std::uint64_t first = page * this->PageBytes;
  const std::uint64_t window = first / WindowBytes;
  if (!memory.Expected[static_cast<std::size_t>(window)].exchange(true))
  {
    this->File.Expect(window * WindowBytes, WindowBytes);
  }
  memory.MakeRoom(first);
  const std::uint64_t bytes = std::min(end * this->PageBytes, this->End) - first;
  this->File.Read(first, memory.At(first), static_cast<std::size_t>(bytes));
  this->Together.Clock.fetch_add(1, std::memory_order_relaxed);
  for (; page < end; ++page)
  {
    const std::uint64_t from =
      std::max<std::uint64_t>(page * this->PageBytes, segment::HeaderBytes);
    const std::uint64_t to = std::min((page + 1) * this->PageBytes, this->End);
    if (static_cast<std::uint32_t>(ShortHashOf(memory.At(from), to - from)) !=
        this->Hashes[static_cast<std::size_t>(page)])
    {
      throw Error("Payloads of the segment are damaged: their checksum does not fit",
        { this->File.Path(), from });
    }
    memory.Good[static_cast<std::size_t>(page)].store(true, std::memory_order_release);
  }
  if (this->Together.Total > this->Together.Budget)
  {
    this->Together.Shrink(this->Together.Budget);
  }
}

void PayloadMemory::Shrink(std::uint64_t most)
{
  std::lock_guard<std::mutex> lock(this->Mutex);
  std::vector<std::pair<std::uint64_t, PayloadPages*>> all; // others go on using them meanwhile
  for (PayloadPages* pages : this->All)
  {
    all.emplace_back(pages->Used, pages);
  }
  std::sort(all.begin(), all.end());
  for (auto next = all.begin(); next != all.end() && this->Total > most; ++next)
  {
    // Who decodes from it holds it until that is done.
    PayloadPages::Hold let;
    std::lock_guard<std::mutex> own(next->second->Mutex);
    std::swap(let, next->second->Now);
  }
}

} // namespace banyan
