// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/CellMeshes.h"

#include "Cells/CellParts.h"

#include "Render/Scenes.h"

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace cellmeshes
{

using banyan::CellMesh;
using banyan::CellShape;

namespace
{

/// Coordinates from 0 to 1 with edges of uneven length.
std::vector<double> UnevenAxis(int cells, double uneven, Numbers& numbers)
{
  std::vector<double> axis{ 0.0 };
  for (int i = 0; i < cells; ++i)
  {
    axis.push_back(axis.back() + std::pow(uneven, numbers.Between(0.0, 1.0)));
  }
  const double length = axis.back();
  for (double& coordinate : axis)
  {
    coordinate /= length;
  }
  return axis;
}

/// The corners of a cell as a mirrored cell in the same place has them.
std::vector<int> MirroredOrder(std::uint8_t type)
{
  switch (type)
  {
    case Tetrahedron:
      return { 1, 0, 2, 3 };
    case Wedge:
      return { 3, 4, 5, 0, 1, 2 };
    case Pyramid:
      return { 0, 3, 2, 1, 4 };
    default: // lower and upper face
      return { 4, 5, 6, 7, 0, 1, 2, 3 };
  }
}

/// A shuffled row of numbers.
std::vector<std::int64_t> Permutation(std::int64_t count, Numbers& numbers)
{
  std::vector<std::int64_t> row(Index(count));
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = row.size(); i > 1; --i)
  {
    std::swap(row[i - 1], row[numbers.Below(i)]);
  }
  return row;
}

/// Applies a function to all points of a mesh that is no rectilinear grid.
template <class Function>
void ChangePoints(OwnedCellMesh& mesh, const Function& function)
{
  for (std::int64_t i = 0; i < mesh.PointCount(); ++i)
  {
    const glm::dvec3 p = function(PointOf(mesh, i));
    for (int axis = 0; axis < 3; ++axis)
    {
      if (mesh.Points.empty())
      {
        mesh.FloatPoints[Index(3 * i + axis)] = static_cast<float>(p[axis]);
      }
      else
      {
        mesh.Points[Index(3 * i + axis)] = p[axis];
      }
    }
  }
}

} // namespace

std::uint64_t Numbers::Next()
{
  this->State += 0x9e3779b97f4a7c15ull;
  std::uint64_t z = this->State;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

double Numbers::Between(double low, double high)
{
  return low + (high - low) * (static_cast<double>(this->Next() >> 11) * 0x1p-53);
}

std::uint64_t Numbers::Below(std::uint64_t count)
{
  return this->Next() % count;
}

std::int64_t OwnedCellMesh::PointCount() const
{
  if (this->Is != CellMesh::Kind::Cells)
  {
    return std::int64_t{ this->Size.x } * this->Size.y * this->Size.z;
  }
  return static_cast<std::int64_t>((this->Points.size() + this->FloatPoints.size()) / 3);
}

std::int64_t OwnedCellMesh::CellCount() const
{
  return this->Is == CellMesh::Kind::Cells
           ? static_cast<std::int64_t>(this->Types.size())
           : std::int64_t{ this->Size.x - 1 } * (this->Size.y - 1) * (this->Size.z - 1);
}

CellMesh OwnedCellMesh::View() const
{
  CellMesh view;
  view.Is = this->Is;
  const bool isFloat = this->Points.empty();
  view.PointType = isFloat ? banyan::ScalarType::Float32 : banyan::ScalarType::Float64;
  view.PointCount = this->PointCount();
  view.CellCount = this->CellCount();
  view.Size = this->Size;
  if (this->Is == CellMesh::Kind::Rectilinear)
  {
    std::int64_t first = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      view.Axes[Index(axis)] = isFloat ? static_cast<const void*>(this->FloatPoints.data() + first)
                                       : this->Points.data() + first;
      first += this->Size[axis];
    }
    return view;
  }
  view.Points = isFloat ? static_cast<const void*>(this->FloatPoints.data()) : this->Points.data();
  view.Connectivity = this->Ids.data();
  view.ConnectivityCount = static_cast<std::int64_t>(this->Ids.size());
  view.Offsets = this->Offsets.data();
  view.Types = this->Types.data();
  return view;
}

std::function<double(std::int64_t)> OwnedCellMesh::ValueOfPoint() const
{
  return [this](std::int64_t point) { return static_cast<double>(this->Values[Index(point)]); };
}

