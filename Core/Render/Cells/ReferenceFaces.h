// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Cells_ReferenceFaces_h
#define banyan_Render_Cells_ReferenceFaces_h

#include "Cells/CellMesh.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace banyan
{

/// A face with a value at each corner.
struct ReferenceFace
{
  int Count = 0;
  std::array<glm::dvec3, 4> Corners{};
  std::array<double, 4> Values{};
};

/// A ray as a line: At(t) = Origin + t * Way.
struct ReferenceLine
{
  ReferenceLine(const glm::dvec3& origin, const glm::dvec3& way);

  /// The t of the nearest point of the line.
  double NearestTo(const glm::dvec3& point) const;
  /// Whether it meets a box.
  bool Meets(const glm::dvec3& low, const glm::dvec3& high) const;

  glm::dvec3 Origin;
  glm::dvec3 Way;
  glm::dvec3 Right; ///< with Up and Way at right angles
  glm::dvec3 Up;
};

/// Where a line crosses a border face.
struct FaceCrossing
{
  double At = 0.0; ///< t of the line
  int Sign = 0;    ///< 1 where the line enters the cell, -1 where it leaves
  double Value = 0.0;
};

/// Which faces of cells no other cell has, by equal places of their corners.
/// @param order numbers of cells
/// @return per cell of the order, numbers of its faces in FacesOf; none for cells without a shape
std::vector<std::vector<int>> BorderFacesOf(
  const CellMesh& mesh, const std::vector<std::uint32_t>& order);

/// Adds the crossings of a line with a face: a triangle, or a quad as four triangles around the
/// mean of its corners. Where triangles have an edge in common, one of them is crossed.
/// @param middle of the cell, which tells inside from outside
void AddCrossings(const ReferenceFace& face, const glm::dvec3& middle, const ReferenceLine& line,
  std::vector<FaceCrossing>& crossings);

} // namespace banyan

#endif
