// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Points/PointsReader.h"

#include "Base/Bytes.h"
#include "Base/Error.h"
#include "Base/Hash.h"
#include "Base/ThreadPool.h"
#include "Series/Format/SegmentFile.h"
#include "Series/Points/PointsCode.h"
#include "Series/Points/PointsFormat.h"

#include <cstring>
#include <vector>

namespace banyan
{
namespace
{

using namespace points_file;

/// A chunk may be at most so many times its stored bytes: zstd does not compress more.
constexpr std::uint64_t GreatestRatio = 32768;

void Require(bool good, const char* sentence)
{
  if (!good)
  {
    throw Error(sentence);
  }
}

SegmentIndex AsSegment(const PointsFile& points)
{
  SegmentIndex segment;
  segment.File = points.File;
  segment.Bytes = points.Bytes;
  return segment;
}

struct Chunk
{
  std::uint64_t Hash = 0;
  std::uint64_t Offset = 0;
  std::uint64_t Bytes = 0;
};

/// The directory of an open file, checked.
std::vector<Chunk> ChunksOf(
  const SegmentFile& file, const PointsFile& index, const PointsLayout& layout)
{
  const auto count = static_cast<std::uint64_t>(layout.ChunkCount());
  Require(file.Bytes() >= HeadBytes && (file.Bytes() - HeadBytes) / EntryBytes >= count,
    "The file is too short for its directory");
  const Bytes head = file.Read(0, HeadBytes + count * EntryBytes);
  Require(HashOf(head.data(), head.size()) == Hash128{ index.HashLow, index.HashHigh },
    "The file is damaged, or not the one that belongs to the series");
  Require(std::memcmp(head.data(), Magic, sizeof(Magic)) == 0, "This is no file of points");
  const auto version = LoadNumber<std::uint32_t>(head.data() + 8);
  if (version != Version)
  {
    throw Error("The file has version " + std::to_string(version) + ", and this Banyan reads " +
                std::to_string(Version));
  }
  Require(LoadNumber<std::uint64_t>(head.data() + 16) == count,
    "The file has another number of chunks than the grid");
  std::vector<Chunk> chunks(count);
  std::uint64_t offset = head.size();
  for (std::size_t i = 0; i < chunks.size(); ++i)
  {
    const std::uint8_t* const entry = head.data() + HeadBytes + i * EntryBytes;
    chunks[i] = { LoadNumber<std::uint64_t>(entry), offset, LoadNumber<std::uint64_t>(entry + 8) };
    const std::uint64_t whole = layout.BytesOf(static_cast<std::int64_t>(i));
    Require(chunks[i].Bytes <= file.Bytes() - offset && chunks[i].Bytes <= whole &&
              whole / GreatestRatio <= chunks[i].Bytes,
      "A chunk of the points has an impossible size");
    offset += chunks[i].Bytes;
  }
  Require(offset == file.Bytes(), "The file is longer than its chunks");
  return chunks;
}

/// The samples of a part whose fine ones lie in a chunk, along an axis: [first, end).
struct Run
{
  int First = 0;
  int End = 0;
};

Run RunIn(const BrickLayout& level, int axis, const Run& part, const Run& fine)
{
  const auto at = [&](int sample)
  {
    glm::ivec3 place(0);
    place[axis] = sample;
    return level.FineSample(place)[axis];
  };
  // The first sample of the part that is not below a fine one; they increase.
  const auto notBelow = [&](int wanted)
  {
    int low = part.First;
    int high = part.End;
    while (low < high)
    {
      const int middle = low + (high - low) / 2;
      if (at(middle) < wanted)
      {
        low = middle + 1;
      }
      else
      {
        high = middle;
      }
    }
    return low;
  };
  return { notBelow(fine.First), notBelow(fine.End) };
}

class PointsReader
{
public:
  PointsReader(const std::string& folder, const SeriesIndex& index, int step, int level)
    : Index(index.Points->FileOf(step))
    , Layout(index.Points->Form, index.Domain.Samples())
    , Rectilinear(index.Points->Form.Kind == GridKind::Rectilinear)
    , Level(index.Domain.Samples(), index.BrickCells, level)
    , File(folder, AsSegment(this->Index))
    , Chunks(ChunksOf(this->File, this->Index, this->Layout))
  {
  }

