// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_RayLattice_h
#define banyan_Render_Scene_RayLattice_h

#include "Render/Scene/RaySampling.h"
#include "Render/Scene/RayScene.h"

#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace banyan
{

/// Positions along rays are fixed-point numbers in index space, with this many bits below the
/// point. Adding them is exact, so the samples of a ray do not depend on where one starts counting:
/// bricks, zones and batches of any size see the same samples, bit for bit, and each sample lies in
/// exactly one cell.
constexpr int FractionBits = 24;
/// Leaves room for a sum of two positions in 64 bits.
constexpr int LargestPosition = 1 << 26;

inline std::int64_t ToFixed(int cell)
{
  return static_cast<std::int64_t>(cell) * (std::int64_t{ 1 } << FractionBits);
}

/// A box of cells with fixed-point faces: a sample is in exactly one cell, the one with
/// Lo <= position < Lo + Size per axis.
struct FixedBox
{
  /// @param larger how many times cells that positions count are twice as long as those of the box:
  /// its faces may lie inside of them; at most FractionBits
  explicit FixedBox(const Box& cells, int larger = 0);

  bool Contains(const std::int64_t (&position)[3]) const
  {
    // One unsigned comparison per axis tests both faces.
    return (static_cast<std::uint64_t>(position[0] - this->Lo[0]) < this->Size[0]) &
           (static_cast<std::uint64_t>(position[1] - this->Lo[1]) < this->Size[1]) &
           (static_cast<std::uint64_t>(position[2] - this->Lo[2]) < this->Size[2]);
  }

  std::int64_t Lo[3];
  std::uint64_t Size[3];
  double LowFace[3];
  double HighFace[3];
};

/// A sample at the end of a ray, which stands for less than a whole interval: it lies in the middle
/// of what is left of the interval.
struct PartialSample
{
  std::int64_t Position[3];
  float Fraction = 0; ///< of the sample distance; 0 when there is no such sample
};

/// All samples of one ray in the domain: a head, `Count` whole ones, a tail.
struct RaySamples
{
  std::int64_t Base[3]; ///< position of whole sample 0
  std::int64_t Step[3];
  double Start[3];       ///< Base in cells
  double InverseStep[3]; ///< samples per cell; meaningless where Step is 0
  std::int32_t Count = 0;
  PartialSample Head;
  PartialSample Tail;

  bool Empty() const
  {
    return this->Count == 0 && this->Head.Fraction == 0 && this->Tail.Fraction == 0;
  }

  void PositionOf(std::int32_t sample, std::int64_t (&position)[3]) const
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      position[axis] = this->Base[axis] + sample * this->Step[axis];
    }
  }

  /// The same samples, in cells 2^levels times as short: exact.
  void CountInSmallerCells(int levels);

  /// Whole samples inside a box: a half-open interval, exact; empty when begin >= end.
  void SamplesIn(const FixedBox& box, std::int32_t& begin, std::int32_t& end) const;
};

inline void RaySamples::SamplesIn(const FixedBox& box, std::int32_t& begin, std::int32_t& end) const
{
  begin = end = 0;
  double in = 0.0;
  double out = this->Count;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (this->Step[axis] != 0)
    {
      const double low = (box.LowFace[axis] - this->Start[axis]) * this->InverseStep[axis];
      const double high = (box.HighFace[axis] - this->Start[axis]) * this->InverseStep[axis];
      in = std::max(in, std::min(low, high));
      out = std::min(out, std::max(low, high));
    }
  }
  if (!(in < out + 1.0))
  {
    return;
  }
  // Rounded down, the estimates are at most two samples early and never late: the exact test in
  // fixed point finds the true ends from there.
  std::int32_t first = static_cast<std::int32_t>(in);
  const std::int32_t tooLate = std::min(first + 3, this->Count);
  std::int64_t position[3];
  for (; first < tooLate; ++first)
  {
    this->PositionOf(first, position);
    if (box.Contains(position))
    {
      break;
    }
  }
  if (first >= tooLate)
  {
    return;
  }
  begin = first;
  end = std::max(static_cast<std::int32_t>(out), first + 1);
  for (; end < this->Count; ++end)
  {
    this->PositionOf(end, position);
    if (!box.Contains(position))
    {
      break;
    }
  }
}

/// Of the index space of a level.
/// @param edges of its cells, in fine ones
glm::dmat4 IndexToWorldAt(const RayScene& scene, const glm::ivec3& edges);

