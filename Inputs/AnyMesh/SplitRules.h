// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_SplitRules_h
#define banyan_Inputs_SplitRules_h

#include <cstddef>
#include <utility>
#include <vector>

namespace banyan
{

/// How cells of one type are divided into linear ones, whatever their points are.
struct SplitRule
{
  /// A node of the parts: points of the cell by their numbers in it, with weights. One with the
  /// weight 1 is that point itself.
  using Node = std::vector<std::pair<int, double>>;

  struct Part
  {
    int Type = 0;           ///< as VTK numbers them
    std::vector<int> Nodes; ///< in VTK's order
  };

  int PointCount = 0; ///< of the cell
  std::vector<Node> Nodes;
  std::vector<Part> Parts;

  // Sums.
  std::size_t NewPoints = 0; ///< Nodes that are no point of the cell
  std::size_t Sources = 0;   ///< of these
  int Corners = 0;           ///< of the parts
};

/// Quadratic hexahedra (20, 24 or 27 points) and wedges (12, 15, 18) become 8 parts of their own
/// shape, quadratic tetrahedra 8 tetrahedra, quadratic pyramids (13, 19) 6 pyramids and 4
/// tetrahedra, prisms wedges. Middles that a cell has no point for are made with its own shape
/// functions.
/// @param type as VTK numbers them
/// @return null for other types
const SplitRule* SplitRuleOf(int type);

} // namespace banyan

#endif
