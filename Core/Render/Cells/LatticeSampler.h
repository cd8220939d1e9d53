// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Cells_LatticeSampler_h
#define banyan_Render_Cells_LatticeSampler_h

#include "Render/Cells/CellField.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace banyan
{

class ThreadPool;

/// Places of index space in rows: fixed-point numbers, FractionBits of them below the point.
struct PlacesInRows
{
  std::int64_t First[3] = {};         ///< the lowest corner
  std::int64_t Step[3] = { 1, 1, 1 }; ///< above 0
  glm::ivec3 Count{ 0 };

  std::size_t IndexOf(const glm::ivec3& at) const
  {
    return static_cast<std::size_t>(at.x) +
           static_cast<std::size_t>(this->Count.x) *
             (static_cast<std::size_t>(at.y) +
               static_cast<std::size_t>(this->Count.y) * static_cast<std::size_t>(at.z));
  }
  std::size_t Size() const
  {
    return static_cast<std::size_t>(this->Count.x) * static_cast<std::size_t>(this->Count.y) *
           static_cast<std::size_t>(this->Count.z);
  }
};

/// What a field has in places of a regular lattice: what samples of rays have there, by the same
/// kernel, whose rays are rows along z. Cells without a place between their corners cost little.
/// @param values set, x fastest; NaN where no cell is. Without Base
/// @param owners null, or of a piece of a mesh: set to the place in the order of each value's cell
void SampleField(const CellField& field, const PlacesInRows& places, std::vector<float>& values,
  ThreadPool& pool, std::vector<std::uint32_t>* owners = nullptr);

} // namespace banyan

#endif
