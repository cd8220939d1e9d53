// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scene/ClipPlanes.h"

#include "Base/Error.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

/// Cells: rounding moves no sample this far across a plane.
constexpr double Slack = 1e-4;

bool IsFinite(const glm::dvec4& v)
{
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

} // namespace

void AddCropBox(std::vector<ClipPlane>& planes, const glm::dvec3& low, const glm::dvec3& high)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    glm::dvec3 normal(0.0);
    normal[axis] = 1.0;
    if (!(std::isinf(low[axis]) && low[axis] < 0.0))
    {
      planes.push_back({ normal, -low[axis] });
    }
    if (!(std::isinf(high[axis]) && high[axis] > 0.0))
    {
      planes.push_back({ -normal, high[axis] });
    }
  }
}

std::vector<glm::dvec4> PlanesInIndexSpace(
  const std::vector<ClipPlane>& planes, const glm::dmat4& indexToWorld)
{
  if (planes.size() > MostClipPlanes)
  {
    throw Error("There are too many clipping planes", { {}, {}, planes.size(), MostClipPlanes });
  }
  std::vector<glm::dvec4> result;
  for (std::size_t i = 0; i < planes.size(); ++i)
  {
    const glm::dvec4 plane(planes[i].Normal, planes[i].Offset);
    // Brought near 1 first, so that its square neither overflows nor vanishes.
    const double largest =
      std::max({ std::abs(plane.x), std::abs(plane.y), std::abs(plane.z), 0.0 });
    if (!IsFinite(plane) || largest == 0.0)
    {
      throw Error("Clipping plane " + std::to_string(i) +
                  " has no normal, or a normal or place that is not finite");
    }
    const glm::dvec4 inIndexSpace = (plane / largest) * indexToWorld;
    const glm::dvec4 unit = inIndexSpace / glm::length(glm::dvec3(inIndexSpace));
    if (!IsFinite(unit))
    {
      throw Error("Clipping plane " + std::to_string(i) + " lies too far away to be computed with");
    }
    result.push_back(unit);
  }
  return result;
}

bool IsCutAway(const std::vector<glm::dvec4>& planes, const Box& cells)
{
  return std::any_of(planes.begin(), planes.end(),
    [&cells](const glm::dvec4& plane)
    {
      double farthest = plane.w;
      for (int axis = 0; axis < 3; ++axis)
      {
        farthest += plane[axis] * (plane[axis] > 0.0 ? cells.Hi[axis] : cells.Lo[axis]);
      }
      return farthest < -Slack;
    });
}

} // namespace banyan
