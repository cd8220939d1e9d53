// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Cells/PointMeans.h"

#include "Base/ThreadPool.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

namespace banyan
{
namespace
{

/// The corners that share an edge with one, and what part of the volume between these edges the
/// cell has.
struct Edges
{
  int To[3];
  double Part;
};

Edges EdgesOf(CellShape shape, int corner)
{
  switch (shape)
  {
    case CellShape::Tetrahedron:
      return { { (corner + 1) % 4, (corner + 2) % 4, (corner + 3) % 4 }, 1.0 / 6.0 };
    case CellShape::Wedge:
    {
      const int first = corner / 3 * 3;
      return { { first + (corner + 1) % 3, first + (corner + 2) % 3, (corner + 3) % 6 }, 0.5 };
    }
    case CellShape::Pyramid: // the apex has four edges: two of them cross the base
      return corner == 4 ? Edges{ { 0, 1, 2 }, 1.0 / 3.0 }
                         : Edges{ { (corner + 1) % 4, (corner + 3) % 4, 4 }, 1.0 / 3.0 };
    default:
      return { { corner ^ 1, corner ^ 2, corner ^ 4 }, 1.0 };
  }
}

/// A cell with what a sum needs of it.
struct CellInMesh
{
  std::int64_t Number = 0;
  MeshCell Cell;
  glm::dvec3 At[8]; ///< corners in index space

