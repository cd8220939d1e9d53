// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Points/PointsWriter.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Series/Format/AtomicFile.h"
#include "Series/Points/PointsCode.h"
#include "Series/Points/PointsFormat.h"

#include <algorithm>
#include <cstring>

namespace banyan
{
namespace
{

using namespace points_file;

/// The values of a chunk, one after the other.
Bytes ValuesOf(const PointsView& points, const PointsLayout& layout, std::int64_t chunk)
{
  const bool rectilinear = points.Form.Kind == GridKind::Rectilinear;
  const auto* from = static_cast<const std::uint8_t*>(
    points.Values[rectilinear ? static_cast<std::size_t>(chunk) : 0]);
  const std::size_t tuple = layout.TupleBytes(chunk);
  const Box box = layout.SamplesOf(chunk);
  const std::size_t row = static_cast<std::size_t>(box.Size().x) * tuple;
  Bytes values(layout.BytesOf(chunk));
  std::uint8_t* to = values.data();
  for (int z = box.Lo.z; z < box.Hi.z; ++z)
  {
    for (int y = box.Lo.y; y < box.Hi.y; ++y, to += row)
    {
      const std::int64_t first =
        (std::int64_t{ z } * points.Samples.y + y) * points.Samples.x + box.Lo.x;
      std::memcpy(to, from + static_cast<std::size_t>(first) * tuple, row);
    }
  }
  return values;
}

Bytes HeadOf(std::int64_t chunks)
{
  Bytes head(HeadBytes + static_cast<std::size_t>(chunks) * EntryBytes);
  std::memcpy(head.data(), Magic, sizeof(Magic));
  StoreNumber(head.data() + 8, Version);
  StoreNumber(head.data() + 16, static_cast<std::uint64_t>(chunks));
  return head;
}

} // namespace

void CheckPoints(const PointsView& points, const SeriesIndex& index)
{
  if (!index.Points || !(index.Points->Form == points.Form))
  {
    throw Error("The points are not of the kind of grid, or of the types, that the series is of");
  }
  if (points.Samples != index.Domain.Samples())
  {
    throw Error("There must be a point for each sample of the grid, and no others");
  }
}

PointsFile WritePoints(
  const PointsView& points, int step, const PointsPlace& place, ThreadPool& pool)
{
  const PointsLayout layout(points.Form, points.Samples);
  const std::int64_t chunks = layout.ChunkCount();
  Bytes head = HeadOf(chunks);
  AtomicFile file(place.Folder + "/" + place.Temporary);
  file.Append(head.data(), head.size());
  // As many at a time as keep all threads at work, and no more in memory.
  const std::int64_t batch = std::int64_t{ 4 } * pool.Width();
  std::vector<Bytes> packed(static_cast<std::size_t>(std::min(batch, chunks)));
  for (std::int64_t first = 0; first < chunks; first += batch)
  {
    const std::int64_t count = std::min(batch, chunks - first);
    pool.ParallelFor(count,
      [&](std::int64_t i)
      {
        const std::int64_t chunk = first + i;
        Bytes& bytes = packed[static_cast<std::size_t>(i)];
        bytes = PackPoints(layout.TypeOf(chunk), layout.Components(),
          layout.SamplesOf(chunk).Size(), ValuesOf(points, layout, chunk).data());
        std::uint8_t* const entry =
          head.data() + HeadBytes + static_cast<std::size_t>(chunk) * EntryBytes;
        StoreNumber(entry, ShortHashOf(bytes.data(), bytes.size()));
        StoreNumber(entry + 8, static_cast<std::uint64_t>(bytes.size()));
      });
    for (std::int64_t i = 0; i < count; ++i)
    {
      const Bytes& bytes = packed[static_cast<std::size_t>(i)];
      file.Append(bytes.data(), bytes.size());
    }
  }
  file.Overwrite(0, head.data(), head.size());
  const Hash128 hash = HashOf(head.data(), head.size());
  PointsFile written;
  written.File = place.NameOf(hash);
  written.FirstStep = step;
  written.Bytes = file.Size();
  written.HashLow = hash.Low;
  written.HashHigh = hash.High;
  file.CommitAs(place.Folder + "/" + written.File);
  return written;
}

} // namespace banyan
