// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Sampling_BlockPoints_h
#define banyan_Mesh_Sampling_BlockPoints_h

#include "Mesh/Sampling/PlaceInCell.h"

#include <vector>

namespace banyan
{

/// The points of the cubes in a block of 8 x 8 x 8, each looked for once. Whether one lies in the
/// mesh is found out sooner than where the nearest cell is, which takes longer and is needed of
/// few.
class BlockPoints
{
public:
  static constexpr int Levels = 3;

  explicit BlockPoints(const CellShapes& shapes)
    : Shapes(shapes)
  {
    this->Places.resize(Across * Across * Across);
  }

  /// @param first halves of cubes' edges from the origin to the block
  void Begin(const glm::ivec3& first, int level)
  {
    this->First = first;
    this->Half = 0.5 * (1 << level);
    this->Places.assign(this->Places.size(), {});
  }

  bool Inside(const glm::ivec3& halves, const CellList& cells)
  {
    PlaceInCell& place = this->Of(halves);
    if (place.Cell == Unknown)
    {
      place = FindInside(this->Shapes, cells, this->Half * glm::dvec3(halves));
      place.Cell = place.Inside ? place.Cell : Outside;
    }
    return place.Inside;
  }

  const PlaceInCell* At(const glm::ivec3& halves, const CellList& cells)
  {
    PlaceInCell& place = this->Of(halves);
    if (!this->Inside(halves, cells) && place.Cell == Outside)
    {
      place = FindNearest(this->Shapes, cells, this->Half * glm::dvec3(halves));
    }
    return &place;
  }

private:
  static constexpr std::int64_t Unknown = -1;
  static constexpr std::int64_t Outside = -2; ///< and the nearest cell is not known

  PlaceInCell& Of(const glm::ivec3& halves)
  {
    const glm::ivec3 in = halves - this->First;
    return this->Places[static_cast<std::size_t>(in.x + Across * (in.y + Across * in.z))];
  }

  static constexpr int Across = (2 << Levels) + 1;
  const CellShapes& Shapes;
  glm::ivec3 First{ 0 };
  double Half = 0.5;
  std::vector<PlaceInCell> Places;
};

} // namespace banyan

#endif
