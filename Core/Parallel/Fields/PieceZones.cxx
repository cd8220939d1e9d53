// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/PieceZones.h"

#include "Base/Error.h"

#include <algorithm>
#include <cstdlib>
#include <tuple>

namespace banyan
{
namespace
{

/// A rank and the box around what it has in a zone; empty for nothing.
struct Member
{
  int Rank = 0;
  Box Hull;
};

struct Division
{
  int Axis = 0;
  int Plane = 0;
  std::vector<Member> Below;
  std::vector<Member> Above;
};

int LongestAxis(const glm::ivec3& size)
{
  int axis = 2;
  for (int other = 1; other >= 0; --other)
  {
    axis = size[other] > size[axis] ? other : axis;
  }
  return axis;
}

/// Returns the shares of members in a part of the zone.
std::vector<Member> Inside(const Box& part, std::vector<Member> members)
{
  for (Member& member : members)
  {
    const Box hull = Intersection(member.Hull, part);
    member.Hull = hull.Empty() ? Box{} : hull;
  }
  return members;
}

class Builder
{
public:
  /// Gives `zone` to the members.
  /// @param room the zone, or for an empty one a zone that it might have: says which axis is long
  int Split(const Box& zone, const Box& room, const std::vector<Member>& members)
  {
    const int number = static_cast<int>(this->Made.Tree.Nodes.size());
    this->Made.Tree.Nodes.emplace_back();
    this->Made.Tree.Nodes.back().FirstRank = static_cast<int>(this->Made.RankOfSeat.size());
    this->Made.Tree.Nodes.back().Ranks = static_cast<int>(members.size());
    if (members.size() == 1)
    {
      this->Made.RankOfSeat.push_back(members.front().Rank);
      return number;
    }
    const Division division = this->Divide(zone, room, members);
    Box low = zone;
    Box high = zone;
    low.Hi[division.Axis] = high.Lo[division.Axis] = division.Plane;
    Box lowRoom = room;
    Box highRoom = room;
    const auto part = static_cast<std::int64_t>(division.Below.size());
    lowRoom.Hi[division.Axis] = highRoom.Lo[division.Axis] =
      room.Lo[division.Axis] + static_cast<int>(room.Size()[division.Axis] * part /
                                                static_cast<std::int64_t>(members.size()));
    const bool oneIsEmpty = low.Empty() || high.Empty();
    const int below = this->Split(low, oneIsEmpty ? lowRoom : low, Inside(low, division.Below));
    const int above = this->Split(high, oneIsEmpty ? highRoom : high, Inside(high, division.Above));
    ZoneTree::Node& node = this->Made.Tree.Nodes[static_cast<std::size_t>(number)];
    node.Axis = division.Axis;
    node.Plane = division.Plane;
    node.Below = below;
    node.Above = above;
    return number;
  }

  ZonesOfRanks Made;

private:
  Division Divide(const Box& zone, const Box& room, const std::vector<Member>& members) const
  {
    std::vector<Member> holders;
    std::vector<Member> idle;
    for (const Member& member : members)
    {
      (member.Hull.Empty() ? idle : holders).push_back(member);
    }
    Division division;
    if (holders.size() < 2)
    {
      // Everything to one side, with as many ranks as to the other.
      division.Axis = LongestAxis(room.Size());
      division.Plane = zone.Hi[division.Axis];
      division.Below = holders;
    }
    else
    {
      division = this->DivideHolders(zone, holders);
    }
    this->ShareIdle(zone, idle, division);
    return division;
  }

  /// The plane that cuts the fewest pieces, and divides the ranks most evenly.
  Division DivideHolders(const Box& zone, const std::vector<Member>& holders) const
  {
    using Quality = std::tuple<int, int, int>; // pieces cut, unevenness, shortness of the axis
    Quality best{ INT32_MAX, 0, 0 };
    int bestAxis = 0;
    int bestPlane = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      for (const Member& holder : holders)
      {
        for (const int plane : { holder.Hull.Lo[axis], holder.Hull.Hi[axis] })
        {
          int cut = 0;
          int below = 0;
          int above = 0;
          for (const Member& other : holders)
          {
            const bool isBelow = other.Hull.Hi[axis] <= plane;
            const bool isAbove = other.Hull.Lo[axis] >= plane;
            below += isBelow ? 1 : 0;
            above += isAbove ? 1 : 0;
            cut += isBelow || isAbove ? 0 : 1;
          }
          const Quality quality{ cut, std::abs(below - above), -zone.Size()[axis] };
          if (below + cut > 0 && above + cut > 0 && std::max(below, above) < Count(holders) &&
              quality < best)
          {
            best = quality;
            bestAxis = axis;
            bestPlane = plane;
          }
        }
      }
    }
    if (std::get<0>(best) == INT32_MAX)
    {
      // The same box on several ranks: the first one draws it.
      Division division;
      division.Axis = LongestAxis(zone.Size());
      division.Plane = zone.Hi[division.Axis];
      division.Below.assign(holders.begin(), holders.begin() + 1);
      division.Above.assign(holders.begin() + 1, holders.end());
      return division;
    }
    return this->SideOf(holders, bestAxis, bestPlane);
  }

  /// Ranks whose pieces a plane cuts go to the side with fewer ranks.
  Division SideOf(const std::vector<Member>& holders, int axis, int plane) const
  {
    Division division;
    division.Axis = axis;
    division.Plane = plane;
    std::vector<Member> between;
    for (const Member& holder : holders)
    {
      const bool isBelow = holder.Hull.Hi[axis] <= plane;
      const bool isAbove = holder.Hull.Lo[axis] >= plane;
      (isBelow ? division.Below : isAbove ? division.Above : between).push_back(holder);
    }
    for (const Member& holder : between)
    {
      (division.Below.size() <= division.Above.size() ? division.Below : division.Above)
        .push_back(holder);
    }
    return division;
  }

  /// Ranks without data go where a rank has most; at least one rank is on each side.
  void ShareIdle(const Box& zone, const std::vector<Member>& idle, Division& division) const
  {
    Box low = zone;
    low.Hi[division.Axis] = division.Plane;
    const double whole = static_cast<double>(std::max<std::int64_t>(zone.Count(), 1));
    const double part = low.Empty() ? 0.0 : static_cast<double>(low.Count()) / whole;
    const bool cut = part > 0.0 && part < 1.0;
    for (const Member& member : idle)
    {
      const double below = static_cast<double>(division.Below.size() + 1) / (cut ? part : 0.5);
      const double above =
        static_cast<double>(division.Above.size() + 1) / (cut ? 1.0 - part : 0.5);
      (below <= above ? division.Below : division.Above).push_back(member);
    }
  }

  static int Count(const std::vector<Member>& members) { return static_cast<int>(members.size()); }
};

} // namespace

ZonesOfRanks ZonesOfPieces(const PieceGrid& grid, const glm::ivec3& cells)
{
  if (grid.Ranks() < 1)
  {
    throw Error("Zones need at least one rank.");
  }
  Builder builder;
  std::vector<Member> members;
  for (int rank = 0; rank < grid.Ranks(); ++rank)
  {
    members.push_back({ rank, Box{} });
  }
  for (const PieceGrid::Holding& holding : grid.Holdings())
  {
    Box& hull = members[static_cast<std::size_t>(holding.Rank)].Hull;
    hull = Union(hull, holding.Cells);
  }
  builder.Made.Tree.Positions = cells;
  builder.Split(builder.Made.Tree.Whole(), builder.Made.Tree.Whole(), members);
  return builder.Made;
}

} // namespace banyan
