// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Decode_GroupReader_h
#define banyan_Series_Decode_GroupReader_h

#include "Base/Hash.h"
#include "Series/Decode/CacheContext.h"
#include "Series/Format/GroupFormat.h"
#include "Series/Format/SegmentFormat.h"

#include <memory>
#include <mutex>
#include <string>

namespace banyan
{

/// One segment. Every access is checked against the index that names it; may be used
/// from any thread.
class GroupReader
{
public:
  /// @param components of all arrays of the series
  /// @param caches live longer
  GroupReader(const std::string& folder, const SegmentIndex& index, std::uint32_t components,
    CacheContext& caches = *CacheContext::Process());
  /// @param file of several readers, where the index names it for several groups
  GroupReader(std::shared_ptr<const SegmentFile> file, const SegmentIndex& index,
    std::uint32_t components, CacheContext& caches = *CacheContext::Process());

  const std::string& Path() const { return this->File->Path(); }
  int FirstStep() const { return this->Index.FirstStep; }
  int Steps() const { return this->Index.Steps; }

  /// Unpacks a section: 0 holds the hashes of pages, then come the heads, then the steps' tables.
  Bytes Section(std::uint32_t number);
  std::uint32_t HeadSection(std::uint32_t component) const { return 1 + component; }
  std::uint32_t StepSection(int step, std::uint32_t component) const
  {
    return 1 + this->Components + static_cast<std::uint32_t>(step) * this->Components + component;
  }
  std::uint64_t PayloadEnd();

  /// The payloads of the segment, read and checked as they are needed. Throws Error when the table
  /// of their checksums is damaged.
  PayloadPages& Payloads();

  CacheContext& Caches() const { return this->Context; }

  const Hash128& HeaderHash() const { return this->Expected; }

private:
  void Check();

  std::shared_ptr<const SegmentFile> File;
  SegmentIndex Index;
  std::uint32_t Components;
  CacheContext& Context;
  Hash128 Expected;
  std::mutex Mutex;
  bool Checked = false;
  segment::Header Head;
  Bytes Directory;
  std::unique_ptr<PayloadPages> Pages;
  std::once_flag PagesOnce;
};

} // namespace banyan

#endif