  /// The edges at a corner, and how large the cell is there; 0 if that cannot be said.
  glm::dmat3 TangentsAt(int corner, double& volume) const
  {
    const Edges edges = EdgesOf(this->Cell.Shape, corner);
    glm::dmat3 tangents;
    for (int i = 0; i < 3; ++i)
    {
      tangents[i] = this->At[edges.To[i]] - this->At[corner];
    }
    volume = edges.Part * std::abs(glm::determinant(tangents));
    volume = std::isfinite(volume) ? volume : 0.0;
    return tangents;
  }
};

/// Goes to the corners of all cells, in the global order at each place. A thread has some of the
/// points, and looks at all cells: nothing is added up by two threads.
/// @param function called as function(cell, corner, point), with the first point at the place
template <class Function>
void ForCorners(const DrawnCells& cells, const std::vector<PointTwin>& twins, ThreadPool& pool,
  const Function& function)
{
  std::vector<std::int64_t> firsts; // of all points; empty where each is the first
  if (!twins.empty())
  {
    firsts.resize(static_cast<std::size_t>(cells.Mesh.PointCount));
    std::iota(firsts.begin(), firsts.end(), std::int64_t{ 0 });
    for (const PointTwin& twin : twins)
    {
      firsts[static_cast<std::size_t>(twin.Point)] = twin.First;
    }
  }
  const std::int64_t parts = pool.Width();
  const std::int64_t points = cells.Mesh.PointCount;
  pool.ParallelFor(parts,
    [&](std::int64_t part)
    {
      const std::int64_t begin = points * part / parts;
      const std::int64_t end = points * (part + 1) / parts;
      CellInMesh cell;
      for (const std::uint32_t of : cells.Order)
      {
        cell.Number = of;
        cell.Cell = cells.Mesh.Cell(of);
        const int corners = CornersOf(cell.Cell.Shape);
        bool placed = false;
        for (int corner = 0; corner < corners; ++corner)
        {
          const std::int64_t number = cell.Cell.Points[static_cast<std::size_t>(corner)];
          const std::int64_t point =
            firsts.empty() ? number : firsts[static_cast<std::size_t>(number)];
          if (point < begin || point >= end)
          {
            continue;
          }
          for (int i = 0; i < corners && !placed; ++i)
          {
            cell.At[i] =
              cells.ToIndex(cells.Mesh.Point(cell.Cell.Points[static_cast<std::size_t>(i)]));
          }
          placed = true;
          function(cell, corner, point);
        }
      }
    });
}

/// @param width numbers per point
PointSums NoSums(const DrawnCells& cells, int width, ThreadPool& pool)
{
  const auto count = static_cast<std::size_t>(cells.Mesh.PointCount);
  return { width, std::vector<double>(static_cast<std::size_t>(width) * count, 0.0),
    TwinsOf(cells.Mesh, pool) };
}

} // namespace

void PointSums::GiveToTwins()
{
  for (const PointTwin& twin : this->Twins)
  {
    std::copy_n(this->Numbers.begin() + static_cast<std::ptrdiff_t>(this->Width * twin.First),
      this->Width, this->Numbers.begin() + static_cast<std::ptrdiff_t>(this->Width * twin.Point));
  }
}

PointSums GradientSums(const DrawnCells& cells, const std::vector<float>& values, ThreadPool& pool)
{
  PointSums sums = NoSums(cells, 4, pool);
  ForCorners(cells, sums.Twins, pool,
    [&](const CellInMesh& cell, int corner, std::int64_t point)
    {
      double volume = 0.0;
      const glm::dmat3 tangents = cell.TangentsAt(corner, volume);
      const Edges edges = EdgesOf(cell.Cell.Shape, corner);
      const auto valueOf = [&](int i)
      {
        return double{
          values[static_cast<std::size_t>(cell.Cell.Points[static_cast<std::size_t>(i)])]
        };
      };
      glm::dvec3 along;
      for (int i = 0; i < 3; ++i)
      {
        along[i] = valueOf(edges.To[i]) - valueOf(corner);
      }
      // Along each edge the gradient gives what the value changes by.
      const glm::dvec3 gradient = along * glm::inverse(tangents);
      if (volume > 0.0 && std::isfinite(gradient.x + gradient.y + gradient.z))
      {
        const glm::dvec4 part = volume * glm::dvec4(gradient, 1.0);
        for (int i = 0; i < 4; ++i)
        {
          sums.Numbers[static_cast<std::size_t>(4 * point + i)] += part[i];
        }
      }
    });
  sums.GiveToTwins();
  return sums;
}

std::vector<float> GradientsOf(const PointSums& sums)
{
  const std::size_t count = sums.Numbers.size() / 4;
  std::vector<float> gradients(3 * count, 0.0f);
  for (std::size_t point = 0; point < count; ++point)
  {
    const double* const sum = sums.Numbers.data() + 4 * point;
    for (std::size_t axis = 0; axis < 3 && sum[3] > 0.0; ++axis)
    {
      gradients[3 * point + axis] = static_cast<float>(sum[axis] / sum[3]);
    }
  }
  return gradients;
}

std::vector<float> PointGradients(
  const DrawnCells& cells, const std::vector<float>& values, ThreadPool& pool)
{
  return GradientsOf(GradientSums(cells, values, pool));
}

PointSums MeanSums(const DrawnCells& cells, const std::vector<float>& values, ThreadPool& pool)
{
  PointSums sums = NoSums(cells, 2, pool);
  ForCorners(cells, sums.Twins, pool,
    [&](const CellInMesh& cell, int corner, std::int64_t point)
    {
      double volume = 0.0;
      (void)cell.TangentsAt(corner, volume);
      const double value = values[static_cast<std::size_t>(cell.Number)];
      double* const sum = sums.Numbers.data() + 2 * point;
      sum[0] += volume * value;
      sum[1] += volume;
    });
  sums.GiveToTwins();
  return sums;
}

std::vector<float> MeansOf(const PointSums& sums)
{
  const std::size_t count = sums.Numbers.size() / 2;
  std::vector<float> means(count, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t point = 0; point < count; ++point)
  {
    const double* const sum = sums.Numbers.data() + 2 * point;
    if (sum[1] > 0.0)
    {
      means[point] = static_cast<float>(sum[0] / sum[1]);
    }
  }
  return means;
}

std::vector<float> PointMeans(
  const DrawnCells& cells, const std::vector<float>& values, ThreadPool& pool)
{
  return MeansOf(MeanSums(cells, values, pool));
}

} // namespace banyan
