// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_SummaryTree_h
#define banyan_Render_Bricks_SummaryTree_h

#include "Base/Box.h"
#include "Render/Bricks/BrickSource.h"
#include "Series/Grid/ValueMask.h"
#include "Series/Quantize/ValueRange.h"

#include <array>
#include <cstddef>
#include <vector>

namespace banyan
{

/// What is known of the bricks in a box together.
struct SummaryNode
{
  ValueRange Range;   ///< of all bricks
  ValueMask Mask = 0; ///< of all bricks
  bool Full = true;   ///< whether each brick has a range and a mask

  void Include(const SummaryNode& other);
};

/// Ranges and masks of boxes of bricks, each of which has twice the edge of those below: bricks
/// that cannot be seen are left out many at a time.
///
///     height  0    single bricks: the source itself knows them
///             1    boxes of 2^3 bricks; no nodes where these have fewer than 64 cells per axis
///             ..   boxes of 2^height bricks per axis
///             top  all bricks
///
/// Made in one pass over the bricks. Takes 32 bytes per 64^3 cells, and 1/7 more.
class SummaryTree
{
public:
  /// @param source must be cut by whole planes (BrickSource::IsGrid)
  explicit SummaryTree(const BrickSource& source);

  /// The cells of some bricks together.
  /// @param bricks positions; not empty
  Box CellsOf(const Box& bricks) const;
  /// Positions of the bricks that have a part in some cells.
  Box BricksIn(const Box& cells) const;

  /// A box on the way down.
  struct Place
  {
    Box Bricks; ///< positions; not empty
    Box Cells;  ///< of these bricks
    int Height = 0;
    const SummaryNode* Node = nullptr; ///< null where there is none
    bool Lowest = false;               ///< whether there is a node here and none below
  };

  /// Goes down from all bricks to single ones, front to back: no box hides one before it.
  /// @param view in index space
  /// @param state of the root; each box has a copy of that of the box around it
  /// @param visit called as bool(const Place&, State&): whether to look at what is inside
  template <class State, class Visit>
  void Descend(const Viewpoint& view, const State& state, Visit&& visit) const
  {
    if (!this->Heights.empty())
    {
      this->DescendFrom(view, static_cast<int>(this->Heights.size()) - 1, {}, state, visit);
    }
  }

  /// Calls function(part) for the up to eight parts of a box of bricks, front to back.
  /// @param edge bricks per axis of a part: at least half of what the box has
  template <class Function>
  void ForOctants(const Viewpoint& view, const Box& bricks, int edge, Function&& function) const;

private:
  /// The boxes of a height, x fastest.
  struct Level
  {
    glm::ivec3 Counts{ 0 };
    std::vector<SummaryNode> Nodes; ///< empty where there are none

    std::size_t NumberOf(const glm::ivec3& place) const
    {
      return static_cast<std::size_t>(BrickSource::NumberOf(place, this->Counts));
    }
  };

  void CutAxes(const BrickSource& source);
  void SumBricks(const BrickSource& source, int height);
  void SumNodes(int height);

  template <class State, class Visit>
  void DescendFrom(
    const Viewpoint& view, int height, const glm::ivec3& place, State state, Visit&& visit) const;

  glm::ivec3 Counts{ 0 };
  std::array<std::vector<int>, 3> Begins; ///< first cell of each brick along each axis
  std::array<std::vector<int>, 3> Ends;   ///< the cell behind its last one
  std::vector<Level> Heights;             ///< by height, bricks first; none without bricks
  int LowestNodes = -1;                   ///< height
};

template <class State, class Visit>
void SummaryTree::DescendFrom(
  const Viewpoint& view, int height, const glm::ivec3& place, State state, Visit&& visit) const
{
  const Level& level = this->Heights[static_cast<std::size_t>(height)];
  const int edge = 1 << height;
  Place here;
  here.Bricks = { place * edge, glm::min((place + 1) * edge, this->Counts) };
  here.Cells = this->CellsOf(here.Bricks);
  here.Height = height;
  here.Node = level.Nodes.empty() ? nullptr : &level.Nodes[level.NumberOf(place)];
  here.Lowest = height == this->LowestNodes;
  if (visit(here, state) && height > 0)
  {
    this->ForOctants(view, here.Bricks, edge / 2,
      [&](const Box& part)
      { this->DescendFrom(view, height - 1, part.Lo / (edge / 2), state, visit); });
  }
}

template <class Function>
void SummaryTree::ForOctants(
  const Viewpoint& view, const Box& bricks, int edge, Function&& function) const
{
  const glm::ivec3 middle = glm::min(bricks.Lo + edge, bricks.Hi) - 1;
  const int nearest = NearestOctant(view, { this->Ends[0][static_cast<std::size_t>(middle.x)],
                                            this->Ends[1][static_cast<std::size_t>(middle.y)],
                                            this->Ends[2][static_cast<std::size_t>(middle.z)] });
  for (int steps = 0; steps < 8; ++steps)
  {
    const int octant = nearest ^ steps;
    const glm::ivec3 low = bricks.Lo + edge * glm::ivec3(octant & 1, octant >> 1 & 1, octant >> 2);
    const Box part{ low, glm::min(low + edge, bricks.Hi) };
    if (!part.Empty())
    {
      function(part);
    }
  }
}

} // namespace banyan

#endif
