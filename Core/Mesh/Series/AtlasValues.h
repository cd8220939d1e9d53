// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Series_AtlasValues_h
#define banyan_Mesh_Series_AtlasValues_h

#include "Base/ScalarType.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace banyan
{

class ThreadPool;
struct StoredCells;
struct StoredMesh;

/// Says what the values of a series belong to.
enum class MeshValues
{
  OfPoints,
  OfCells
};

/// Values at the points of a mesh, or of its cells, as an image, and back. In octrees the value of
/// a cell is kept where a point at its lowest corner would be, on the lattice of its own level:
/// neighbours of one size are neighbours in the image. Other meshes have boxes: see OrderInBox.
///
/// Samples of the image that stand for no point get values between those around, so that
/// they cost next to nothing: averages of what is known, from coarse to fine. They depend on known
/// values alone, in the same way at each step.
class AtlasValues
{
public:
  explicit AtlasValues(
    const std::shared_ptr<const StoredMesh>& mesh, MeshValues where = MeshValues::OfPoints);
  explicit AtlasValues(
    const std::shared_ptr<const StoredCells>& mesh, MeshValues where = MeshValues::OfPoints);

  /// @param values `[point][components]`, or `[cell][components]`
  /// @param fills values that mean "no value" (and count for no average)
  /// @param image receives `[z][y][x][components]`
  void ToImage(ScalarType type, const void* values, int components,
    const std::vector<double>& fills, void* image, ThreadPool& pool) const;

  /// @param image `[z][y][x][components]`
  /// @param values receives `[point][components]`, or `[cell][components]`
  void FromImage(ScalarType type, const void* image, int components, void* values) const;

private:
  using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

  std::shared_ptr<const void> Mesh;          ///< whose members these are
  glm::ivec3 Image{ 0 };                     ///< samples
  const std::vector<std::uint32_t>& Samples; ///< of the values
  const Pairs* Copies = nullptr;             ///< as StoredMesh has them; null: none
};

} // namespace banyan

#endif
