// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Series/Hash.h"
#include "Series/SegmentReader.h"

#include <cstdlib>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>

namespace
{

using banyan::Bytes;
namespace segment = banyan::segment;

/// Makes the hashes of header, directory and tables fit, as far as they lie inside the file.
void Seal(Bytes& file)
{
  std::memcpy(file.data(), segment::Magic, 8);
  banyan::StoreNumber(file.data() + 8, segment::Version);
  const auto offset = banyan::LoadNumber<std::uint64_t>(file.data() + 24);
  if (offset <= file.size())
  {
    for (std::uint64_t at = offset; file.size() - at >= segment::EntryBytes;
         at += segment::EntryBytes)
    {
      const segment::TableEntry entry = segment::LoadEntry(file.data() + at);
      if (entry.Offset < file.size() && entry.StoredBytes <= file.size() - entry.Offset)
      {
        banyan::StoreNumber(file.data() + at + 24,
          banyan::ShortHashOf(file.data() + entry.Offset, entry.StoredBytes));
      }
    }
    banyan::StoreNumber(
      file.data() + 32, banyan::ShortHashOf(file.data() + offset, file.size() - offset));
  }
  banyan::StoreNumber(file.data() + 48, std::uint64_t{ file.size() });
  banyan::StoreNumber(file.data() + 56, banyan::ShortHashOf(file.data(), 56));
}

void ReadTables(const Bytes& file, const std::string& name)
{
  banyan::SegmentIndex index;
  index.File = name;
  index.FirstStep = static_cast<int>(banyan::LoadNumber<std::uint32_t>(file.data() + 16));
  index.Steps = 1;
  index.Bytes = file.size();
  const banyan::Hash128 hash = banyan::HashOf(file.data(), segment::HeaderBytes);
  index.HashLow = hash.Low;
  index.HashHigh = hash.High;
  const auto tables = banyan::LoadNumber<std::uint32_t>(file.data() + 20);
  const banyan::SegmentReader reader("/proc/self/fd", index, tables);
  for (std::uint32_t t = 0; t < tables; ++t)
  {
    const segment::TableEntry entry = reader.Entry(t);
    const auto type = static_cast<banyan::ScalarType>(entry.QuantizerStep % 10);
    const banyan::BrickLayout layout({ 20, 20, 20 }, 8, static_cast<int>(t % 3));
    const banyan::NodeTable table = reader.Table(entry, layout, type);
    for (std::size_t i = 0; i < table.Payloads.size(); ++i)
    {
      (void)reader.Payload(table.Payloads[i], table.Nodes[i].PayloadBytes); // must lie inside
    }
  }
}

} // namespace

/// The input is a segment file of one step.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  if (size < segment::HeaderBytes)
  {
    return 0;
  }
  Bytes file(data, data + size);
  Seal(file);
  const int descriptor = memfd_create("segment", 0);
  if (descriptor < 0 || write(descriptor, file.data(), file.size()) < 0)
  {
    std::abort();
  }
  try
  {
    ReadTables(file, std::to_string(descriptor));
  }
  catch (const banyan::Error&)
  {
  }
  (void)close(descriptor);
  return 0;
}
