// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Points_PointsReader_h
#define banyan_Series_Points_PointsReader_h

#include "Series/Points/GridPoints.h"

#include <array>
#include <string>

namespace banyan
{

class ThreadPool;

/// Reads the points of a part of a grid, bit-exact. The points of a level are those of the samples
/// that the level keeps (see BrickLayout::FineSample).
/// @param folder of the series
/// @param part samples of the level's BrickLayout, not empty
/// @param values receive the part: as PointsView has them, of `part` in place of the whole grid
/// Throws Error that names the file when it is missing or damaged, or is not what the index says.
void ReadPoints(const std::string& folder, const SeriesIndex& index, int step, int level,
  const Box& part, const std::array<void*, 3>& values, ThreadPool& pool);

} // namespace banyan

#endif
