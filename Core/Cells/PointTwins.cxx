// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/PointTwins.h"

#include "Base/ThreadPool.h"
#include "Cells/PlaceHash.h"

#include <algorithm>
#include <cstddef>
#include <tuple>

namespace banyan
{
namespace
{

struct HashedPoint
{
  std::uint64_t Hash;
  std::int64_t Point;
};

/// Calls function(hash, point) for the points whose hashes are in one part of all.
template <class Function>
void ForPart(
  const CellMesh& mesh, std::uint64_t part, std::uint64_t parts, const Function& function)
{
  for (std::int64_t point = 0; point < mesh.PointCount; ++point)
  {
    const std::uint64_t hash = HashOfPlace(mesh.Point(point));
    if ((hash >> 32) * parts >> 32 == part)
    {
      function(hash, point);
    }
  }
}

/// Whether hashes may have come more than once. Lower bits tell them apart: parts are made of the
/// upper ones.
class RepeatFilter
{
public:
  /// @param count of hashes
  explicit RepeatFilter(std::size_t count)
  {
    // A hash in 16 passes by chance.
    while (this->Bits.size() * 4 < count)
    {
      this->Bits.resize(2 * this->Bits.size());
    }
  }

  void Add(std::uint64_t hash)
  {
    Word& word = this->Bits[this->At(hash)];
    word.Twice |= word.Once & BitOf(hash);
    word.Once |= BitOf(hash);
  }
  bool MayRepeat(std::uint64_t hash) const
  {
    return (this->Bits[this->At(hash)].Twice & BitOf(hash)) != 0;
  }

private:
  struct Word
  {
    std::uint64_t Once = 0;
    std::uint64_t Twice = 0;
  };
  std::size_t At(std::uint64_t hash) const { return hash >> 6 & (this->Bits.size() - 1); }
  static std::uint64_t BitOf(std::uint64_t hash) { return std::uint64_t{ 1 } << (hash & 63); }

  std::vector<Word> Bits = std::vector<Word>(1);
};

/// Most points have no twin: only those that pass the filter are sorted.
std::vector<PointTwin> TwinsOfPart(const CellMesh& mesh, std::uint64_t part, std::uint64_t parts)
{
  RepeatFilter filter(static_cast<std::size_t>(mesh.PointCount) / parts);
  ForPart(mesh, part, parts, [&](std::uint64_t hash, std::int64_t) { filter.Add(hash); });
  std::vector<HashedPoint> points;
  ForPart(mesh, part, parts,
    [&](std::uint64_t hash, std::int64_t point)
    {
      if (filter.MayRepeat(hash))
      {
        points.push_back({ hash, point });
      }
    });
  std::sort(points.begin(), points.end(),
    [](const HashedPoint& a, const HashedPoint& b)
    { return std::tie(a.Hash, a.Point) < std::tie(b.Hash, b.Point); });
  std::vector<PointTwin> twins;
  for (std::size_t i = 1, first = 0; i < points.size(); ++i)
  {
    if (points[i].Hash == points[first].Hash)
    {
      twins.push_back({ points[i].Point, points[first].Point });
    }
    else
    {
      first = i;
    }
  }
  return twins;
}

} // namespace

std::vector<PointTwin> TwinsOf(const CellMesh& mesh, ThreadPool& pool)
{
  const auto width = static_cast<std::size_t>(pool.Width());
  std::vector<std::vector<PointTwin>> parts(width);
  pool.ParallelFor(static_cast<std::int64_t>(width),
    [&](std::int64_t part)
    {
      parts[static_cast<std::size_t>(part)] =
        TwinsOfPart(mesh, static_cast<std::uint64_t>(part), width);
    });
  std::vector<PointTwin> twins;
  for (const std::vector<PointTwin>& part : parts)
  {
    twins.insert(twins.end(), part.begin(), part.end());
  }
  std::sort(twins.begin(), twins.end(),
    [](const PointTwin& a, const PointTwin& b) { return a.Point < b.Point; });
  return twins;
}

std::int64_t FirstAt(const std::vector<PointTwin>& twins, std::int64_t point)
{
  const auto found = std::lower_bound(twins.begin(), twins.end(), point,
    [](const PointTwin& twin, std::int64_t number) { return twin.Point < number; });
  return found != twins.end() && found->Point == point ? found->First : point;
}

} // namespace banyan
