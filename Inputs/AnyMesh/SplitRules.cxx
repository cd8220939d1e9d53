// SPDX-License-Identifier: BSD-3-Clause
#include "AnyMesh/SplitRules.h"

#include "vtkCell.h"
#include "vtkCellType.h"
#include "vtkGenericCell.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace banyan
{
namespace
{

using Place = std::array<double, 3>;

/// Ends and middle of an edge.
constexpr std::array<double, 3> Ends{ 0.0, 0.5, 1.0 };

vtkSmartPointer<vtkCell> CellOfType(int type)
{
  return vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(type));
}

/// The weights of a cell's points at a place in it.
SplitRule::Node WeightsAt(vtkCell* cell, const Place& place)
{
  // Those of points that do not count there come out as 0, or as rounding.
  constexpr double nothing = 1e-12;
  std::vector<double> weights(static_cast<std::size_t>(cell->GetNumberOfPoints()));
  cell->InterpolateFunctions(place.data(), weights.data());
  SplitRule::Node node;
  for (std::size_t point = 0; point < weights.size(); ++point)
  {
    if (std::abs(weights[point]) > nothing)
    {
      node.emplace_back(static_cast<int>(point), weights[point]);
    }
  }
  return node;
}

/// The cell's own point at a place, or weights.
SplitRule::Node NodeAt(vtkCell* cell, const Place& place)
{
  const double* const own = cell->GetParametricCoords();
  for (int point = 0; point < cell->GetNumberOfPoints(); ++point)
  {
    if (std::equal(place.begin(), place.end(), own + 3 * point))
    {
      return { { point, 1.0 } };
    }
  }
  return WeightsAt(cell, place);
}

SplitRule RuleOfHexahedron(int type)
{
  const auto cell = CellOfType(type);
  SplitRule rule;
  rule.PointCount = static_cast<int>(cell->GetNumberOfPoints());
  for (const double z : Ends)
  {
    for (const double y : Ends)
    {
      for (const double x : Ends)
      {
        rule.Nodes.push_back(NodeAt(cell, { x, y, z }));
      }
    }
  }
  for (int part = 0; part < 8; ++part)
  {
    const int low = (part & 1) + 3 * (part >> 1 & 1) + 9 * (part >> 2);
    rule.Parts.push_back({ VTK_HEXAHEDRON,
      { low, low + 1, low + 4, low + 3, low + 9, low + 10, low + 13, low + 12 } });
  }
  return rule;
}

SplitRule RuleOfWedge(int type)
{
  const auto cell = CellOfType(type);
  SplitRule rule;
  rule.PointCount = static_cast<int>(cell->GetNumberOfPoints());
  // Corners of the triangle, then the middles of its sides from 0 to 1, 1 to 2, 2 to 0.
  static constexpr double triangle[6][2] = { { 0, 0 }, { 1, 0 }, { 0, 1 }, { 0.5, 0 }, { 0.5, 0.5 },
    { 0, 0.5 } };
  for (const double t : Ends)
  {
    for (const auto& [r, s] : triangle)
    {
      rule.Nodes.push_back(NodeAt(cell, { r, s, t }));
    }
  }
  for (const int low : { 0, 6 })
  {
    for (const auto& [a, b, c] : { std::array<int, 3>{ 0, 3, 5 }, std::array<int, 3>{ 3, 1, 4 },
           std::array<int, 3>{ 5, 4, 2 }, std::array<int, 3>{ 3, 4, 5 } })
    {
      rule.Parts.push_back(
        { VTK_WEDGE, { low + a, low + b, low + c, low + a + 6, low + b + 6, low + c + 6 } });
    }
  }
  return rule;
}

/// Nodes that are the first points of a cell.
std::vector<SplitRule::Node> OwnPoints(int count)
{
  std::vector<SplitRule::Node> nodes(static_cast<std::size_t>(count));
  for (int point = 0; point < count; ++point)
  {
    nodes[static_cast<std::size_t>(point)] = { { point, 1.0 } };
  }
  return nodes;
}

SplitRule RuleOfTetrahedron()
{
  SplitRule rule;
  rule.PointCount = 10;
  rule.Nodes = OwnPoints(10);
  // Four at the corners; what is left of the middle is cut along the line from 6 to 8.
  for (const auto& nodes : { std::array<int, 4>{ 0, 4, 6, 7 }, std::array<int, 4>{ 4, 1, 5, 8 },
         std::array<int, 4>{ 6, 5, 2, 9 }, std::array<int, 4>{ 7, 8, 9, 3 },
         std::array<int, 4>{ 6, 4, 5, 8 }, std::array<int, 4>{ 6, 5, 9, 8 },
         std::array<int, 4>{ 6, 9, 7, 8 }, std::array<int, 4>{ 6, 7, 4, 8 } })
  {
    rule.Parts.push_back({ VTK_TETRA, { nodes.begin(), nodes.end() } });
  }
  return rule;
}

SplitRule RuleOfPyramid(int type)
{
  const auto cell = CellOfType(type);
  SplitRule rule;
  rule.PointCount = static_cast<int>(cell->GetNumberOfPoints());
  // Points 5 to 8 are the middles around the base, 9 to 12 those on the way up; 13 that of the
  // base, which the cell may have itself.
  const bool own = rule.PointCount > 13;
  rule.Nodes = OwnPoints(own ? 14 : 13);
  if (!own)
  {
    rule.Nodes.push_back(WeightsAt(cell, { 0.5, 0.5, 0.0 }));
  }
  rule.Parts = { { VTK_PYRAMID, { 0, 5, 13, 8, 9 } }, { VTK_PYRAMID, { 5, 1, 6, 13, 10 } },
    { VTK_PYRAMID, { 13, 6, 2, 7, 11 } }, { VTK_PYRAMID, { 8, 13, 7, 3, 12 } },
    { VTK_PYRAMID, { 9, 10, 11, 12, 4 } }, { VTK_PYRAMID, { 12, 11, 10, 9, 13 } },
    { VTK_TETRA, { 5, 9, 10, 13 } }, { VTK_TETRA, { 6, 10, 11, 13 } },
    { VTK_TETRA, { 7, 11, 12, 13 } }, { VTK_TETRA, { 8, 12, 9, 13 } } };
  return rule;
}

/// A prism over a polygon, by a fan from its first corner.
SplitRule RuleOfPrism(int corners)
{
  SplitRule rule;
  rule.PointCount = 2 * corners;
  rule.Nodes = OwnPoints(2 * corners);
  for (int i = 1; i + 1 < corners; ++i)
  {
    // The first triangle of a wedge looks away from the second one, the first polygon of a prism
    // towards the other.
    rule.Parts.push_back({ VTK_WEDGE, { 0, i + 1, i, corners, corners + i + 1, corners + i } });
  }
  return rule;
}

std::map<int, SplitRule> AllRules()
{
  std::map<int, SplitRule> rules;
  for (const int type :
    { VTK_QUADRATIC_HEXAHEDRON, VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON, VTK_TRIQUADRATIC_HEXAHEDRON })
  {
    rules[type] = RuleOfHexahedron(type);
  }
  for (const int type :
    { VTK_QUADRATIC_LINEAR_WEDGE, VTK_QUADRATIC_WEDGE, VTK_BIQUADRATIC_QUADRATIC_WEDGE })
  {
    rules[type] = RuleOfWedge(type);
  }
  rules[VTK_QUADRATIC_TETRA] = RuleOfTetrahedron();
  for (const int type : { VTK_QUADRATIC_PYRAMID, VTK_TRIQUADRATIC_PYRAMID })
  {
    rules[type] = RuleOfPyramid(type);
  }
  rules[VTK_PENTAGONAL_PRISM] = RuleOfPrism(5);
  rules[VTK_HEXAGONAL_PRISM] = RuleOfPrism(6);
  for (auto& [type, rule] : rules)
  {
    for (const SplitRule::Node& node : rule.Nodes)
    {
      rule.NewPoints += node.size() > 1 ? 1 : 0;
      rule.Sources += node.size() > 1 ? node.size() : 0;
    }
    for (const SplitRule::Part& part : rule.Parts)
    {
      rule.Corners += static_cast<int>(part.Nodes.size());
    }
  }
  return rules;
}

} // namespace

const SplitRule* SplitRuleOf(int type)
{
  static const std::map<int, SplitRule> rules = AllRules();
  const auto found = rules.find(type);
  return found == rules.end() ? nullptr : &found->second;
}

} // namespace banyan
