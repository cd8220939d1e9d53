// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Points_PointsWriter_h
#define banyan_Series_Points_PointsWriter_h

#include "Base/Hash.h"
#include "Series/Points/GridPoints.h"

#include <functional>
#include <string>

namespace banyan
{

class ThreadPool;

/// Where a file of points is written, and how it is called.
struct PointsPlace
{
  std::string Folder;
  std::string Temporary; ///< a name until it is whole
  std::function<std::string(const Hash128& head)> NameOf;
};

/// Throws Error when points are not those that a series is to have, by their form and number.
void CheckPoints(const PointsView& points, const SeriesIndex& index);

/// Writes the file of the points of a step. Equal points have equal files.
/// Throws Error when it cannot be written.
PointsFile WritePoints(
  const PointsView& points, int step, const PointsPlace& place, ThreadPool& pool);

} // namespace banyan

#endif
