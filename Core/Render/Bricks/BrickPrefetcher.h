// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_BrickPrefetcher_h
#define banyan_Render_Bricks_BrickPrefetcher_h

#include "Base/Box.h"
#include "Render/Scene/RayCamera.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace banyan
{

class PackedBrick;

/// The rays through the corners of a tile, in index space.
using CornerRays = std::array<Ray, 4>;

/// Asks the processor's caches for what a tile's rays meet of a packed brick, a little at a time,
/// while they go through the brick before it. Large volumes come from memory, and what a tile meets
/// of a brick begins anew with each row of samples, which the processor does not foresee.
///
/// The brick is gone through slice by slice along the axis that the rays go along most. What is
/// asked for is a guess: no picture depends on it.
class BrickPrefetcher
{
public:
  BrickPrefetcher() = default; ///< asks for nothing
  /// @param brick must stay
  /// @param cells of it that are drawn
  /// @param corners in cells of the brick
  /// @param calls of Ask in which all of it is to be asked for, about
  BrickPrefetcher(
    const PackedBrick& brick, const Box& cells, const CornerRays& corners, std::int64_t calls);

  /// Asks for the next slices, if there are some left.
  void Ask()
  {
    for (int i = 0; i < this->SlicesPerCall && this->Slice < this->SliceEnd; ++i)
    {
      this->AskFor(this->NextSlice());
    }
  }

  /// Takes the next slice.
  /// @return its samples, of the brick's `[z][y][x]`; empty behind the last one
  Box NextSlice();

private:
  void PlaceRays(const CornerRays& corners, const glm::ivec3& corner);
  void AskFor(const Box& samples) const;

  const char* Values = nullptr;  ///< of sample 0, 0, 0 of the brick
  std::ptrdiff_t Stride[3] = {}; ///< bytes
  int Axis = 2;                  ///< that slices follow each other along
  glm::ivec3 Low{ 0 };           ///< samples to ask for at most
  glm::ivec3 High{ 0 };          ///< the last ones
  /// Where the rays are in the first slice, and how far they are in the next one, in samples.
  glm::vec3 Least{ 0.0f };
  glm::vec3 Most{ 0.0f };
  glm::vec3 LeastStep{ 0.0f };
  glm::vec3 MostStep{ 0.0f };
  int Slice = 0;
  int SliceEnd = 0;
  int SliceStep = 1; ///< samples; across rows those of a line of the caches together
  int SlicesPerCall = 0;
};

} // namespace banyan

#endif
