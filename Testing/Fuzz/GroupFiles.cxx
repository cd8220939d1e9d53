// SPDX-License-Identifier: BSD-3-Clause
#include "GroupFiles.h"

#include "Base/Hash.h"
#include "Base/ThreadPool.h"
#include "Fuzz.h"
#include "Series/Encode/GroupWriter.h"
#include "Series/Encode/SeriesEncoder.h"
#include "Series/Format/AtomicFile.h"
#include "Series/Format/GroupFormat.h"
#include "Series/Format/SegmentFormat.h"
#include "Series/Format/Zstd.h"

#include <cmath>
#include <fstream>
#include <iterator>

namespace banyan::fuzz
{
namespace
{

constexpr int Interval = 3;
constexpr int StepCount = 5;
constexpr int X = 19, Y = 9, Z = 10; // two bricks

/// Waves, noise, a flat part, a part that rests, and values that are kept beside the lattice.
double ValueAt(int x, int y, int z, int step)
{
  const double wave =
    std::sin(0.5 * x + step) * std::cos(0.3 * y) + 0.1 * (x * 7 + y * 5 + z * 3) / 80;
  if ((x * 31 + y * 17 + z * 7 + step) % 97 == 0)
  {
    return 1e6;
  }
  return x >= 12 ? (y < 5 ? 0.5 : std::sin(0.2 * z)) : wave;
}

template <class T>
std::vector<T> StepOf(int step, double scale)
{
  std::vector<T> values;
  for (int z = 0; z < Z; ++z)
  {
    for (int y = 0; y < Y; ++y)
    {
      for (int x = 0; x < X; ++x)
      {
        values.push_back(static_cast<T>(std::min(scale * ValueAt(x, y, z, step), 100.0 * scale)));
      }
    }
  }
  return values;
}

template <class T>
SeriesIndex Encode(const std::string& path, double scale, const EncodeOptions& options)
{
  Grid grid;
  grid.Extent.Hi = { X, Y, Z };
  ArrayDescription description;
  description.Name = "values";
  description.Type = ScalarTypeOf<T>();
  description.ComponentNames = { "" };
  description.SeriesRanges = { ValueRange{ -1.5 * scale, 1.5 * scale } };
  ThreadPool pool(1);
  SeriesEncoder encoder(path, grid, { description }, options, pool);
  for (int step = 0; step < StepCount; ++step)
  {
    encoder.AddStep(step, { { StepOf<T>(step, scale).data() } });
  }
  return encoder.Finish();
}

} // namespace

SmallSeries::SmallSeries(const std::string& folder, int kind)
  : Path(folder + "/" + std::to_string(kind) + ".banyan")
  , Number(kind < 4 ? 0 : 1)
{
  EncodeOptions options;
  options.KeyframeInterval = Interval;
  options.BrickCells = 16;
  const int type = kind % 4;
  options.ErrorBound = type == 3 ? 0 : 1.0 / 512;
  this->Index = type == 0   ? Encode<float>(this->Path, 1, options)
                : type == 1 ? Encode<std::int16_t>(this->Path, 50, options)
                : type == 2 ? Encode<double>(this->Path, 1e-300, options)
                            : Encode<std::int64_t>(this->Path, 1e12, options);
  std::ifstream stream(this->Path + ".d/" + this->Changed().File, std::ios::binary);
  const std::string file{ std::istreambuf_iterator<char>(stream), {} };
  const auto* data = reinterpret_cast<const std::uint8_t*>(file.data());
  const segment::Header header = segment::LoadHeader(data);
  this->Parts.Payloads.assign(data + segment::HeaderBytes, data + header.PayloadEnd);
  for (std::uint32_t i = 1; i < header.Sections; ++i)
  {
    const std::uint8_t* entry = data + header.DirectoryOffset + i * group::EntryBytes;
    Bytes section(LoadNumber<std::uint32_t>(entry + 12));
    const std::uint8_t* stored = data + LoadNumber<std::uint64_t>(entry);
    const std::uint32_t bytes = LoadNumber<std::uint32_t>(entry + 8);
    if (bytes == section.size())
    {
      section.assign(stored, stored + bytes);
    }
    else
    {
      Decompress(stored, bytes, section.data(), section.size());
    }
    this->Parts.Sections.push_back(section);
  }
}

Bytes ToInput(int kind, const GroupParts& parts)
{
  Bytes input{ static_cast<std::uint8_t>(kind) };
  for (const Bytes& section : parts.Sections)
  {
    input.push_back(static_cast<std::uint8_t>(section.size()));
    input.push_back(static_cast<std::uint8_t>(section.size() >> 8));
    input.insert(input.end(), section.begin(), section.end());
  }
  input.insert(input.end(), parts.Payloads.begin(), parts.Payloads.end());
  return input;
}

GroupParts FromInput(const std::uint8_t* data, std::size_t size, std::size_t sections)
{
  Input in(data, size);
  GroupParts parts;
  for (std::size_t i = 0; i < sections; ++i)
  {
    parts.Sections.push_back(in.Bytes(in.Take<std::uint16_t>()));
  }
  parts.Payloads = in.Rest();
  return parts;
}

Bytes Assemble(const GroupParts& parts, const SegmentIndex& segment)
{
  Bytes file(segment::HeaderBytes);
  file.insert(file.end(), parts.Payloads.begin(), parts.Payloads.end());
  segment::Header header;
  header.Steps = static_cast<std::uint32_t>(segment.Steps);
  header.PayloadEnd = file.size();
  Bytes pages;
  const std::uint64_t page = PageBytesOf(header.PayloadEnd);
  for (std::uint64_t at = 0; at < header.PayloadEnd; at += page)
  {
    const std::uint64_t from = std::max<std::uint64_t>(at, segment::HeaderBytes);
    const auto hash = static_cast<std::uint32_t>(
      ShortHashOf(file.data() + from, std::min(at + page, header.PayloadEnd) - from));
    pages.resize(pages.size() + sizeof(hash));
    StoreNumber(pages.data() + pages.size() - sizeof(hash), hash);
  }
  std::vector<Bytes> sections{ pages };
  sections.insert(sections.end(), parts.Sections.begin(), parts.Sections.end());
  Bytes directory;
  for (const Bytes& section : sections)
  {
    const std::size_t offset = file.size();
    file.insert(file.end(), section.begin(), section.end());
    const std::size_t stored = section.size();
    std::uint8_t entry[group::EntryBytes];
    StoreNumber(entry, std::uint64_t{ offset });
    StoreNumber(entry + 8, static_cast<std::uint32_t>(stored));
    StoreNumber(entry + 12, static_cast<std::uint32_t>(section.size()));
    StoreNumber(entry + 16, ShortHashOf(file.data() + offset, stored));
    directory.insert(directory.end(), entry, entry + sizeof(entry));
  }
  header.Sections = static_cast<std::uint32_t>(sections.size());
  header.DirectoryOffset = file.size();
  header.DirectoryHash = ShortHashOf(directory.data(), directory.size());
  file.insert(file.end(), directory.begin(), directory.end());
  header.FileBytes = file.size();
  segment::StoreHeader(header, file.data());
  return file;
}

} // namespace banyan::fuzz
