// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Cells/PieceMeans.h"

#include "Cells/PlaceHash.h"
#include "Parallel/Cells/ExchangeBytes.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"
#include "Render/Cells/PointMeans.h"

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

namespace banyan
{
namespace
{

/// Points of faces that no other cell of the piece has: around all others are this rank's cells
/// alone. Of points in the same place, the first one.
std::vector<std::int64_t> PointsAtEnds(const DrawnCells& cells, const std::vector<PointTwin>& twins)
{
  std::vector<std::int64_t> points;
  for (std::size_t place = 0; place < cells.Alone.size(); ++place)
  {
    if (cells.Alone[place] == 0)
    {
      continue;
    }
    const MeshCell cell = cells.Mesh.Cell(cells.Order[place]);
    const CellFaces& faces = FacesOf(cell.Shape);
    for (std::size_t face = 0; face < static_cast<std::size_t>(faces.Count); ++face)
    {
      for (int i = 0; (cells.Alone[place] >> face & 1U) != 0 && i < faces.Faces[face].Count; ++i)
      {
        const auto corner =
          static_cast<std::size_t>(faces.Faces[face].Corners[static_cast<std::size_t>(i)]);
        points.push_back(FirstAt(twins, cell.Points[corner]));
      }
    }
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

template <class T>
void Put(Bytes& message, const T* numbers, std::size_t count)
{
  const std::size_t at = message.size();
  message.resize(at + count * sizeof(T));
  std::memcpy(message.data() + at, numbers, count * sizeof(T));
}

/// Adds up what ranks have sent of the same points.
/// @param parts by rank: per point its hash and numbers
/// @return by rank, the numbers in the order that they came in
std::vector<Bytes> AddUp(const std::vector<Bytes>& parts, std::size_t width)
{
  struct Entry
  {
    std::uint64_t Hash;
    std::size_t Rank;
    std::size_t Index;
  };
  const std::size_t size = sizeof(std::uint64_t) + width * sizeof(double);
  std::vector<Entry> entries;
  std::vector<Bytes> sums(parts.size());
  for (std::size_t rank = 0; rank < parts.size(); ++rank)
  {
    const std::size_t count = parts[rank].size() / size;
    sums[rank].resize(count * width * sizeof(double));
    for (std::size_t i = 0; i < count; ++i)
    {
      entries.push_back({ LoadNumber<std::uint64_t>(parts[rank].data() + i * size), rank, i });
    }
  }
  std::sort(entries.begin(), entries.end(),
    [](const Entry& a, const Entry& b)
    { return std::tie(a.Hash, a.Rank, a.Index) < std::tie(b.Hash, b.Rank, b.Index); });
  std::vector<double> sum(width);
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end)
  {
    std::fill(sum.begin(), sum.end(), 0.0);
    for (end = begin; end < entries.size() && entries[end].Hash == entries[begin].Hash; ++end)
    {
      const std::uint8_t* const from =
        parts[entries[end].Rank].data() + entries[end].Index * size + sizeof(std::uint64_t);
      for (std::size_t i = 0; i < width; ++i)
      {
        sum[i] += LoadNumber<double>(from + i * sizeof(double));
      }
    }
    for (std::size_t i = begin; i < end; ++i)
    {
      std::memcpy(sums[entries[i].Rank].data() + entries[i].Index * width * sizeof(double),
        sum.data(), width * sizeof(double));
    }
  }
  return sums;
}

/// Brings in what other ranks' cells have at the points of this one.
void AddOthers(Communicator& communicator, const DrawnCells& cells, PointSums& sums)
{
  const auto size = static_cast<std::uint64_t>(communicator.Size());
  const auto width = static_cast<std::size_t>(sums.Width);
  const std::vector<std::int64_t> points = PointsAtEnds(cells, sums.Twins);
  std::vector<Bytes> messages(static_cast<std::size_t>(size));
  std::vector<std::size_t> ranks;
  for (const std::int64_t point : points)
  {
    const std::uint64_t hash = HashOfPlace(cells.Mesh.Point(point));
    ranks.push_back(static_cast<std::size_t>(hash % size));
    Put(messages[ranks.back()], &hash, 1);
    Put(
      messages[ranks.back()], sums.Numbers.data() + static_cast<std::size_t>(point) * width, width);
  }
  const std::vector<Bytes> answers =
    ExchangeBytes(communicator, AddUp(ExchangeBytes(communicator, std::move(messages)), width));
  std::vector<std::size_t> taken(answers.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    std::memcpy(sums.Numbers.data() + static_cast<std::size_t>(points[i]) * width,
      answers[ranks[i]].data() + taken[ranks[i]], width * sizeof(double));
    taken[ranks[i]] += width * sizeof(double);
  }
  sums.GiveToTwins();
}

/// Sums of this rank's cells, then of all.
/// @param make GradientSums or MeanSums
template <class Make>
PointSums SumsOfAll(Communicator& communicator, const DrawnCells& cells,
  const std::vector<float>& values, ThreadPool& pool, const Make& make)
{
  PointSums sums;
  std::string failure;
  Attempt(failure, [&] { sums = make(cells, values, pool); });
  ThrowTogether(communicator, failure);
  AddOthers(communicator, cells, sums);
  return sums;
}

} // namespace

std::vector<float> PieceGradients(Communicator& communicator, const DrawnCells& cells,
  const std::vector<float>& values, ThreadPool& pool)
{
  return GradientsOf(SumsOfAll(communicator, cells, values, pool, GradientSums));
}

std::vector<float> PieceMeans(Communicator& communicator, const DrawnCells& cells,
  const std::vector<float>& values, ThreadPool& pool)
{
  return MeansOf(SumsOfAll(communicator, cells, values, pool, MeanSums));
}

void GivePieceGradients(Communicator& communicator, CellSource& source, ThreadPool& pool)
{
  const CellField& field = source.Cells();
  const DrawnCells& cells = *field.Cells;
  const bool wants = cells.Mesh.PointCount > 0 && field.Gradients.empty();
  if (AllMax(communicator, wants ? 1.0 : 0.0) > 0.0)
  {
    source.GiveGradients(PieceGradients(communicator, cells,
      field.OfCells ? PieceMeans(communicator, cells, field.Values, pool) : field.Values, pool));
  }
}

} // namespace banyan
