// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Series_FreeSamples_h
#define banyan_Mesh_Series_FreeSamples_h

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace banyan
{

class ThreadPool;

/// Gives values to the samples of an image that have none: the averages of those in cubes of 2, 4,
/// 8, ... samples per axis, interpolated back from the coarsest to the finest.
/// @param values `[z][y][x]`; those that are not known are replaced
/// @param known by sample: whether it has a value. If none has one, all become 0
void FillFreeSamples(const glm::ivec3& samples, const std::vector<std::uint8_t>& known,
  std::vector<double>& values, ThreadPool& pool);

} // namespace banyan

#endif