std::vector<std::uint32_t> OwnedCellMesh::Order() const
{
  std::vector<std::uint32_t> order(Index(this->CellCount()));
  std::iota(order.begin(), order.end(), 0u);
  return order;
}

void OwnedCellMesh::AddCell(std::uint8_t type, const std::vector<std::int64_t>& corners)
{
  if (this->Offsets.empty())
  {
    this->Offsets.push_back(0);
  }
  this->Types.push_back(type);
  this->Ids.insert(this->Ids.end(), corners.begin(), corners.end());
  this->Offsets.push_back(static_cast<std::int64_t>(this->Ids.size()));
}

void SetValues(OwnedCellMesh& mesh, const Field& field)
{
  const CellMesh view = mesh.View();
  mesh.Values.resize(Index(view.PointCount));
  for (std::int64_t i = 0; i < view.PointCount; ++i)
  {
    mesh.Values[Index(i)] = static_cast<float>(field(view.Point(i)));
  }
}

Field LinearField(const glm::dvec3& slope, double value)
{
  return [=](const glm::dvec3& p) { return glm::dot(slope, p) + value; };
}

Field StandardField()
{
  return scenes::Standard;
}

OwnedCellMesh Sector(const glm::ivec3& cells, double inner, double angle)
{
  OwnedCellMesh mesh;
  mesh.Is = CellMesh::Kind::Curvilinear;
  mesh.Size = cells + 1;
  for (int z = 0; z <= cells.z; ++z)
  {
    for (int y = 0; y <= cells.y; ++y)
    {
      for (int x = 0; x <= cells.x; ++x)
      {
        const double radius = inner + (1.0 - inner) * x / cells.x;
        const double phi = angle * y / cells.y;
        AddPoint(mesh, { radius * std::cos(phi), radius * std::sin(phi), double(z) / cells.z });
      }
    }
  }
  return mesh;
}

OwnedCellMesh Rectilinear(const glm::ivec3& cells, double uneven, std::uint64_t seed)
{
  OwnedCellMesh mesh;
  mesh.Is = CellMesh::Kind::Rectilinear;
  mesh.Size = cells + 1;
  Numbers numbers(seed);
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::vector<double> row = UnevenAxis(cells[axis], uneven, numbers);
    mesh.Points.insert(mesh.Points.end(), row.begin(), row.end());
  }
  return mesh;
}

OwnedCellMesh OneCell(CellShape shape)
{
  OwnedCellMesh mesh;
  for (int i = 0; i < 8; ++i)
  {
    AddPoint(mesh, { i & 1, i >> 1 & 1, i >> 2 });
  }
  AddPoint(mesh, { 0.5, 0.5, 1.0 });
  switch (shape)
  {
    case CellShape::Tetrahedron:
      mesh.AddCell(Tetrahedron, { 0, 1, 2, 4 });
      break;
    case CellShape::Pyramid:
      mesh.AddCell(Pyramid, { 0, 1, 3, 2, 8 });
      break;
    case CellShape::Wedge:
      mesh.AddCell(Wedge, { 0, 2, 1, 4, 6, 5 });
      break;
    default:
      mesh.AddCell(Hexahedron, { 0, 1, 3, 2, 4, 5, 7, 6 });
  }
  return mesh;
}

OwnedCellMesh FoldedCell()
{
  OwnedCellMesh mesh = OneCell(CellShape::Hexahedron);
  for (int axis = 0; axis < 3; ++axis)
  {
    mesh.Points[Index(3 * 7 + axis)] = 0.3;
  }
  return mesh;
}

OwnedCellMesh AsCells(const OwnedCellMesh& grid)
{
  OwnedCellMesh mesh;
  const CellMesh view = grid.View();
  for (std::int64_t i = 0; i < view.PointCount; ++i)
  {
    AddPoint(mesh, view.Point(i));
  }
  for (std::int64_t i = 0; i < view.CellCount; ++i)
  {
    mesh.AddCell(Hexahedron, AsVtkHexahedron(view.Cell(i).Points));
  }
  mesh.Values = grid.Values;
  return mesh;
}

