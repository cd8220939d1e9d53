// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_BenchScene_h
#define banyan_Benchmarks_BenchScene_h

#include "Base/ScalarType.h"
#include "Render/Bricks/ArrayBrickSource.h"
#include "Render/Levels/RayCaster.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace banyan::bench
{

/// Cells per axis of the bricks that values in memory are cut into, as the mapper does.
constexpr int BrickCells = 16;

/// Where a ray is inside a volume, in multiples of `way`: from Near and up to Far of the ray at
/// most. A ray inside a face gives NaN, which changes nothing.
/// @param origin, way of the ray, in samples
/// @param last sample of each axis
struct RayInterval
{
  double Enter;
  double Exit;

  RayInterval(
    const Ray& ray, const glm::dvec3& origin, const glm::dvec3& way, const glm::ivec3& last)
    : Enter(ray.Near)
    , Exit(ray.Far)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const double a = -origin[axis] / way[axis];
      const double b = (last[axis] - origin[axis]) / way[axis];
      this->Enter = std::max(this->Enter, std::min(a, b));
      this->Exit = std::min(this->Exit, std::max(a, b));
    }
  }
};

/// Samples of a regular grid, x fastest, with sample (0, 0, 0) at the origin.
struct Volume
{
  glm::ivec3 Samples{ 2 };
  glm::dvec3 Spacing{ 1.0 };
  std::vector<float> Floats;       ///< either these
  std::vector<std::uint8_t> Codes; ///< or these
  ScalarType Type() const { return this->Codes.empty() ? ScalarType::Float32 : ScalarType::UInt8; }
  const void* Values() const;

  glm::dvec3 Size() const { return glm::dvec3(this->Samples - 1) * this->Spacing; }
  /// Length of the sample distance 1: the shortest edge of a cell.
  double VoxelLength() const;
  /// Refers to the values, which must stay.
  SampleArray Array() const;
};

/// A part of an array, where it is: values are not copied.
/// @param samples of the array
SampleArray PartOf(const SampleArray& whole, const Box& samples);

/// All that decides a picture, in words that every renderer understands.
struct BenchScene
{
  std::string Name;
  std::shared_ptr<const Volume> Data;

  glm::dvec3 Eye{ 0.0 };
  glm::dvec3 Center{ 0.0 };
  glm::dvec3 Up{ 0.0, 1.0, 0.0 };
  double ViewAngleDegrees = 45.0;
  int Picture = 1024; ///< pixels per side

  /// Colour, and opacity over UnitDistance, at values that are equally spaced over [Low, High];
  /// linear in between, constant outside.
  std::vector<glm::dvec4> Nodes;
  double Low = 0.0;
  double High = 1.0;
  double UnitDistance = 1.0;
  /// Colour times 0.3 + 0.7 |n . d|, n the direction of the gradient (central differences over two
  /// voxels), d the ray's; 0.3 where there is no gradient.
  bool Shaded = false;
  bool HasGoals = false; ///< whether the design says how fast it is to be drawn

  /// What the nodes say of a value.
  glm::dvec4 At(double value) const;
  /// Puts the camera where it sees the whole volume from the standard scenes' direction.
  /// @param distance of the eye from the centre, in diagonals of the volume
  void LookFromAfar(double distance);
};

/// The scene in the ray caster's own words, with levels of values in memory.
/// @param sampleDistance in voxels
/// @param opacityLimit see RayScene
/// @param tableEntries of the transfer function's table
RayScene ToRayScene(
  const BenchScene& scene, double sampleDistance, float opacityLimit, int tableEntries = 4096);

} // namespace banyan::bench

#endif
