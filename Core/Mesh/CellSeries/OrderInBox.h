// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_CellSeries_OrderInBox_h
#define banyan_Mesh_CellSeries_OrderInBox_h

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace banyan
{

/// The samples per axis of a box that holds a number of places, one each, as long along each axis
/// as they lie apart. At least 1 per axis.
glm::ivec3 BoxFor(const std::vector<glm::dvec3>& places);

/// Sorts places into a box, so that neighbours in space are neighbours there: slabs of equal counts
/// by z, in them rows of equal counts by y, in them by x. Of n places in m parts, part p has those
/// from n p / m to n (p + 1) / m (rounded down). Places that agree stand in their own order, and
/// those that are not finite in the order of their bits.
/// @param box holds all of them
/// @param image samples of the image that the box is the first corner of
/// @return the sample of each place, x fastest
std::vector<std::uint32_t> OrderInBox(
  const std::vector<glm::dvec3>& places, const glm::ivec3& box, const glm::ivec3& image);

} // namespace banyan

#endif
