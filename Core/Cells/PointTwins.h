// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Cells_PointTwins_h
#define banyan_Cells_PointTwins_h

#include "Cells/CellMesh.h"

#include <cstdint>
#include <vector>

namespace banyan
{

class ThreadPool;

/// A point that lies where another one does, and the lowest number of those that lie there.
struct PointTwin
{
  std::int64_t Point;
  std::int64_t First; ///< below Point

  friend bool operator==(const PointTwin& a, const PointTwin& b)
  {
    return a.Point == b.Point && a.First == b.First;
  }
};

/// All points that lie where one with a lower number does, sorted by their numbers: -0 is 0, as for
/// faces. Places are compared by a hash of 64 bits. Takes 4 bytes per point meanwhile, and 16 per
/// twin.
/// @return the same for any number of threads
std::vector<PointTwin> TwinsOf(const CellMesh& mesh, ThreadPool& pool);

/// The lowest number of the points that lie where one does.
/// @param twins sorted by their numbers
std::int64_t FirstAt(const std::vector<PointTwin>& twins, std::int64_t point);

} // namespace banyan

#endif
