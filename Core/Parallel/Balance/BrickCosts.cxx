// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/BrickCosts.h"

#include "Base/Error.h"

#include <algorithm>
#include <cmath>

namespace banyan
{

BrickCosts::BrickCosts(const glm::ivec3& positions, int edge)
  : Positions(glm::max(positions, glm::ivec3(0)))
  , Edge(edge)
{
  if (edge < 1)
  {
    throw Error("Bricks of costs need at least one position per axis.");
  }
  this->Values.assign(static_cast<std::size_t>(Box{ glm::ivec3(0), this->Bricks() }.Count()), 0.0);
}

Box BrickCosts::PositionsOf(std::size_t number) const
{
  const glm::ivec3 bricks = this->Bricks();
  const auto row = static_cast<int>(number / static_cast<std::size_t>(bricks.x));
  const glm::ivec3 brick(
    static_cast<int>(number % static_cast<std::size_t>(bricks.x)), row % bricks.y, row / bricks.y);
  return { brick * this->Edge, glm::min((brick + 1) * this->Edge, this->Positions) };
}

Box BrickCosts::BricksUnder(const Box& positions) const
{
  const Box inside = Intersection(positions, { glm::ivec3(0), this->Positions });
  return inside.Empty() ? Box{}
                        : Box{ inside.Lo / this->Edge, (inside.Hi + this->Edge - 1) / this->Edge };
}

void BrickCosts::Add(const Box& positions, double value, const BrickCosts* weights)
{
  const Box inside = Intersection(positions, { glm::ivec3(0), this->Positions });
  const Box bricks = this->BricksUnder(inside);
  const auto forBricks = [&](auto&& function)
  {
    for (int z = bricks.Lo.z; z < bricks.Hi.z; ++z)
    {
      for (int y = bricks.Lo.y; y < bricks.Hi.y; ++y)
      {
        for (int x = bricks.Lo.x; x < bricks.Hi.x; ++x)
        {
          const glm::ivec3 low = glm::ivec3(x, y, z) * this->Edge;
          const Box whole =
            Intersection({ low, low + this->Edge }, { glm::ivec3(0), this->Positions });
          const Box part = Intersection(whole, inside);
          function(this->NumberAt({ x, y, z }), static_cast<double>(part.Count()),
            static_cast<double>(whole.Count()));
        }
      }
    }
  };
  double sum = 0.0;
  if (weights)
  {
    forBricks([&](std::size_t number, double part, double whole)
      { sum += weights->Values[number] * part / whole; });
  }
  const bool weighted = sum > 0.0;
  sum = weighted ? sum : static_cast<double>(inside.Count());
  forBricks(
    [&](std::size_t number, double part, double whole)
    {
      const double weight = weighted ? weights->Values[number] * part / whole : part;
      this->Values[number] += value * weight / sum;
    });
}

CostSums::CostSums(const BrickCosts& costs)
  : Positions(costs.Positions)
  , Edge(costs.Edge)
{
  const glm::ivec3 bricks = costs.Bricks();
  if (costs.Values.size() != static_cast<std::size_t>(Box{ glm::ivec3(0), bricks }.Count()))
  {
    throw Error("There is not one cost for each brick.",
      { {}, {}, costs.Values.size(),
        static_cast<std::uint64_t>(Box{ glm::ivec3(0), bricks }.Count()) });
  }
  if (std::any_of(costs.Values.begin(), costs.Values.end(),
        [](double cost) { return !(cost >= 0.0) || !std::isfinite(cost); }))
  {
    throw Error("The cost of a brick is not a number, or is negative.");
  }
  this->RowLength = static_cast<std::size_t>(bricks.x) + 1;
  this->SliceLength = this->RowLength * (static_cast<std::size_t>(bricks.y) + 1);
  this->Sums.assign(this->SliceLength * (static_cast<std::size_t>(bricks.z) + 1), 0.0);
  std::size_t next = 0;
  for (int z = 0; z < bricks.z; ++z)
  {
    for (int y = 0; y < bricks.y; ++y)
    {
      double row = 0.0;
      std::size_t at = (z + 1) * this->SliceLength + (y + 1) * this->RowLength + 1;
      for (int x = 0; x < bricks.x; ++x, ++at)
      {
        row += costs.Values[next++];
        this->Sums[at] = row + this->Sums[at - this->RowLength] +
                         this->Sums[at - this->SliceLength] -
                         this->Sums[at - this->RowLength - this->SliceLength];
      }
    }
  }
}

CostSums::Place CostSums::PlaceOf(int position, int axis) const
{
  const int brick = position / this->Edge;
  const int low = brick * this->Edge;
  if (low == position)
  {
    return { static_cast<std::size_t>(brick), 0.0 };
  }
  const int end = std::min(low + this->Edge, this->Positions[axis]);
  return position >= end ? Place{ static_cast<std::size_t>(brick) + 1, 0.0 }
                         : Place{ static_cast<std::size_t>(brick),
                             static_cast<double>(position - low) / (end - low) };
}

double CostSums::Before(const Place (&place)[3]) const
{
  const std::size_t at =
    place[2].Brick * this->SliceLength + place[1].Brick * this->RowLength + place[0].Brick;
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner)
  {
    const double x = (corner & 1) ? place[0].Within : 1.0 - place[0].Within;
    const double y = (corner & 2) ? place[1].Within : 1.0 - place[1].Within;
    const double z = (corner & 4) ? place[2].Within : 1.0 - place[2].Within;
    const double part = x * y * z;
    if (part > 0.0)
    {
      sum += part * this->Sums[at + ((corner & 1) ? 1 : 0) + ((corner & 2) ? this->RowLength : 0) +
                               ((corner & 4) ? this->SliceLength : 0)];
    }
  }
  return sum;
}

double CostSums::In(const Box& box) const
{
  if (box.Empty() || this->Sums.empty())
  {
    return 0.0;
  }
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner)
  {
    Place place[3];
    int highs = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const bool high = ((corner >> axis) & 1) != 0;
      place[axis] = this->PlaceOf(high ? box.Hi[axis] : box.Lo[axis], axis);
      highs += high ? 1 : 0;
    }
    sum += ((highs & 1) != 0 ? 1.0 : -1.0) * this->Before(place);
  }
  return std::max(sum, 0.0);
}

} // namespace banyan
