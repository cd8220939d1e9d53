// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Sampling_CubeDeviation_h
#define banyan_Mesh_Sampling_CubeDeviation_h

#include "Mesh/Sampling/PlaceInCell.h"

#include <array>
#include <vector>

namespace banyan
{

/// Places of the 27 points of a cube: its corners, and the middles of its edges, faces and itself,
/// x fastest. Null for points between corners that lie outside of the mesh.
using CubePlaces = std::array<const PlaceInCell*, 27>;

/// How far the trilinear interpolant of a cube's corners is from the mesh's own field at the points
/// between the corners, whatever the values are.
///
/// At a point the mesh's field is a sum over its nodes with weights w, and what is drawn is one
/// with weights v. Both add up to 1, so that the two differ by at most half of the sum of |w - v|
/// times the spread (largest minus smallest) of the values at these nodes. The largest of these
/// factors is the deviation; 1 at most. It is exact at the points that are looked at, for the worst
/// of all values, and says nothing of others.
class CubeDeviation
{
public:
  explicit CubeDeviation(const CellShapes& shapes)
    : Shapes(shapes)
  {
  }

  /// Points outside of the mesh are not looked at.
  double Of(const CubePlaces& places);

private:
  /// A column for each node; weights of the 27 points in rows.
  void Collect(const CubePlaces& places);
  std::size_t ColumnOf(std::int64_t node);

  const CellShapes& Shapes;
  std::vector<std::int64_t> Nodes;
  std::array<std::array<std::size_t, 8>, 27> Columns{};
  std::array<std::array<double, 8>, 27> Weights{};
  std::vector<double> Difference;
};

} // namespace banyan

#endif
