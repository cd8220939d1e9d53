// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scene/RayLattice.h"

#include "Base/Error.h"

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

constexpr double FixedOne = static_cast<double>(std::int64_t{ 1 } << FractionBits);
/// More samples on one ray than anybody waits for: a wrong unit, not a wish.
constexpr double MostSamplesPerRay = 1e7;

void CheckDomain(const Box& cells)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    if (cells.Lo[axis] < -LargestPosition || cells.Hi[axis] > LargestPosition)
    {
      throw Error("The volume has too many cells along one axis to be drawn",
        { {}, {}, static_cast<std::uint64_t>(std::abs(std::int64_t{ cells.Hi[axis] })),
          static_cast<std::uint64_t>(LargestPosition) });
    }
  }
}

void CheckDistance(const RayScene& scene, double distance)
{
  if (!(distance > 0.0) || !std::isfinite(distance))
  {
    throw Error("The sample distance must be above 0");
  }
  const glm::dmat3 linear(scene.IndexToWorld);
  const glm::dvec3 size(scene.DomainCells.Size());
  const double longest = glm::length(linear[0]) * size.x + glm::length(linear[1]) * size.y +
                         glm::length(linear[2]) * size.z;
  if (longest / distance > MostSamplesPerRay)
  {
    throw Error("The sample distance is too small for the volume: a ray would take more than ten "
                "million samples");
  }
}

void CheckViewport(const RayScene& scene)
{
  const PixelRect picture{ { 0, 0 }, scene.Camera.ImageSize() };
  if (!scene.Viewport.Empty() && !(Intersection(scene.Viewport, picture) == scene.Viewport))
  {
    throw Error("The viewport lies outside the picture");
  }
  const auto pixels = static_cast<std::uint64_t>(scene.Viewport.Count());
  if (!scene.Depth.empty() && scene.Depth.size() != pixels)
  {
    throw Error("The depth buffer does not have the size of the viewport",
      { {}, {}, static_cast<std::uint64_t>(scene.Depth.size()), pixels });
  }
}

} // namespace

void RaySamples::CountInSmallerCells(int levels)
{
  if (levels == 0)
  {
    return;
  }
  const std::int64_t factor = std::int64_t{ 1 } << levels;
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Base[axis] *= factor;
    this->Step[axis] *= factor;
    this->Start[axis] *= static_cast<double>(factor);
    this->InverseStep[axis] /= static_cast<double>(factor);
    this->Head.Position[axis] *= factor;
    this->Tail.Position[axis] *= factor;
  }
}

glm::dmat4 IndexToWorldAt(const RayScene& scene, const glm::ivec3& edges)
{
  return glm::scale(scene.IndexToWorld, glm::dvec3(edges));
}

double ScaleToOne(const glm::dmat3& matrix)
{
  double largest = 0.0;
  for (int column = 0; column < 3; ++column)
  {
    for (int row = 0; row < 3; ++row)
    {
      largest = std::max(largest, std::abs(matrix[column][row]));
    }
  }
  return largest > 0.0 && std::isfinite(largest) ? std::exp2(-std::ilogb(largest)) : 1.0;
}

FixedBox::FixedBox(const Box& cells, int larger)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Lo[axis] = ToFixed(cells.Lo[axis]) >> larger;
    this->Size[axis] = static_cast<std::uint64_t>(ToFixed(cells.Size()[axis]) >> larger);
    this->LowFace[axis] = std::ldexp(cells.Lo[axis], -larger);
    this->HighFace[axis] = std::ldexp(cells.Hi[axis], -larger);
  }
}

RayLattice::RayLattice(const RayScene& scene)
  : RayLattice(scene, scene.SampleDistance, glm::ivec3(1))
{
}

RayLattice::RayLattice(const RayScene& scene, double distance, const glm::ivec3& edges, int smaller)
  : Scene(scene)
  , WorldToIndex(glm::inverse(IndexToWorldAt(scene, edges)))
  , WorldToIndexLinear(WorldToIndex)
  , Distance(distance)
  , PerDistance(1.0 / distance)
  , SmallestPerCell(std::ldexp(1.0, smaller))
  , Low(glm::dvec3(scene.DomainCells.Lo) / glm::dvec3(edges))
  , High(glm::dvec3(scene.DomainCells.Hi) / glm::dvec3(edges))
{
  CheckDomain(scene.DomainCells);
  CheckDistance(scene, distance);
  CheckViewport(scene);
  const double volume = glm::determinant(glm::dmat3(scene.IndexToWorld));
  if (volume == 0.0 || !std::isfinite(volume) || !std::isfinite(1.0 / volume))
  {
    throw Error("The volume has no extent in space: a spacing is 0 or not finite");
  }
  this->IndexPlanes = PlanesInIndexSpace(scene.ClipPlanes, IndexToWorldAt(scene, edges));
}

LatticeSetup RayLattice::Setup() const
{
  const RayCamera& camera = this->Scene.Camera;
  LatticeSetup setup;
  setup.ClipToWorld = camera.ClipToWorldMatrix();
  setup.WorldToIndex = this->WorldToIndex;
  setup.PerPixel = camera.PerPixel();
  setup.Parallel = camera.Parallel();
  setup.Forward = camera.ViewDirection();
  setup.Anchor = camera.AnchorPoint();
  setup.Eye = setup.Parallel ? glm::dvec3(0.0) : camera.Eye();
  setup.Low = this->Low;
  setup.High = this->High;
  setup.Distance = this->Distance;
  setup.PerDistance = this->PerDistance;
  setup.ShadingScale = ScaleToOne(this->WorldToIndexLinear);
  setup.SmallestPerCell = this->SmallestPerCell;
  setup.Planes = this->IndexPlanes.data();
  setup.PlaneCount = this->IndexPlanes.size();
  return setup;
}

