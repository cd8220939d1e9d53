// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/CellSeries/OrderInBox.h"

#include "Base/OrderedBits.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

/// A place with what it is sorted by.
struct Sorted
{
  std::uint64_t Key;
  std::uint32_t Number;

  friend bool operator<(const Sorted& a, const Sorted& b)
  {
    return a.Key != b.Key ? a.Key < b.Key : a.Number < b.Number;
  }
};

void SortAlong(int axis, const std::vector<glm::dvec3>& places, Sorted* first, Sorted* end)
{
  for (Sorted* one = first; one != end; ++one)
  {
    one->Key = Ordered(places[one->Number][axis]);
  }
  std::sort(first, end);
}

/// The first of n things that part p of m has.
std::size_t FirstOf(std::size_t part, std::size_t parts, std::size_t count)
{
  return count / parts * part + count % parts * part / parts;
}

} // namespace

glm::ivec3 BoxFor(const std::vector<glm::dvec3>& places)
{
  glm::dvec3 low(0.0), high(0.0);
  bool any = false;
  for (const glm::dvec3& place : places)
  {
    if (std::isfinite(place.x) && std::isfinite(place.y) && std::isfinite(place.z))
    {
      low = any ? glm::min(low, place) : place;
      high = any ? glm::max(high, place) : place;
      any = true;
    }
  }
  // As logarithms: products of lengths may be greater than any double.
  const auto count = static_cast<double>(std::max<std::size_t>(places.size(), 1));
  glm::dvec3 length(0.0);
  double sum = 0.0;
  int axes = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double apart =
      high[axis] / 2.0 - low[axis] / 2.0; // half: may be near the greatest double
    length[axis] = apart > 0.0 ? std::log(apart) : 0.0;
    axes += apart > 0.0 ? 1 : 0;
    sum += length[axis];
  }
  const double edge = axes > 0 ? (sum - std::log(count)) / axes : 0.0;
  const auto along = [&](int axis, double most)
  {
    const bool flat = !(high[axis] / 2.0 - low[axis] / 2.0 > 0.0);
    return flat
             ? 1
             : static_cast<int>(std::clamp(std::round(std::exp(length[axis] - edge)), 1.0, most));
  };
  glm::ivec3 box(1);
  box.z = along(2, count);
  box.y = along(1, std::ceil(count / box.z));
  box.x = static_cast<int>(std::ceil(std::ceil(count / box.z) / box.y));
  return box;
}

std::vector<std::uint32_t> OrderInBox(
  const std::vector<glm::dvec3>& places, const glm::ivec3& box, const glm::ivec3& image)
{
  const std::size_t count = places.size();
  std::vector<Sorted> all(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    all[i] = { 0, static_cast<std::uint32_t>(i) };
  }
  std::vector<std::uint32_t> samples(count);
  SortAlong(2, places, all.data(), all.data() + count);
  const auto slabs = static_cast<std::size_t>(box.z);
  const auto rows = static_cast<std::size_t>(box.y);
  for (std::size_t slab = 0; slab < slabs; ++slab)
  {
    Sorted* const first = all.data() + FirstOf(slab, slabs, count);
    Sorted* const end = all.data() + FirstOf(slab + 1, slabs, count);
    SortAlong(1, places, first, end);
    const auto inSlab = static_cast<std::size_t>(end - first);
    for (std::size_t row = 0; row < rows; ++row)
    {
      Sorted* const from = first + FirstOf(row, rows, inSlab);
      Sorted* const to = first + FirstOf(row + 1, rows, inSlab);
      SortAlong(0, places, from, to);
      std::size_t sample =
        (slab * static_cast<std::size_t>(image.y) + row) * static_cast<std::size_t>(image.x);
      for (const Sorted* one = from; one != to; ++one)
      {
        samples[one->Number] = static_cast<std::uint32_t>(sample++);
      }
    }
  }
  return samples;
}

} // namespace banyan
