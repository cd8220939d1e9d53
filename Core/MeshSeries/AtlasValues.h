#ifndef banyan_MeshSeries_AtlasValues_h
#define banyan_MeshSeries_AtlasValues_h

#include "MeshSeries/StoredMesh.h"

#include <memory>
#include <vector>

namespace banyan
{

class ThreadPool;

/// Values at the points of a mesh as an image, and back.
///
/// Samples of the image that stand for no point get values between those around, so that
/// they cost next to nothing: averages of what is known, from coarse to fine. They depend on known
/// values alone, in the same way at each step.
class AtlasValues
{
public:
  explicit AtlasValues(std::shared_ptr<const StoredMesh> mesh);

  /// @param values `[point][components]`
  /// @param fills values that mean "no value" (and count for no average)
  /// @param image receives `[z][y][x][components]`
  void ToImage(ScalarType type, const void* values, int components,
    const std::vector<double>& fills, void* image, ThreadPool& pool) const;

  /// @param image `[z][y][x][components]`
  /// @param values receives `[point][components]`
  void FromImage(ScalarType type, const void* image, int components, void* values) const;

private:
  std::shared_ptr<const StoredMesh> Mesh;
};

} // namespace banyan

#endif