/// The power of two that brings the largest number of a matrix to 1 or below 2.
double ScaleToOne(const glm::dmat3& matrix);

/// What rays are made from, for code that makes many at a time.
struct LatticeSetup
{
  glm::dmat4 ClipToWorld{ 1.0 };
  glm::dmat4 WorldToIndex{ 1.0 };
  glm::dvec2 PerPixel{ 1.0 }; ///< 1 over the size of the whole picture
  bool Parallel = false;
  glm::dvec3 Forward{ 0.0 }; ///< parallel projections only, as Anchor
  glm::dvec3 Anchor{ 0.0 };
  glm::dvec3 Eye{ 0.0 }; ///< perspective projections only
  glm::dvec3 Low{ 0.0 }; ///< of the domain, in cells
  glm::dvec3 High{ 0.0 };
  double Distance = 1.0;
  double PerDistance = 1.0; ///< 1 / Distance
  /// A power of two that brings directions in index space near 1.
  double ShadingScale = 1.0;
  /// Smallest cells that are drawn per cell of the lattice, along an axis.
  double SmallestPerCell = 1.0;
  const glm::dvec4* Planes = nullptr; ///< RayLattice::Planes
  std::size_t PlaneCount = 0;
};

/// Makes the samples of rays from what all ranks know: the camera, the domain, the clip planes, the
/// depth and the sampling. The values and their distribution have no part in it. Index space is
/// that of a level: the domain may end inside a cell there.
class RayLattice
{
public:
  /// Refers to `scene`, which must stay. Throws Error when the scene is not usable.
  /// @param distance world length between samples
  /// @param edges of the level's cells, in fine ones
  /// @param smaller how many times the smallest cells are half as long as those of the level
  RayLattice(const RayScene& scene, double distance, const glm::ivec3& edges, int smaller = 0);
  /// At the finest level, with the scene's sample distance.
  explicit RayLattice(const RayScene& scene);

  /// Beyond this the numbers of samples are no longer exact in double.
  static constexpr double LargestSampleNumber = 1e15;

  /// Rays that go less far along an axis, in cells per world length, run along its faces.
  static constexpr double AlongFaces = 1e-290;

  /// Whether there is any: GeometryAt is infinite for all pixels otherwise.
  bool HasGeometry() const { return !this->Scene.Depth.empty(); }

  /// One ray after the other: what tiles of rays are held to (RayTile::Open).
  /// @param x, y pixel of the whole picture, inside the scene's viewport
  RaySamples SamplesOf(int x, int y) const;

  /// Refers to this lattice.
  LatticeSetup Setup() const;

  /// The clip planes in index space: unit normal, and distance in cells.
  const std::vector<glm::dvec4>& Planes() const { return this->IndexPlanes; }

  /// t along the ray of a pixel where the depth buffer has geometry; infinite where it has none.
  double GeometryAt(int x, int y) const;

  [[noreturn]] static void ThrowTooFar();

private:
  /// A ray in index space; t stays a world length.
  struct IndexRay
  {
    glm::dvec3 Origin;
    glm::dvec3 Direction; ///< cells per world length
  };

  /// Narrows t to where the ray is inside the domain.
  /// @return false when nothing is left
  bool ClipToDomain(const IndexRay& ray, double& enter, double& exit) const;
  /// Narrows t to what the clip planes leave of the ray.
  /// @return false when nothing is left
  bool ClipToPlanes(const IndexRay& ray, double& enter, double& exit) const;
  void PlaceWhole(const IndexRay& ray, double firstSample, RaySamples& samples) const;
  PartialSample PlacePartial(const IndexRay& ray, double enter, double exit) const;
  std::int64_t Fixed(const IndexRay& ray, double t, int axis) const;
  /// Fixed-point positions that lie in the domain. What is not whole ends beyond any position.
  std::int64_t FirstPosition(int axis) const
  {
    return static_cast<std::int64_t>(std::ceil(this->Low[axis] * (1 << FractionBits)));
  }
  std::int64_t LastPosition(int axis) const
  {
    return static_cast<std::int64_t>(std::ceil(this->High[axis] * (1 << FractionBits))) - 1;
  }

  const RayScene& Scene;
  glm::dmat4 WorldToIndex;
  glm::dmat3 WorldToIndexLinear;
  std::vector<glm::dvec4> IndexPlanes;
  double Distance;
  double PerDistance; ///< 1 / Distance
  double SmallestPerCell;
  glm::dvec3 Low; ///< of the domain, in cells
  glm::dvec3 High;
};

} // namespace banyan

#endif