void Append(OwnedCellMesh& mesh, const OwnedCellMesh& other)
{
  const std::int64_t first = mesh.PointCount();
  mesh.Points.insert(mesh.Points.end(), other.Points.begin(), other.Points.end());
  mesh.Values.insert(mesh.Values.end(), other.Values.begin(), other.Values.end());
  for (std::int64_t cell = 0; cell < other.CellCount(); ++cell)
  {
    std::vector<std::int64_t> corners;
    for (std::int64_t i = other.Offsets[Index(cell)]; i < other.Offsets[Index(cell + 1)]; ++i)
    {
      corners.push_back(first + other.Ids[Index(i)]);
    }
    mesh.AddCell(other.Types[Index(cell)], corners);
  }
}

void MirrorCells(OwnedCellMesh& mesh)
{
  for (std::int64_t cell = 0; cell < mesh.CellCount(); ++cell)
  {
    const std::vector<int> order = MirroredOrder(mesh.Types[Index(cell)]);
    std::vector<std::int64_t> ids;
    const std::int64_t first = mesh.Offsets[Index(cell)];
    for (const int i : order)
    {
      ids.push_back(mesh.Ids[Index(first + i)]);
    }
    std::copy(ids.begin(), ids.end(), mesh.Ids.begin() + first);
  }
}

void Shuffle(OwnedCellMesh& mesh, std::uint64_t seed)
{
  Numbers numbers(seed);
  const std::vector<std::int64_t> places = Permutation(mesh.PointCount(), numbers);
  const std::vector<std::int64_t> cells = Permutation(mesh.CellCount(), numbers);
  const OwnedCellMesh old = mesh;
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    const std::size_t to = Index(places[i]);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      (mesh.Points.empty() ? void(mesh.FloatPoints[3 * to + axis] = old.FloatPoints[3 * i + axis])
                           : void(mesh.Points[3 * to + axis] = old.Points[3 * i + axis]));
    }
    if (!old.Values.empty())
    {
      mesh.Values[to] = old.Values[i];
    }
  }
  mesh.Ids.clear();
  mesh.Types.clear();
  mesh.Offsets.clear();
  for (const std::int64_t cell : cells)
  {
    std::vector<std::int64_t> ids;
    for (std::int64_t i = old.Offsets[Index(cell)]; i < old.Offsets[Index(cell + 1)]; ++i)
    {
      ids.push_back(places[Index(old.Ids[Index(i)])]);
    }
    mesh.AddCell(old.Types[Index(cell)], ids);
  }
}

void SeparatePoints(OwnedCellMesh& mesh)
{
  const OwnedCellMesh old = mesh;
  mesh.Points.clear();
  mesh.FloatPoints.clear();
  mesh.Values.clear();
  for (std::size_t i = 0; i < old.Ids.size(); ++i)
  {
    const std::size_t from = Index(old.Ids[i]);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      old.Points.empty() ? mesh.FloatPoints.push_back(old.FloatPoints[3 * from + axis])
                         : mesh.Points.push_back(old.Points[3 * from + axis]);
    }
    if (!old.Values.empty())
    {
      mesh.Values.push_back(old.Values[from]);
    }
    mesh.Ids[i] = static_cast<std::int64_t>(i);
  }
}

void Place(OwnedCellMesh& mesh, const glm::dvec3& factor, const glm::dvec3& offset)
{
  if (mesh.Is != CellMesh::Kind::Rectilinear)
  {
    ChangePoints(mesh, [&](const glm::dvec3& p) { return p * factor + offset; });
    return;
  }
  std::size_t i = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int end = static_cast<int>(i) + mesh.Size[axis]; i < Index(end); ++i)
    {
      const double old = mesh.Points.empty() ? mesh.FloatPoints[i] : mesh.Points[i];
      const double value = old * factor[axis] + offset[axis];
      (mesh.Points.empty() ? void(mesh.FloatPoints[i] = static_cast<float>(value))
                           : void(mesh.Points[i] = value));
    }
  }
}

void Turn(OwnedCellMesh& mesh, const glm::dvec3& axis, double angle)
{
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), angle, axis);
  ChangePoints(mesh, [&](const glm::dvec3& p) { return glm::dvec3(turn * glm::dvec4(p, 1.0)); });
}

void RoundPoints(OwnedCellMesh& mesh)
{
  mesh.FloatPoints.reserve(mesh.Points.size());
  for (const double coordinate : mesh.Points)
  {
    mesh.FloatPoints.push_back(static_cast<float>(coordinate));
  }
  mesh.Points = {};
}

} // namespace cellmeshes
