// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Levels/RayCaster.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

/// One ray through the field, in double; shares only the camera with the ray caster.
class ReferenceRay
{
public:
  ReferenceRay(const RayScene& scene, const std::function<double(const glm::ivec3&)>& value,
    const std::function<glm::dvec4(double)>& function,
    const std::function<bool(const glm::ivec3&)>& hidden,
    const std::function<glm::dvec3(const glm::ivec3&)>& colour)
    : Scene(scene)
    , Value(value)
    , Function(function)
    , Hidden(hidden)
    , Colour(colour)
    , WorldToIndex(glm::inverse(scene.IndexToWorld))
  {
  }

  glm::dvec4 Integrate(int x, int y) const
  {
    const Ray ray = this->Scene.Camera.RayOf(x, y);
    double enter = ray.Near;
    double exit = std::min(ray.Far, this->GeometryAt(ray, x, y));
    if (!this->ClipToDomain(ray, enter, exit) || !this->ClipToPlanes(ray, enter, exit))
    {
      return glm::dvec4(0.0);
    }
    Met met;
    const double step = this->Scene.SampleDistance;
    for (double k = std::floor(enter / step); k * step < exit; k += 1.0)
    {
      const double begin = std::max(k * step, enter);
      const double end = std::min((k + 1.0) * step, exit);
      const glm::dvec3 position = this->IndexAt(ray, 0.5 * (begin + end));
      const double value = this->Interpolate(position, this->Value);
      if (std::isfinite(value) && end > begin &&
          !(this->Hidden && this->Hidden(this->CellAt(position))))
      {
        const glm::dvec3 tint =
          this->Colour ? this->Interpolate(position, this->Colour) : glm::dvec3(1.0);
        this->Add(value, tint, end - begin, met);
      }
    }
    return this->PixelOf(met);
  }

private:
  /// What a ray has met so far.
  struct Met
  {
    glm::dvec3 Color{ 0.0 };
    double Transmittance = 1.0;
    double Lowest = std::numeric_limits<double>::infinity();
    double Highest = -std::numeric_limits<double>::infinity();
    double Sum = 0.0;
    double Length = 0.0;
  };

  void Add(double value, const glm::dvec3& tint, double length, Met& met) const
  {
    const RayBlend& blend = this->Scene.Blend;
    const glm::dvec4 entry = this->Function(value) * glm::dvec4(tint, 1.0);
    const double opacity =
      1.0 - std::pow(1.0 - entry.a, length / this->Scene.Transfer.UnitDistance);
    met.Color += met.Transmittance * opacity * glm::dvec3(entry);
    met.Transmittance *= 1.0 - opacity;
    met.Lowest = std::min(met.Lowest, value);
    met.Highest = std::max(met.Highest, value);
    if (value >= blend.AveragedLow && value <= blend.AveragedHigh)
    {
      const double level = (value - blend.Black) / (blend.White - blend.Black);
      met.Sum += length * entry.a * std::clamp(level, 0.0, 1.0);
      met.Length += length;
    }
  }

  glm::dvec4 PixelOf(const Met& met) const
  {
    const BlendMode mode = this->Scene.Blend.Mode;
    if (mode == BlendMode::Composite)
    {
      return glm::dvec4(met.Color, 1.0 - met.Transmittance);
    }
    if (mode == BlendMode::Average)
    {
      return met.Length > 0.0 ? glm::dvec4(glm::dvec3(met.Sum / met.Length), 1.0) : glm::dvec4(0.0);
    }
    if (met.Lowest > met.Highest)
    {
      return glm::dvec4(0.0);
    }
    const glm::dvec4 entry = this->Function(mode == BlendMode::Maximum ? met.Highest : met.Lowest);
    return glm::dvec4(entry.a * glm::dvec3(entry), entry.a);
  }

  bool ClipToPlanes(const Ray& ray, double& enter, double& exit) const
  {
    for (const ClipPlane& plane : this->Scene.ClipPlanes)
    {
      const double atOrigin = glm::dot(plane.Normal, ray.Origin) + plane.Offset;
      const double along = glm::dot(plane.Normal, ray.Direction);
      if (along > 0.0)
      {
        enter = std::max(enter, -atOrigin / along);
      }
      else if (along < 0.0)
      {
        exit = std::min(exit, -atOrigin / along);
      }
      else if (atOrigin < 0.0)
      {
        return false;
      }
    }
    return enter < exit;
  }

