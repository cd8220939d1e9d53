// SPDX-License-Identifier: BSD-3-Clause
#include "AnyMesh/StarShape.h"

#include "vtkPoints.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace banyan
{
namespace
{

using Faces = std::vector<std::vector<vtkIdType>>;
using Edge = std::pair<vtkIdType, vtkIdType>;

glm::dvec3 At(vtkPoints* points, vtkIdType point)
{
  glm::dvec3 at;
  points->GetPoint(point, &at.x);
  return at;
}

template <class Numbers>
glm::dvec3 MeanOf(const Numbers& numbers, vtkPoints* points)
{
  glm::dvec3 sum(0.0);
  for (const vtkIdType point : numbers)
  {
    sum += At(points, point);
  }
  return sum / static_cast<double>(numbers.size());
}

/// Calls function(from, to) for the edges of a face.
template <class Function>
void ForEdges(const std::vector<vtkIdType>& face, const Function& function)
{
  for (std::size_t i = 0; i < face.size(); ++i)
  {
    function(face[i], face[(i + 1) % face.size()]);
  }
}

/// -1 or 1 for each face, so that times it all look to one side; neighbours list their common edge
/// in opposite directions then.
std::vector<int> DirectionsOf(const Faces& faces)
{
  std::map<Edge, std::vector<std::pair<std::size_t, int>>> facesAt;
  for (std::size_t face = 0; face < faces.size(); ++face)
  {
    ForEdges(faces[face], [&](vtkIdType from, vtkIdType to)
      { facesAt[std::minmax(from, to)].emplace_back(face, from < to ? 1 : -1); });
  }
  std::vector<int> directions(faces.size(), 0);
  std::vector<std::size_t> next;
  for (std::size_t first = 0; first < faces.size(); ++first)
  {
    if (directions[first] == 0)
    {
      directions[first] = 1;
      next.push_back(first);
    }
    while (!next.empty())
    {
      const std::size_t face = next.back();
      next.pop_back();
      ForEdges(faces[face],
        [&](vtkIdType from, vtkIdType to)
        {
          const int along = from < to ? directions[face] : -directions[face];
          for (const auto& [other, listed] : facesAt[std::minmax(from, to)])
          {
            if (directions[other] == 0)
            {
              directions[other] = -along * listed;
              next.push_back(other);
            }
          }
        });
    }
  }
  return directions;
}

} // namespace

bool IsStarAroundMean(const Faces& faces, vtkPoints* points)
{
  std::set<vtkIdType> all;
  for (const std::vector<vtkIdType>& face : faces)
  {
    all.insert(face.begin(), face.end());
  }
  const glm::dvec3 middle = MeanOf(all, points);
  const std::vector<int> directions = DirectionsOf(faces);
  double least = 0.0;
  double most = 0.0;
  for (std::size_t face = 0; face < faces.size(); ++face)
  {
    const glm::dvec3 mean = MeanOf(faces[face], points) - middle;
    ForEdges(faces[face],
      [&](vtkIdType from, vtkIdType to)
      {
        const double volume =
          directions[face] *
          glm::dot(mean, glm::cross(At(points, from) - middle, At(points, to) - middle));
        least = std::min(least, volume);
        most = std::max(most, volume);
      });
  }
  // Faces that the mean lies in are seen from the side, but for rounding.
  constexpr double rounding = 1e-6;
  return std::min(-least, most) <= rounding * std::max(-least, most);
}

} // namespace banyan
