// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/Zones.h"

#include "Base/Error.h"
#include "Parallel/Balance/ZoneTree.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>

namespace banyan
{
namespace
{

/// The open interval of one unknown, narrowed by linear inequalities.
struct Interval
{
  double Low;
  double High = std::numeric_limits<double>::infinity();

  /// factor * x < bound
  void Below(double factor, double bound)
  {
    if (factor > 0)
    {
      this->High = std::min(this->High, bound / factor);
    }
    else if (factor < 0)
    {
      this->Low = std::max(this->Low, bound / factor);
    }
    else if (!(0 < bound))
    {
      this->High = -std::numeric_limits<double>::infinity();
    }
  }
  /// factor * x > bound
  void Above(double factor, double bound) { this->Below(-factor, -bound); }
  bool Holds(double low, double high) const
  {
    return std::max(low, this->Low) < std::min(high, this->High);
  }
};

enum class Hides
{
  Neither,
  First,
  Second,
  Both
};

/// Whether some ray meets the inside of one box before that of the other.
///
/// Perspective: a ray from the eye E meets both when E + d lies in a and E + d / u in b for some
/// u > 0, that is u * (b.Lo - E) < d < u * (b.Hi - E) and a.Lo - E < d < a.Hi - E. Per axis such a
/// d exists when the two intervals overlap, which are two linear inequalities in u; u < 1 means
/// that a comes first. Parallel: p in a and p + t * d in b, likewise linear in t; t > 0 means that
/// a comes first. For a plane between the boxes the quotients are rounded on the right side of 1
/// (or of 0), so that disjoint boxes never seem to hide each other.
Hides WhoHides(const Viewpoint& view, const Box& a, const Box& b)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const glm::dvec3 aLow(a.Lo), aHigh(a.Hi), bLow(b.Lo), bHigh(b.Hi);
  Interval interval{ view.Parallel ? -infinity : 0.0 };
  for (int axis = 0; axis < 3; ++axis)
  {
    if (view.Parallel)
    {
      interval.Below(view.Direction[axis], bHigh[axis] - aLow[axis]);
      interval.Above(view.Direction[axis], bLow[axis] - aHigh[axis]);
    }
    else
    {
      interval.Below(bLow[axis] - view.Eye[axis], aHigh[axis] - view.Eye[axis]);
      interval.Above(bHigh[axis] - view.Eye[axis], aLow[axis] - view.Eye[axis]);
    }
  }
  const double middle = view.Parallel ? 0.0 : 1.0;
  const bool low = interval.Holds(-infinity, middle);
  const bool high = interval.Holds(middle, infinity);
  if (low && high)
  {
    return Hides::Both;
  }
  const bool first = view.Parallel ? high : low;
  const bool second = view.Parallel ? low : high;
  return first ? Hides::First : (second ? Hides::Second : Hides::Neither);
}

bool Finite(const glm::dvec3& v)
{
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void CheckView(const Viewpoint& view)
{
  const glm::dvec3& used = view.Parallel ? view.Direction : view.Eye;
  if (!Finite(used) || (view.Parallel && used == glm::dvec3(0.0)))
  {
    throw Error("The camera has no position or direction that could order the data.");
  }
}

/// An arrow from each box to those that it hides.
class HidingGraph
{
public:
  /// @param drawn numbers of the boxes that are not empty
  HidingGraph(const Viewpoint& view, const std::vector<Box>& boxes, const std::vector<int>& drawn)
    : Drawn(drawn)
    , Hidden(boxes.size())
    , Hiders(boxes.size(), 0)
  {
    for (std::size_t i = 0; i < drawn.size(); ++i)
    {
      for (std::size_t j = i + 1; j < drawn.size(); ++j)
      {
        const Hides who = WhoHides(view, boxes[drawn[i]], boxes[drawn[j]]);
        if (who == Hides::First || who == Hides::Both)
        {
          this->Add(drawn[i], drawn[j]);
        }
        if (who == Hides::Second || who == Hides::Both)
        {
          this->Add(drawn[j], drawn[i]);
        }
      }
    }
  }

  /// A topological sort that takes, of all boxes that nothing hides any more, the one with the
  /// lowest number. Boxes in a circle are left out.
  std::vector<int> Sorted()
  {
    std::vector<int> order;
    std::priority_queue<int, std::vector<int>, std::greater<int>> free;
    for (const int box : this->Drawn)
    {
      if (this->Hiders[box] == 0)
      {
        free.push(box);
      }
    }
    while (!free.empty())
    {
      const int box = free.top();
      free.pop();
      order.push_back(box);
      for (const int behind : this->Hidden[box])
      {
        if (--this->Hiders[behind] == 0)
        {
          free.push(behind);
        }
      }
    }
    return order;
  }

private:
  void Add(int front, int behind)
  {
    this->Hidden[front].push_back(behind);
    ++this->Hiders[behind];
  }

  const std::vector<int>& Drawn;
  std::vector<std::vector<int>> Hidden; ///< by each box
  std::vector<int> Hiders;              ///< how many hide each box
};

} // namespace

std::vector<Box> StaticZones(const glm::ivec3& bricks, int ranks)
{
  return ZonesOf(EqualZoneTree(bricks, ranks));
}

Box CellsOfBricks(const Box& bricks, int brickCells, const glm::ivec3& allCells)
{
  return { glm::min(bricks.Lo * brickCells, allCells), glm::min(bricks.Hi * brickCells, allCells) };
}

std::vector<int> FrontToBack(const Viewpoint& view, const std::vector<Box>& boxes)
{
  CheckView(view);
  std::vector<int> drawn;
  std::vector<int> empty;
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    (boxes[i].Empty() ? empty : drawn).push_back(static_cast<int>(i));
  }
  std::vector<int> order = HidingGraph(view, boxes, drawn).Sorted();
  if (order.size() != drawn.size())
  {
    throw Error(
      "The data of " + std::to_string(drawn.size() - order.size()) +
      " ranks overlap or hide each other in a circle, so there is no order in which they could be "
      "drawn: divide the data into boxes, for example with 'Redistribute Data Set'.");
  }
  order.insert(order.end(), empty.begin(), empty.end());
  return order;
}

} // namespace banyan
