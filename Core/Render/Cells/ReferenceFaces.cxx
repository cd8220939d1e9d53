// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Cells/ReferenceFaces.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>

namespace banyan
{
namespace
{

using Place = std::array<double, 3>;

/// The places of a face's corners, the same for all cells that have it.
std::vector<Place> KeyOf(const CellMesh& mesh, const MeshCell& cell, const CellFace& face)
{
  std::vector<Place> key;
  for (int i = 0; i < face.Count; ++i)
  {
    const int corner = face.Corners[static_cast<std::size_t>(i)];
    const glm::dvec3 p = mesh.Point(cell.Points[static_cast<std::size_t>(corner)]);
    key.push_back({ p.x, p.y, p.z });
  }
  std::sort(key.begin(), key.end());
  return key;
}

double Cross(const glm::dvec2& a, const glm::dvec2& b)
{
  return a.x * b.y - a.y * b.x;
}

/// On which side of an edge the origin is: never on the edge, and the opposite of what (b, a)
/// gives.
bool IsLeftOf(const glm::dvec2& a, const glm::dvec2& b)
{
  const bool inOrder = a.x < b.x || (a.x == b.x && a.y < b.y);
  return inOrder ? Cross(a, b) >= 0.0 : !(Cross(b, a) >= 0.0);
}

struct Corner
{
  glm::dvec3 Position;
  double Value;
};

/// @param outward 1 where the corners go against the clock seen from outside, -1 otherwise
void AddCrossing(const std::array<Corner, 3>& corners, double outward, const ReferenceLine& line,
  std::vector<FaceCrossing>& crossings)
{
  // Across the line, which goes through the origin there.
  std::array<glm::dvec2, 3> flat;
  for (std::size_t i = 0; i < 3; ++i)
  {
    const glm::dvec3 from = corners[i].Position - line.Origin;
    flat[i] = { glm::dot(from, line.Right), glm::dot(from, line.Up) };
  }
  const bool left = IsLeftOf(flat[0], flat[1]);
  if (IsLeftOf(flat[1], flat[2]) != left || IsLeftOf(flat[2], flat[0]) != left)
  {
    return;
  }
  const std::array<double, 3> parts{ Cross(flat[1], flat[2]), Cross(flat[2], flat[0]),
    Cross(flat[0], flat[1]) };
  const double sum = parts[0] + parts[1] + parts[2];
  const glm::dvec3 normal = glm::cross(
    corners[1].Position - corners[0].Position, corners[2].Position - corners[0].Position);
  const double side = -outward * glm::dot(normal, line.Way);
  if (sum == 0.0 || side == 0.0 || !std::isfinite(side))
  {
    return;
  }
  FaceCrossing crossing;
  glm::dvec3 position(0.0);
  for (std::size_t i = 0; i < 3; ++i)
  {
    position += parts[i] / sum * corners[i].Position;
    crossing.Value += parts[i] / sum * corners[i].Value;
  }
  crossing.At = line.NearestTo(position);
  crossing.Sign = side > 0.0 ? 1 : -1;
  crossings.push_back(crossing);
}

} // namespace

ReferenceLine::ReferenceLine(const glm::dvec3& origin, const glm::dvec3& way)
  : Origin(origin)
  , Way(way)
{
  const glm::dvec3 size = glm::abs(way);
  const glm::dvec3 other = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
                           : size.y <= size.z                   ? glm::dvec3(0, 1, 0)
                                                                : glm::dvec3(0, 0, 1);
  this->Right = glm::normalize(glm::cross(other, way));
  this->Up = glm::normalize(glm::cross(way, this->Right));
}

double ReferenceLine::NearestTo(const glm::dvec3& point) const
{
  return glm::dot(point - this->Origin, this->Way) / glm::dot(this->Way, this->Way);
}

bool ReferenceLine::Meets(const glm::dvec3& low, const glm::dvec3& high) const
{
  double enter = -std::numeric_limits<double>::infinity();
  double exit = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis)
  {
    if (this->Way[axis] == 0.0)
    {
      if (this->Origin[axis] < low[axis] || this->Origin[axis] > high[axis])
      {
        return false;
      }
      continue;
    }
    const double a = (low[axis] - this->Origin[axis]) / this->Way[axis];
    const double b = (high[axis] - this->Origin[axis]) / this->Way[axis];
    enter = std::max(enter, std::min(a, b));
    exit = std::min(exit, std::max(a, b));
  }
  return enter <= exit;
}

std::vector<std::vector<int>> BorderFacesOf(
  const CellMesh& mesh, const std::vector<std::uint32_t>& order)
{
  std::map<std::vector<Place>, int> owners;
  const auto forAllFaces = [&](const auto& action)
  {
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      const MeshCell cell = mesh.Cell(order[i]);
      const CellFaces& faces = FacesOf(cell.Shape);
      for (int face = 0; face < faces.Count; ++face)
      {
        action(i, face, KeyOf(mesh, cell, faces.Faces[static_cast<std::size_t>(face)]));
      }
    }
  };
  forAllFaces([&](std::size_t, int, const std::vector<Place>& key) { ++owners[key]; });
  std::vector<std::vector<int>> border(order.size());
  forAllFaces(
    [&](std::size_t i, int face, const std::vector<Place>& key)
    {
      if (owners[key] == 1)
      {
        border[i].push_back(face);
      }
    });
  return border;
}

void AddCrossings(const ReferenceFace& face, const glm::dvec3& middle, const ReferenceLine& line,
  std::vector<FaceCrossing>& crossings)
{
  std::vector<Corner> corners;
  Corner mean{ glm::dvec3(0.0), 0.0 };
  for (std::size_t i = 0; i < static_cast<std::size_t>(face.Count); ++i)
  {
    corners.push_back({ face.Corners[i], face.Values[i] });
    mean.Position += face.Corners[i] / static_cast<double>(face.Count);
    mean.Value += face.Values[i] / face.Count;
  }
  // The face as a whole tells its sides apart: parts of strongly bent ones may look the other way.
  const glm::dvec3 normal =
    face.Count == 4
      ? glm::cross(face.Corners[2] - face.Corners[0], face.Corners[3] - face.Corners[1])
      : glm::cross(face.Corners[1] - face.Corners[0], face.Corners[2] - face.Corners[0]);
  const double outward = glm::dot(normal, mean.Position - middle) < 0.0 ? -1.0 : 1.0;
  if (face.Count == 3)
  {
    AddCrossing({ corners[0], corners[1], corners[2] }, outward, line, crossings);
    return;
  }
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    AddCrossing({ corners[i], corners[(i + 1) % corners.size()], mean }, outward, line, crossings);
  }
}

} // namespace banyan
