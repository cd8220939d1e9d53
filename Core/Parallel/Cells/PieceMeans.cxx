// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Cells/PieceMeans.h"

#include "Cells/PlaceHash.h"
#include "Parallel/Cells/HashedQuestions.h"
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

/// Adds up what ranks have sent of the same points: the sums of each.
/// @param parts by rank: per point its hash and `width` numbers
std::vector<Bytes> AddUp(const std::vector<Bytes>& parts, std::size_t width)
{
  const std::size_t numbers = width * sizeof(double);
  const std::size_t size = sizeof(std::uint64_t) + numbers;
  std::vector<Bytes> sums(parts.size());
  for (std::size_t rank = 0; rank < parts.size(); ++rank)
  {
    sums[rank].resize(parts[rank].size() / size * numbers);
  }
  using Entry = AskedRecord<std::uint64_t>;
  std::vector<Entry> entries = RecordsOf<std::uint64_t>(parts, size);
  std::sort(entries.begin(), entries.end(),
    [](const Entry& a, const Entry& b)
    { return std::tie(a.Of, a.Rank, a.Index) < std::tie(b.Of, b.Rank, b.Index); });
  std::vector<double> sum(width);
  ForGroups(
    entries, [](const Entry& a, const Entry& b) { return a.Of == b.Of; },
    [&](std::size_t begin, std::size_t end)
    {
      std::fill(sum.begin(), sum.end(), 0.0);
      for (std::size_t each = begin; each < end; ++each)
      {
        const std::uint8_t* const from =
          parts[entries[each].Rank].data() + entries[each].Index * size + sizeof(std::uint64_t);
        for (std::size_t i = 0; i < width; ++i)
        {
          sum[i] += LoadNumber<double>(from + i * sizeof(double));
        }
      }
      for (std::size_t each = begin; each < end; ++each)
      {
        std::memcpy(
          sums[entries[each].Rank].data() + entries[each].Index * numbers, sum.data(), numbers);
      }
    });
  return sums;
}

/// Collective: brings in what other ranks' cells have at the points of this one.
void AddOthers(
  Communicator& communicator, const DrawnCells& cells, PointSums& sums, std::string failure)
{
  const auto width = static_cast<std::size_t>(sums.Width);
  const std::size_t numbers = width * sizeof(double);
  const auto sumsAt = [&](std::int64_t point)
  { return sums.Numbers.data() + static_cast<std::size_t>(point) * width; };
  std::vector<std::int64_t> points;
  HashedQuestions questions(communicator.Size(), sizeof(std::uint64_t) + numbers);
  Attempt(failure,
    [&]
    {
      points = PointsAtEnds(cells, sums.Twins);
      for (const std::int64_t point : points)
      {
        const std::uint64_t hash = HashOfPlace(cells.Mesh.Point(point));
        std::uint8_t* const record = questions.Add(hash);
        StoreNumber(record, hash);
        std::memcpy(record + sizeof(hash), sumsAt(point), numbers);
      }
    });
  const Bytes answers = questions.Ask(
    communicator, numbers, [&](const std::vector<Bytes>& asked) { return AddUp(asked, width); },
    failure);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    std::memcpy(sumsAt(points[i]), answers.data() + i * numbers, numbers);
  }
}

/// Collective: what sums of all ranks' cells come to.
/// @param make GradientSums or MeanSums
/// @param finish GradientsOf or MeansOf
template <class Make, class Finish>
std::vector<float> FromSums(Communicator& communicator, const DrawnCells& cells,
  const std::vector<float>& values, ThreadPool& pool, const Make& make, const Finish& finish)
{
  PointSums sums;
  std::string failure;
  Attempt(failure, [&] { sums = make(cells, values, pool); });
  AddOthers(communicator, cells, sums, failure);
  std::vector<float> found;
  Collective(communicator,
    [&]
    {
      sums.GiveToTwins();
      found = finish(sums);
    });
  return found;
}

} // namespace

std::vector<float> PieceGradients(Communicator& communicator, const DrawnCells& cells,
  const std::vector<float>& values, ThreadPool& pool)
{
  return FromSums(communicator, cells, values, pool, GradientSums, GradientsOf);
}

std::vector<float> PieceMeans(Communicator& communicator, const DrawnCells& cells,
  const std::vector<float>& values, ThreadPool& pool)
{
  return FromSums(communicator, cells, values, pool, MeanSums, MeansOf);
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