  double GeometryAt(const Ray& ray, int x, int y) const
  {
    const PixelRect& view = this->Scene.Viewport;
    if (this->Scene.Depth.empty())
    {
      return ray.Far;
    }
    const std::size_t row = static_cast<std::size_t>(y - view.Lo.y) * view.Size().x;
    return this->Scene.Camera.DistanceAtDepth(ray, x, y, this->Scene.Depth[row + (x - view.Lo.x)]);
  }

  glm::dvec3 IndexAt(const Ray& ray, double t) const
  {
    return glm::dvec3(this->WorldToIndex * glm::dvec4(ray.Origin + t * ray.Direction, 1.0));
  }

  bool ClipToDomain(const Ray& ray, double& enter, double& exit) const
  {
    const glm::dvec3 origin = this->IndexAt(ray, 0.0);
    const glm::dvec3 way(this->WorldToIndex * glm::dvec4(ray.Direction, 0.0));
    const Box& cells = this->Scene.DomainCells;
    for (int axis = 0; axis < 3; ++axis)
    {
      // Dividing by 0 gives infinities of the right sign, or NaN (which changes nothing here) for
      // a ray inside a face.
      const double a = (cells.Lo[axis] - origin[axis]) / way[axis];
      const double b = (cells.Hi[axis] - origin[axis]) / way[axis];
      enter = std::max(enter, std::min(a, b));
      exit = std::min(exit, std::max(a, b));
    }
    return !cells.Empty() && enter < exit;
  }

  glm::ivec3 NearestTo(const glm::dvec3& position) const
  {
    const Box& cells = this->Scene.DomainCells;
    const glm::ivec3 nearest(glm::floor(position + 0.5));
    return glm::clamp(nearest, cells.Lo, cells.Hi);
  }

  glm::ivec3 CellAt(const glm::dvec3& position) const
  {
    const Box& cells = this->Scene.DomainCells;
    return glm::clamp(glm::ivec3(glm::floor(position)), cells.Lo, cells.Hi - 1);
  }

  /// @tparam T double or glm::dvec3
  template <class T>
  T Interpolate(const glm::dvec3& position, const std::function<T(const glm::ivec3&)>& sample) const
  {
    if (this->Scene.Interpolation == SampleInterpolation::Nearest)
    {
      return sample(this->NearestTo(position));
    }
    const glm::ivec3 cell = this->CellAt(position);
    const glm::dvec3 part = glm::clamp(position - glm::dvec3(cell), 0.0, 1.0);
    T sum(0.0);
    for (int corner = 0; corner < 8; ++corner)
    {
      const glm::ivec3 offset(corner & 1, corner >> 1 & 1, corner >> 2);
      double weight = 1.0;
      for (int axis = 0; axis < 3; ++axis)
      {
        weight *= offset[axis] ? part[axis] : 1.0 - part[axis];
      }
      // A corner of weight 0 counts too: 0 times NaN or infinity is NaN.
      sum += weight * sample(cell + offset);
    }
    return sum;
  }

  const RayScene& Scene;
  const std::function<double(const glm::ivec3&)>& Value;
  const std::function<glm::dvec4(double)>& Function;
  const std::function<bool(const glm::ivec3&)>& Hidden;
  const std::function<glm::dvec3(const glm::ivec3&)>& Colour;
  glm::dmat4 WorldToIndex;
};

} // namespace

FloatImage ReferenceImage(const RayScene& scene,
  const std::function<double(const glm::ivec3&)>& value,
  const std::function<glm::dvec4(double)>& function,
  const std::function<bool(const glm::ivec3&)>& hidden,
  const std::function<glm::dvec3(const glm::ivec3&)>& colour)
{
  const ReferenceRay ray(scene, value, function, hidden, colour);
  FloatImage image;
  image.Rect = scene.Viewport;
  image.Pixels.reserve(static_cast<std::size_t>(scene.Viewport.Count()));
  for (int y = scene.Viewport.Lo.y; y < scene.Viewport.Hi.y; ++y)
  {
    for (int x = scene.Viewport.Lo.x; x < scene.Viewport.Hi.x; ++x)
    {
      image.Pixels.emplace_back(ray.Integrate(x, y));
    }
  }
  return image;
}

} // namespace banyan
