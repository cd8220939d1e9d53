// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_CellSeries_PointNumbers_h
#define banyan_Mesh_CellSeries_PointNumbers_h

#include "Mesh/CellSeries/StoredCells.h"

namespace banyan
{

/// What a point is predicted from; numbers are those of the format.
enum class PointPrediction : std::uint8_t
{
  Before = 0, ///< the point before it
  Cells = 1   ///< other corners of a cell, where all have been before it; else the point before it
};

/// Coordinates as numbers that are small where they were predicted well, in planes of bytes.
/// @param points as StoredCells has them, of its number and type
/// @param rest where they are moved from, likewise: how they moved is predicted; null: nowhere
Bytes NumbersOfPoints(const StoredCells& cells, PointPrediction prediction,
  const std::uint8_t* points, const std::uint8_t* rest);

/// Inverse of NumbersOfPoints.
/// @param cells its points need not be known, only how many there are
/// @param numbers as many bytes as the points have
Bytes PointsOfNumbers(const StoredCells& cells, PointPrediction prediction, const Bytes& numbers,
  const std::uint8_t* rest);

} // namespace banyan

#endif