double RayLattice::GeometryAt(int x, int y) const
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (this->Scene.Depth.empty())
  {
    return infinity;
  }
  const PixelRect& view = this->Scene.Viewport;
  const auto pixel = static_cast<std::size_t>(y - view.Lo.y) * view.Size().x + (x - view.Lo.x);
  const float depth = this->Scene.Depth[pixel];
  return depth < 1.0f
           ? this->Scene.Camera.DistanceAtDepth(this->Scene.Camera.RayOf(x, y), x, y, depth)
           : infinity;
}

void RayLattice::ThrowTooFar()
{
  throw Error("The sample distance is too small for the distance between the eye and the volume");
}

RaySamples RayLattice::SamplesOf(int x, int y) const
{
  RaySamples samples;
  const Ray ray = this->Scene.Camera.RayOf(x, y);
  double enter = ray.Near;
  double exit = ray.Far;
  exit = std::min(exit, this->GeometryAt(x, y));
  const IndexRay indexRay{ glm::dvec3(this->WorldToIndex * glm::dvec4(ray.Origin, 1.0)),
    this->WorldToIndexLinear * ray.Direction };
  if (!this->ClipToDomain(indexRay, enter, exit) || !this->ClipToPlanes(indexRay, enter, exit))
  {
    return samples;
  }

  const double step = this->Distance;
  if (std::max(std::abs(enter), std::abs(exit)) * this->PerDistance > LargestSampleNumber)
  {
    ThrowTooFar();
  }
  const double first = std::ceil(enter * this->PerDistance);
  const double last = std::floor(exit * this->PerDistance);
  if (first > last)
  {
    samples.Head = this->PlacePartial(indexRay, enter, exit);
    return samples;
  }
  samples.Head = this->PlacePartial(indexRay, enter, first * step);
  samples.Tail = this->PlacePartial(indexRay, last * step, exit);
  samples.Count = static_cast<std::int32_t>(last - first);
  if (samples.Count > 0)
  {
    this->PlaceWhole(indexRay, first, samples);
  }
  return samples;
}

bool RayLattice::ClipToDomain(const IndexRay& ray, double& enter, double& exit) const
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const double low = this->Low[axis];
    const double high = this->High[axis];
    if (std::abs(ray.Direction[axis]) < AlongFaces)
    {
      if (!(ray.Origin[axis] >= low && ray.Origin[axis] <= high))
      {
        return false;
      }
      continue;
    }
    const double inverse = 1.0 / ray.Direction[axis];
    const double a = (low - ray.Origin[axis]) * inverse;
    const double b = (high - ray.Origin[axis]) * inverse;
    enter = std::max(enter, std::min(a, b));
    exit = std::min(exit, std::max(a, b));
  }
  return !this->Scene.DomainCells.Empty() && enter < exit;
}

bool RayLattice::ClipToPlanes(const IndexRay& ray, double& enter, double& exit) const
{
  for (const glm::dvec4& plane : this->IndexPlanes)
  {
    const double along =
      (plane.x * ray.Direction.x + plane.y * ray.Direction.y) + plane.z * ray.Direction.z;
    const double above =
      ((plane.x * ray.Origin.x + plane.y * ray.Origin.y) + plane.z * ray.Origin.z) + plane.w;
    if (along == 0.0)
    {
      if (!(above >= 0.0))
      {
        return false;
      }
      continue;
    }
    const double t = -above / along;
    enter = along > 0.0 ? std::max(enter, t) : enter;
    exit = along > 0.0 ? exit : std::min(exit, t);
  }
  return enter < exit;
}

std::int64_t RayLattice::Fixed(const IndexRay& ray, double t, int axis) const
{
  // Rounding may put a sample just outside the domain; the upper face belongs to the last cell.
  const double position = ray.Origin[axis] + ray.Direction[axis] * t;
  const double inside = std::clamp<double>(position, this->Low[axis], this->High[axis]);
  const auto fixed = static_cast<std::int64_t>(std::floor(inside * FixedOne));
  return std::min(fixed, this->LastPosition(axis));
}

PartialSample RayLattice::PlacePartial(const IndexRay& ray, double enter, double exit) const
{
  PartialSample sample;
  const double fraction = (exit - enter) * this->PerDistance;
  if (fraction > 0.0)
  {
    const double middle = 0.5 * (enter + exit);
    for (int axis = 0; axis < 3; ++axis)
    {
      sample.Position[axis] = this->Fixed(ray, middle, axis);
    }
    sample.Fraction = static_cast<float>(std::min(fraction, 1.0));
  }
  return sample;
}

void RayLattice::PlaceWhole(const IndexRay& ray, double firstSample, RaySamples& samples) const
{
  const double distance = this->Distance;
  const std::int64_t steps = samples.Count - 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::int64_t base = this->Fixed(ray, (firstSample + 0.5) * distance, axis);
    // Where a single sample's ray comes from and goes to counts for its head and tail.
    const double exact = ray.Direction[axis] * distance * FixedOne;
    auto step = static_cast<std::int64_t>(std::floor(exact + 0.5));
    if (steps > 0)
    {
      // Keeps the last sample inside the domain too, whatever was rounded on the way.
      const std::int64_t end = base + steps * step;
      const std::int64_t low = this->FirstPosition(axis);
      const std::int64_t high = this->LastPosition(axis);
      if (end < low || end > high)
      {
        step = (std::clamp(end, low, high) - base) / steps;
      }
    }
    samples.Base[axis] = base;
    samples.Step[axis] = step;
    samples.Start[axis] = static_cast<double>(base) / FixedOne;
    samples.InverseStep[axis] = step != 0 ? FixedOne / static_cast<double>(step) : 0.0;
  }
}

} // namespace banyan
