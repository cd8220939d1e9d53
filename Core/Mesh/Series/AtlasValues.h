// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Series_AtlasValues_h
#define banyan_Mesh_Series_AtlasValues_h

#include "Mesh/Series/StoredMesh.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace banyan
{

class ThreadPool;

/// Says what the values of a series belong to.
enum class MeshValues
{
  OfPoints,
  OfCells
};

/// Values at the points of a mesh, or of its cells, as an image, and back. The value of a cell is
/// kept where a point at its lowest corner would be, on the lattice of its own level: neighbours of
/// one size are neighbours in the image.
///
/// Samples of the image that stand for no point get values between those around, so that
/// they cost next to nothing: averages of what is known, from coarse to fine. They depend on known
/// values alone, in the same way at each step.
class AtlasValues
{
public:
  explicit AtlasValues(
    std::shared_ptr<const StoredMesh> mesh, MeshValues where = MeshValues::OfPoints);

  /// @param values `[point][components]`, or `[cell][components]`
  /// @param fills values that mean "no value" (and count for no average)
  /// @param image receives `[z][y][x][components]`
  void ToImage(ScalarType type, const void* values, int components,
    const std::vector<double>& fills, void* image, ThreadPool& pool) const;

  /// @param image `[z][y][x][components]`
  /// @param values receives `[point][components]`, or `[cell][components]`
  void FromImage(ScalarType type, const void* image, int components, void* values) const;

private:
  const std::vector<std::uint32_t>& Samples() const;

  std::shared_ptr<const StoredMesh> Mesh;
  MeshValues Where;
};

} // namespace banyan

#endif
