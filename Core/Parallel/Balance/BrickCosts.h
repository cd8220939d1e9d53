// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Balance_BrickCosts_h
#define banyan_Parallel_Balance_BrickCosts_h

#include "Base/Box.h"

#include <cstddef>
#include <vector>

namespace banyan
{

/// A number for each cubic brick of a grid of positions: what it costs to draw, or to move.
struct BrickCosts
{
  glm::ivec3 Positions{ 0 };  ///< of the zone tree's grid
  int Edge = 1;               ///< positions per brick and axis; bricks at the end may be cut off
  std::vector<double> Values; ///< x fastest, one per brick, not negative; spread evenly inside it

  BrickCosts() = default;
  /// All zero.
  BrickCosts(const glm::ivec3& positions, int edge);

  glm::ivec3 Bricks() const { return (this->Positions + this->Edge - 1) / this->Edge; }
  std::size_t NumberAt(const glm::ivec3& brick) const
  {
    const glm::ivec3 bricks = this->Bricks();
    return brick.x + bricks.x * (brick.y + static_cast<std::size_t>(bricks.y) *
                                             static_cast<std::size_t>(brick.z));
  }
  /// Positions of a brick.
  Box PositionsOf(std::size_t number) const;
  /// Bricks with a part in a box of positions.
  Box BricksUnder(const Box& positions) const;
  /// Adds a number to the bricks under a box of positions, in proportion to what it has of each.
  /// @param weights of the same bricks: in proportion to what it has of these instead, unless they
  ///        are all 0
  void Add(const Box& positions, double value, const BrickCosts* weights = nullptr);
};

/// Sums of costs over boxes of positions, each in constant time: a summed-volume table, in which
/// planes may cut bricks.
class CostSums
{
public:
  /// Throws Error when the costs do not fit their grid, or one is negative or not finite.
  explicit CostSums(const BrickCosts& costs);

  /// @param box inside the grid; empty boxes have no cost
  double In(const Box& box) const;
  double Total() const { return this->Sums.empty() ? 0.0 : this->Sums.back(); }

private:
  struct Place
  {
    std::size_t Brick;
    double Within; ///< [0, 1): part of the brick that lies before it
  };
  Place PlaceOf(int position, int axis) const;
  double Before(const Place (&place)[3]) const;

  glm::ivec3 Positions;
  int Edge;
  std::size_t RowLength = 0;
  std::size_t SliceLength = 0;
  std::vector<double> Sums; ///< of all bricks before a corner
};

} // namespace banyan

#endif
