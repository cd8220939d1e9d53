// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Sampling/CellShapes.h"

#include "Base/FirstFailure.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <mutex>

namespace banyan
{
namespace
{

/// Finest edges along an axis, as a power of two: halves of them are numbered in 21 bits.
constexpr int MostLevels = 19;

/// Corners of VTK_HEXAHEDRON in the order of TrilinearCell.
constexpr std::array<int, 8> HexahedronOrder = { 0, 1, 3, 2, 4, 5, 7, 6 };
constexpr std::array<int, 8> VoxelOrder = { 0, 1, 2, 3, 4, 5, 6, 7 };

std::string CellText(std::int64_t cell)
{
  return "Cell " + std::to_string(cell);
}

/// Which corner of its bounding box each point of a cell is nearest to; false if two are at one.
bool BoxOrder(const std::array<glm::dvec3, 8>& points, std::array<int, 8>& order)
{
  glm::dvec3 low = points[0];
  glm::dvec3 high = points[0];
  for (const glm::dvec3& point : points)
  {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  unsigned seen = 0;
  for (std::size_t i = 0; i < 8; ++i)
  {
    const glm::dvec3 part = (points[i] - low) / (high - low);
    int place = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      if (part[axis] > 0.0625 && part[axis] < 0.9375)
      {
        return false;
      }
      place |= part[axis] > 0.5 ? 1 << axis : 0;
    }
    order[static_cast<std::size_t>(place)] = static_cast<int>(i);
    seen |= 1u << place;
  }
  return seen == 0xff;
}

/// The smallest height of the parallelepiped of three vectors; below 0 when they are left-handed.
double HeightOf(const glm::dmat3& edges)
{
  const double volume = glm::determinant(edges);
  const double face = std::max({ glm::length(glm::cross(edges[0], edges[1])),
    glm::length(glm::cross(edges[1], edges[2])), glm::length(glm::cross(edges[2], edges[0])) });
  return face > 0.0 ? volume / face : 0.0;
}

bool IsTangled(const TrilinearCell& shape, double middle)
{
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec3 part(corner & 1, corner >> 1 & 1, corner >> 2);
    if (glm::determinant(shape.JacobianAt(part)) * middle < 0.0)
    {
      return true;
    }
  }
  return false;
}

double Median(std::vector<double>& values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

} // namespace

CellShapes::CellShapes(const HexMesh& mesh, int refinement, ThreadPool& pool)
  : Mesh(mesh)
{
  if (mesh.CellCount < 1)
  {
    throw Error("The mesh has no cells");
  }
  const auto count = static_cast<std::size_t>(mesh.CellCount);
  this->Lows.resize(count);
  this->Highs.resize(count);
  this->Heights.resize(count);
  this->Orders.assign(count, Order::Other);
  this->FindBoxes(pool);
  this->FindOrders(pool);
  this->ChooseLattice(refinement, pool);
  this->ToLattice(pool);
}

glm::dvec3 CellShapes::PointAt(std::int64_t node) const
{
  if (this->Mesh.PointType == ScalarType::Float32)
  {
    const float* const at = static_cast<const float*>(this->Mesh.Points) + 3 * node;
    return { at[0], at[1], at[2] };
  }
  const double* const at = static_cast<const double*>(this->Mesh.Points) + 3 * node;
  return { at[0], at[1], at[2] };
}

void CellShapes::FindBoxes(ThreadPool& pool)
{
  FirstFailure failure;
  const auto look = [&](const auto* ids, std::int64_t cell)
  {
    glm::dvec3 low(0.0);
    glm::dvec3 high(0.0);
    for (int i = 0; i < 8; ++i)
    {
      const auto node = static_cast<std::int64_t>(ids[8 * cell + i]);
      if (node < 0 || node >= this->Mesh.PointCount)
      {
        failure.Report(cell, CellText(cell) + " refers to point " + std::to_string(node) +
                               ", and the mesh has " + std::to_string(this->Mesh.PointCount) +
                               " points");
        return false;
      }
      const glm::dvec3 point = this->PointAt(node);
      if (!std::isfinite(point.x + point.y + point.z))
      {
        failure.Report(cell, "A coordinate of point " + std::to_string(node) + " of cell " +
                               std::to_string(cell) + " is not finite");
        return false;
      }
      low = i == 0 ? point : glm::min(low, point);
      high = i == 0 ? point : glm::max(high, point);
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      if (!(high[axis] > low[axis]))
      {
        failure.Report(
          cell, CellText(cell) + " is flat: all of its points have the same " + "xyz"[axis]);
        return false;
      }
    }
    this->Lows[Index(cell)] = low;
    this->Highs[Index(cell)] = high;
    return true;
  };
  DispatchMesh(this->Mesh,
    [&](const auto*, const auto* ids)
    {
      ForRuns(this->Count(), pool, failure,
        [&](std::int64_t begin, std::int64_t end, int)
        {
          for (std::int64_t cell = begin; cell < end && look(ids, cell); ++cell)
          {
          }
        });
    });
}

void CellShapes::FindOrders(ThreadPool& pool)
{
  FirstFailure failure;
  ForRuns(this->Count(), pool, failure,
    [&](std::int64_t begin, std::int64_t end, int)
    {
      std::array<std::int64_t, 8> given;
      for (std::int64_t cell = begin; cell < end; ++cell)
      {
        const std::array<int, 8> order = this->OrderOf(cell, given);
        this->Orders[Index(cell)] = order == HexahedronOrder ? Order::Hexahedron
                                    : order == VoxelOrder    ? Order::Voxel
                                                             : Order::Other;
      }
    });
}

/// The origin, and coarse edges. @return how many of these the mesh takes up
glm::dvec3 CellShapes::ChooseCoarseEdges()
{
  glm::dvec3 high = this->Highs.front();
  this->LatticeOrigin = this->Lows.front();
  for (std::size_t cell = 0; cell < this->Lows.size(); ++cell)
  {
    this->LatticeOrigin = glm::min(this->LatticeOrigin, this->Lows[cell]);
    high = glm::max(high, this->Highs[cell]);
  }
  std::vector<double> extents(this->Lows.size());
  for (int axis = 0; axis < 3; ++axis)
  {
    for (std::size_t cell = 0; cell < extents.size(); ++cell)
    {
      extents[cell] = this->Highs[cell][axis] - this->Lows[cell][axis];
    }
    // A whole number of edges, so that the borders of boxes are met.
    const double length = high[axis] - this->LatticeOrigin[axis];
    this->FinestEdge[axis] = length / std::max(1.0, std::round(length / Median(extents)));
  }
  return (high - this->LatticeOrigin) / this->FinestEdge;
}

/// The heights of cells in coarse edges, and cells that are tangled.
/// @return the least height, but at most 1
double CellShapes::FindHeights(ThreadPool& pool)
{
  FirstFailure failure;
  std::mutex mutex;
  double thinnest = 1.0;
  ForRuns(this->Count(), pool, failure,
    [&](std::int64_t begin, std::int64_t end, int)
    {
      double least = 1.0;
      std::int64_t tangled = 0;
      std::int64_t first = -1;
      for (std::int64_t cell = begin; cell < end; ++cell)
      {
        const TrilinearCell shape(this->CornersOf(cell));
        const double height = HeightOf(shape.JacobianAt(glm::dvec3(0.5)));
        if (!(std::abs(height) > 1e-9))
        {
          failure.Report(cell, CellText(cell) + " has no volume: it is flat in its middle");
          return;
        }
        if (IsTangled(shape, height))
        {
          first = tangled++ == 0 ? cell : first;
        }
        this->Heights[Index(cell)] = static_cast<float>(std::abs(height));
        least = std::min(least, std::abs(height));
      }
      const std::lock_guard<std::mutex> lock(mutex);
      thinnest = std::min(thinnest, least);
      if (tangled > 0 && (this->FirstTangledCell < 0 || first < this->FirstTangledCell))
      {
        this->FirstTangledCell = first;
      }
      this->TangledCells += tangled;
    });
  return thinnest;
}

/// The lattice, and the heights of cells in its edges.
void CellShapes::ChooseLattice(int refinement, ThreadPool& pool)
{
  const glm::dvec3 coarse = this->ChooseCoarseEdges();
  const double thinnest = this->FindHeights(pool);
  const double most = std::max({ coarse.x, coarse.y, coarse.z });
  const int room = MostLevels - static_cast<int>(std::ceil(std::log2(most + 1.0)));
  if (room < 0)
  {
    throw Error(
      "The mesh is more than a million median cells long along an axis: use 'Resample To Image'");
  }
  const int wanted = refinement + static_cast<int>(std::ceil(-std::log2(thinnest)));
  const double parts = std::ldexp(1.0, std::min(room, wanted));
  this->FinestEdge /= parts;
  for (float& height : this->Heights)
  {
    height *= static_cast<float>(parts);
  }
  // A length that only rounding adds makes no cell of its own.
  this->Size = glm::ivec3(glm::ceil(coarse * parts - 1e-6));
}

void CellShapes::ToLattice(ThreadPool& pool)
{
  this->Cells.resize(this->Heights.size());
  this->Middles.resize(this->Heights.size());
  this->Hulls.resize(this->Heights.size());
  FirstFailure failure;
  ForRuns(this->Count(), pool, failure,
    [&](std::int64_t begin, std::int64_t end, int)
    {
      for (std::int64_t cell = begin; cell < end; ++cell)
      {
        this->Lows[Index(cell)] =
          (this->Lows[Index(cell)] - this->LatticeOrigin) / this->FinestEdge;
        this->Highs[Index(cell)] =
          (this->Highs[Index(cell)] - this->LatticeOrigin) / this->FinestEdge;
        const std::array<glm::dvec3, 8> corners = this->CornersOf(cell);
        const TrilinearCell shape(corners);
        this->Hulls[Index(cell)] = CellHull(corners);
        this->Cells[Index(cell)] = shape;
        Middle& middle = this->Middles[Index(cell)];
        middle.Centre = shape.At(glm::dvec3(0.5));
        middle.Inverse = glm::inverse(shape.JacobianAt(glm::dvec3(0.5)));
        const glm::dmat3 sizes(
          glm::abs(middle.Inverse[0]), glm::abs(middle.Inverse[1]), glm::abs(middle.Inverse[2]));
        middle.Reach = 0.5 + 1e-6 + sizes * shape.Bend();
        middle.PerUnit = sizes * glm::dvec3(1.0);
      }
    });
}

void CellShapes::GivenNodes(std::int64_t cell, std::array<std::int64_t, 8>& nodes) const
{
  for (std::int64_t i = 0; i < 8; ++i)
  {
    nodes[Index(i)] = this->Mesh.IdType == ScalarType::Int64
                        ? static_cast<const std::int64_t*>(this->Mesh.Connectivity)[8 * cell + i]
                        : static_cast<const std::int32_t*>(this->Mesh.Connectivity)[8 * cell + i];
  }
}

std::array<int, 8> CellShapes::OrderOf(std::int64_t cell, std::array<std::int64_t, 8>& given) const
{
  this->GivenNodes(cell, given);
  if (this->Orders[Index(cell)] != Order::Other)
  {
    return this->Orders[Index(cell)] == Order::Voxel ? VoxelOrder : HexahedronOrder;
  }
  std::array<glm::dvec3, 8> points;
  std::transform(given.begin(), given.end(), points.begin(),
    [this](std::int64_t node) { return this->PointAt(node); });
  std::array<int, 8> order;
  return BoxOrder(points, order) ? order : HexahedronOrder;
}

void CellShapes::NodesOf(std::int64_t cell, std::array<std::int64_t, 8>& nodes) const
{
  std::array<std::int64_t, 8> given;
  const std::array<int, 8> order = this->OrderOf(cell, given);
  for (std::size_t place = 0; place < 8; ++place)
  {
    nodes[place] = given[static_cast<std::size_t>(order[place])];
  }
}

/// On the lattice, in the order of TrilinearCell.
std::array<glm::dvec3, 8> CellShapes::CornersOf(std::int64_t cell) const
{
  std::array<std::int64_t, 8> nodes;
  this->NodesOf(cell, nodes);
  std::array<glm::dvec3, 8> corners;
  std::transform(nodes.begin(), nodes.end(), corners.begin(),
    [this](std::int64_t node)
    { return (this->PointAt(node) - this->LatticeOrigin) / this->FinestEdge; });
  return corners;
}

} // namespace banyan