  void Read(const Box& part, const std::array<void*, 3>& values, ThreadPool& pool) const
  {
    pool.ParallelFor(this->Layout.ChunkCount(),
      [&](std::int64_t chunk)
      {
        const Box box = this->Layout.SamplesOf(chunk);
        Box wanted = part;
        for (int axis = 0; axis < 3; ++axis)
        {
          // A row of coordinates lies along the first axis, whatever axis it is of.
          const int of = this->Rectilinear ? static_cast<int>(chunk) : axis;
          const bool other = this->Rectilinear && axis > 0;
          const Run run = other ? Run{ 0, 1 }
                                : RunIn(this->Level, of, { part.Lo[of], part.Hi[of] },
                                    { box.Lo[axis], box.Hi[axis] });
          wanted.Lo[axis] = run.First;
          wanted.Hi[axis] = run.End;
        }
        if (!wanted.Empty())
        {
          this->ReadChunk(chunk, wanted, part, values);
        }
      });
  }

private:
  /// @param wanted samples of the level; of rectilinear grids along x
  void ReadChunk(std::int64_t number, const Box& wanted, const Box& part,
    const std::array<void*, 3>& values) const
  {
    const Chunk& chunk = this->Chunks[static_cast<std::size_t>(number)];
    const Bytes stored = this->File.Read(chunk.Offset, static_cast<std::size_t>(chunk.Bytes));
    Require(ShortHashOf(stored.data(), stored.size()) == chunk.Hash,
      "The file is damaged: a checksum does not fit");
    const Box box = this->Layout.SamplesOf(number);
    const glm::ivec3 size = box.Size();
    Bytes points(this->Layout.BytesOf(number));
    UnpackPoints(this->Layout.TypeOf(number), this->Layout.Components(), size, stored.data(),
      stored.size(), points.data());
    const int axis = this->Rectilinear ? static_cast<int>(number) : 0;
    auto* const to = static_cast<std::uint8_t*>(values[static_cast<std::size_t>(axis)]);
    const std::size_t tuple = this->Layout.TupleBytes(number);
    const glm::ivec3 whole = part.Size();
    ForPositions(wanted,
      [&](const glm::ivec3& sample)
      {
        std::int64_t from = 0;
        std::int64_t at = 0;
        if (this->Rectilinear)
        {
          glm::ivec3 along(0);
          along[axis] = sample.x;
          from = this->Level.FineSample(along)[axis];
          at = sample.x - part.Lo[axis];
        }
        else
        {
          const glm::ivec3 fine = this->Level.FineSample(sample) - box.Lo;
          const glm::ivec3 place = sample - part.Lo;
          from = (std::int64_t{ fine.z } * size.y + fine.y) * size.x + fine.x;
          at = (std::int64_t{ place.z } * whole.y + place.y) * whole.x + place.x;
        }
        std::memcpy(to + static_cast<std::size_t>(at) * tuple,
          points.data() + static_cast<std::size_t>(from) * tuple, tuple);
      });
  }

  const PointsFile& Index;
  PointsLayout Layout;
  bool Rectilinear;
  BrickLayout Level;
  SegmentFile File;
  std::vector<Chunk> Chunks;
};

} // namespace

void ReadPoints(const std::string& folder, const SeriesIndex& index, int step, int level,
  const Box& part, const std::array<void*, 3>& values, ThreadPool& pool)
{
  if (!index.Points)
  {
    throw Error("The series has no points of its own: its grid is regular, or a mesh");
  }
  try
  {
    PointsReader(folder, index, step, level).Read(part, values, pool);
  }
  catch (const Error& error)
  {
    throw Error(std::string("The points of the grid cannot be read: ") + error.what(),
      error.Place().File.empty() ? ErrorPlace{ folder + "/" + index.Points->FileOf(step).File }
                                 : ErrorPlace{});
  }
}

} // namespace banyan
