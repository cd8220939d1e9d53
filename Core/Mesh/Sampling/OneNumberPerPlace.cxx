// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Sampling/OneNumberPerPlace.h"

#include "Base/FirstFailure.h"
#include "Base/Hash.h"
#include "Base/RadixSort.h"
#include "Base/ThreadPool.h"

#include <glm/vec3.hpp>

#include <limits>
#include <string>
#include <vector>

namespace banyan
{
namespace
{

template <class Real>
class Places
{
public:
  explicit Places(const HexMesh& mesh)
    : Points(static_cast<const Real*>(mesh.Points))
  {
  }
  glm::dvec3 At(std::uint32_t point) const
  {
    const Real* const p = this->Points + 3 * std::size_t{ point };
    // Zero has two signs, and one place.
    return glm::dvec3(p[0], p[1], p[2]) + 0.0;
  }

private:
  const Real* Points;
};

/// Gives each of the points whose keys are equal the number of the first point at its place.
template <class Real>
bool NumberRun(const Places<Real>& places, const std::uint32_t* begin, const std::uint32_t* end,
  std::vector<std::uint32_t>& numbers)
{
  bool coincide = false;
  for (const std::uint32_t* point = begin; point != end; ++point)
  {
    for (const std::uint32_t* before = begin; before != point; ++before)
    {
      // Other places with the same key are next to impossible: the first one is the right one.
      if (places.At(*before) == places.At(*point))
      {
        numbers[*point] = *before;
        coincide = true;
        break;
      }
    }
  }
  return coincide;
}

/// The first point at the place of each; empty where all have places of their own.
template <class Real>
std::vector<std::uint32_t> FirstAtPlaces(const HexMesh& mesh, ThreadPool& pool)
{
  const Places<Real> places(mesh);
  const auto count = static_cast<std::size_t>(mesh.PointCount);
  std::vector<std::uint64_t> keys(count);
  std::vector<std::uint32_t> points(count);
  FirstFailure failure;
  ForRuns(mesh.PointCount, pool, failure,
    [&](std::int64_t begin, std::int64_t end, int)
    {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
      {
        points[i] = static_cast<std::uint32_t>(i);
        const glm::dvec3 place = places.At(points[i]);
        keys[i] = HashOf(&place, sizeof(place), 0).Low;
      }
    });
  std::vector<std::uint32_t> numbers = points;
  RadixSort(keys, points, 64, pool); // equal keys stay in the order of their points
  bool coincide = false;
  for (std::size_t begin = 0, end = 0; begin < count; begin = end)
  {
    for (end = begin + 1; end < count && keys[end] == keys[begin];)
    {
      ++end;
    }
    coincide |= NumberRun(places, points.data() + begin, points.data() + end, numbers);
  }
  return coincide ? numbers : std::vector<std::uint32_t>();
}

template <class Out, class Id>
HexMesh Renumbered(const HexMesh& mesh, const Id* ids, const std::vector<std::uint32_t>& numbers)
{
  const auto corners = 8 * static_cast<std::size_t>(mesh.CellCount);
  const auto own = std::make_shared<std::vector<Out>>(corners);
  for (std::size_t i = 0; i < corners; ++i)
  {
    if (ids[i] < 0 || ids[i] >= mesh.PointCount)
    {
      throw Error("Cell " + std::to_string(i / 8) + " refers to point " + std::to_string(ids[i]) +
                  ", and the mesh has " + std::to_string(mesh.PointCount) + " points");
    }
    (*own)[i] = static_cast<Out>(numbers[static_cast<std::size_t>(ids[i])]);
  }
  HexMesh one = mesh;
  one.Connectivity = own->data();
  one.IdType = ScalarTypeOf<Out>();
  // The points may have had the same owner.
  one.PointOwner = mesh.PointOwner ? mesh.PointOwner : mesh.Owner;
  one.Owner = own;
  return one;
}

} // namespace

HexMesh OneNumberPerPlace(const HexMesh& mesh, ThreadPool& pool)
{
  if (mesh.PointCount > std::numeric_limits<std::uint32_t>::max())
  {
    return mesh;
  }
  const std::vector<std::uint32_t> numbers = mesh.PointType == ScalarType::Float32
                                               ? FirstAtPlaces<float>(mesh, pool)
                                               : FirstAtPlaces<double>(mesh, pool);
  if (numbers.empty())
  {
    return mesh;
  }
  const bool small = mesh.PointCount <= std::numeric_limits<std::int32_t>::max();
  return DispatchMesh(mesh,
    [&](const auto*, const auto* ids)
    {
      return small ? Renumbered<std::int32_t>(mesh, ids, numbers)
                   : Renumbered<std::int64_t>(mesh, ids, numbers);
    });
}

} // namespace banyan
