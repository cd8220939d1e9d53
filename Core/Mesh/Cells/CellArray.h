// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Cells_CellArray_h
#define banyan_Mesh_Cells_CellArray_h

#include "Mesh/Octree/CellNodes.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace banyan
{

class ThreadPool;

/// One number for each point or cell of a mesh.
struct CellArray
{
  std::vector<float> Values; ///< the numbers minus Base; NaN where there is none
  double Base = 0.0;         ///< not 0 only where float32 cannot hold the type (see FitsFloat)
  ValuesOn Where = ValuesOn::Points;
};

/// The lowest finite number of an array, or length where that is taken. Infinity where there is
/// none, so that the least of all ranks is that of those that have some.
/// @param count tuples; the array needs no values when there are none
/// Throws Error when the array has no such component.
double LowestOf(const NodeArray& array, std::int64_t count, ThreadPool& pool);

/// Takes a component of an array, or the length of all.
///
/// Types that float32 holds stay as they are: Base is 0, infinities remain, and a length beyond
/// float32 becomes the largest float32. Numbers of other types are taken relative to Base in double
/// before they are rounded, so data around 1e6 that vary by 0.1 keep their digits. There, as for
/// images, infinities become NaN, and numbers further than 1e30 from Base are taken for that far.
/// @param count tuples; the array needs no values when there are none
/// @param base of the types that float32 cannot hold, the same on all ranks; LowestOf by default,
/// or 0 where that is infinite
/// Throws Error when the array has no such component.
CellArray CellArrayOf(const NodeArray& array, std::int64_t count, ValuesOn where, ThreadPool& pool,
  std::optional<double> base = {});

} // namespace banyan

#endif
