// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/CellSeries/ImageOrder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace banyan
{
namespace
{

/// Enough to tell orders apart, whatever the size.
constexpr std::size_t MostPairs = std::size_t{ 1 } << 21;
constexpr std::size_t MostSamplesToTry = std::size_t{ 1 } << 18;
constexpr int MostComponents = 8;
/// A difference of numbers is one along an axis if it occurs that often, compared with the one
/// that occurs most: in a cube of five tetrahedra an edge along an axis occurs four times, and a
/// diagonal three times.
constexpr double ShareOfAxis = 0.8;

glm::ivec3 BoxWith(std::size_t count, std::size_t row, std::size_t rows)
{
  row = std::min(row, count);
  rows = std::min(rows, (count + row - 1) / row);
  const std::size_t slab = row * rows;
  return { static_cast<int>(row), static_cast<int>(rows),
    static_cast<int>((count + slab - 1) / slab) };
}

/// How often numbers of points in one cell differ by how much.
std::unordered_map<std::int64_t, std::int64_t> DifferencesOf(const StoredCells& mesh)
{
  std::unordered_map<std::int64_t, std::int64_t> found;
  std::size_t pairs = 0;
  for (std::size_t cell = 0; cell < mesh.Types.size() && pairs < MostPairs; ++cell)
  {
    const auto first = static_cast<std::size_t>(mesh.Offsets[cell]);
    const std::size_t size = std::min<std::size_t>(mesh.SizeOfCell(cell), 8);
    for (std::size_t i = 0; i < size; ++i)
    {
      for (std::size_t j = 0; j < i; ++j, ++pairs)
      {
        ++found[std::abs(mesh.Connectivity[first + i] - mesh.Connectivity[first + j])];
      }
    }
  }
  return found;
}

/// One component as an image; NaN where there is no value.
template <class T>
std::vector<double> ImageOf(
  const std::vector<std::uint32_t>& samples, const glm::ivec3& box, const T* values, int components)
{
  std::vector<double> image(static_cast<std::size_t>(box.x) * static_cast<std::size_t>(box.y) *
                              static_cast<std::size_t>(box.z),
    std::numeric_limits<double>::quiet_NaN());
  for (const std::uint32_t sample : samples)
  {
    image[sample] = static_cast<double>(*values);
    values += components;
  }
  return image;
}

/// Bits per value; 0 where nothing can be said.
double BitsOf(const std::vector<double>& image, const glm::ivec3& box, double bound, bool absolute)
{
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : image)
  {
    if (std::isfinite(value))
    {
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  const double range = high - low;
  if (!(range > 0.0) || !std::isfinite(range))
  {
    return 0.0;
  }
  const double asked = absolute ? bound : bound * range;
  const double step = asked > 0.0 ? asked : range / (1 << 20);
  const std::size_t strides[] = { 1, static_cast<std::size_t>(box.x),
    static_cast<std::size_t>(box.x) * static_cast<std::size_t>(box.y) };
  // Odd, so that all places in rows are looked at.
  const std::size_t apart = 2 * (image.size() / (2 * MostSamplesToTry)) + 1;
  double bits = 0.0;
  int axes = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < image.size(); i += apart)
    {
      const auto at = static_cast<int>(i / strides[axis] % static_cast<std::size_t>(box[axis]));
      if (at == 0 || at + 1 == box[axis])
      {
        continue;
      }
      const double off =
        image[i] - (image[i - strides[axis]] / 2.0 + image[i + strides[axis]] / 2.0);
      if (std::isfinite(off))
      {
        sum += std::log2(1.0 + std::abs(off) / step);
        ++count;
      }
    }
    bits += count > 0 ? sum / static_cast<double>(count) : 0.0;
    axes += count > 0 ? 1 : 0;
  }
  return axes > 0 ? bits / axes : 0.0;
}

} // namespace

std::vector<std::uint32_t> OrderOfFile(
  std::size_t count, const glm::ivec3& box, const glm::ivec3& image)
{
  std::vector<std::uint32_t> samples(count);
  const auto row = static_cast<std::size_t>(box.x), rows = static_cast<std::size_t>(box.y);
  for (std::size_t i = 0; i < count; ++i)
  {
    const std::size_t y = i / row % rows, z = i / row / rows;
    samples[i] = static_cast<std::uint32_t>(
      (z * static_cast<std::size_t>(image.y) + y) * static_cast<std::size_t>(image.x) + i % row);
  }
  return samples;
}

std::vector<glm::ivec3> BoxesOfFile(
  const StoredCells& mesh, std::size_t count, const glm::ivec3& boxOfPlaces)
{
  std::vector<glm::ivec3> boxes{ BoxWith(
    count, static_cast<std::size_t>(boxOfPlaces.x), static_cast<std::size_t>(boxOfPlaces.y)) };
  const auto differences = DifferencesOf(mesh);
  std::int64_t most = 0;
  for (const auto& one : differences)
  {
    most = one.first > 0 ? std::max(most, one.second) : most;
  }
  std::vector<std::int64_t> axes;
  for (const auto& one : differences)
  {
    if (one.first > 1 && static_cast<double>(one.second) >= ShareOfAxis * static_cast<double>(most))
    {
      axes.push_back(one.first);
    }
  }
  std::sort(axes.begin(), axes.end());
  if (axes.size() < 2 || axes[1] % axes[0] != 0)
  {
    return boxes;
  }
  const std::int64_t points = mesh.PointCount();
  const std::int64_t n[] = { axes[0], axes[1] / axes[0], (points + axes[1] - 1) / axes[1] };
  const auto things = static_cast<std::int64_t>(count);
  const std::int64_t cubes = (n[0] - 1) * (n[1] - 1) * (n[2] - 1);
  if (things == points)
  {
    boxes.push_back(BoxWith(count, static_cast<std::size_t>(n[0]), static_cast<std::size_t>(n[1])));
  }
  else if (cubes > 0 && things % cubes == 0 && n[1] > 1)
  {
    boxes.push_back(BoxWith(count, static_cast<std::size_t>((n[0] - 1) * (things / cubes)),
      static_cast<std::size_t>(n[1] - 1)));
  }
  return boxes;
}

double BitsInOrder(const std::vector<std::uint32_t>& samples, const glm::ivec3& box,
  const std::vector<ValuesToKeep>& arrays)
{
  double bits = 0.0;
  int left = MostComponents;
  for (const ValuesToKeep& array : arrays)
  {
    for (int c = 0; c < array.Components && left > 0; ++c, --left)
    {
      bits += Dispatch(array.Type,
        [&](auto tag)
        {
          using T = typename decltype(tag)::Type;
          const T* const values = static_cast<const T*>(array.Values) + c;
          return BitsOf(
            ImageOf(samples, box, values, array.Components), box, array.Bound, array.Absolute);
        });
    }
  }
  return bits;
}

} // namespace banyan
