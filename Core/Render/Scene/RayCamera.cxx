// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scene/RayCamera.h"

#include "Base/Error.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

/// A homogeneous depth below this fraction of the constant one means an eye at infinity: rounding
/// in a parallel projection stays far below, and an eye 1e12 slab thicknesses away is parallel.
constexpr double ParallelLimit = 1e-12;

bool AllFinite(const glm::dmat4& matrix)
{
  for (int column = 0; column < 4; ++column)
  {
    for (int row = 0; row < 4; ++row)
    {
      if (!std::isfinite(matrix[column][row]))
      {
        return false;
      }
    }
  }
  return true;
}

// Planning asks for millions of footprints: std::ceil and std::floor would be calls of a library.

/// The least whole number that is not below a value, in an interval of whole numbers.
int CeilIn(double value, double low, double high)
{
  const double inside = std::clamp(value, low, high);
  const int whole = static_cast<int>(inside);
  return whole + (inside > whole ? 1 : 0);
}

/// The largest whole number that is not above a value, in an interval of whole numbers.
int FloorIn(double value, double low, double high)
{
  const double inside = std::clamp(value, low, high);
  const int whole = static_cast<int>(inside);
  return whole - (inside < whole ? 1 : 0);
}

/// Grows a rectangle of continuous pixel positions.
struct PixelBounds
{
  glm::dvec2 Lo{ std::numeric_limits<double>::infinity() };
  glm::dvec2 Hi{ -std::numeric_limits<double>::infinity() };

  /// @return false when the point cannot be projected
  bool Include(const glm::dvec4& clip, const glm::ivec2& size)
  {
    if (!(clip.w > 0.0))
    {
      return false;
    }
    const glm::dvec2 pixel = (glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(size);
    this->Lo = glm::min(this->Lo, pixel);
    this->Hi = glm::max(this->Hi, pixel);
    return std::isfinite(pixel.x) && std::isfinite(pixel.y);
  }

  /// Pixels whose centres are inside, with a little room for rounding; none that the box does not
  /// reach at all, because compositors around us may cut pictures off there.
  PixelRect Pixels(const glm::ivec2& size) const
  {
    constexpr double slack = 0.01;
    PixelRect rect;
    for (int axis = 0; axis < 2; ++axis)
    {
      const double limit = size[axis];
      rect.Lo[axis] = CeilIn(this->Lo[axis] - 0.5 - slack, 0.0, limit);
      rect.Hi[axis] = FloorIn(this->Hi[axis] - 0.5 + slack, -1.0, limit - 1.0) + 1;
    }
    return rect.Empty() ? PixelRect{} : rect;
  }
};

} // namespace

PixelRect Intersection(const PixelRect& a, const PixelRect& b)
{
  const PixelRect result{ glm::max(a.Lo, b.Lo), glm::min(a.Hi, b.Hi) };
  return result.Empty() ? PixelRect{} : result;
}

PixelRect Union(const PixelRect& a, const PixelRect& b)
{
  if (a.Empty())
  {
    return b.Empty() ? PixelRect{} : b;
  }
  return b.Empty() ? a : PixelRect{ glm::min(a.Lo, b.Lo), glm::max(a.Hi, b.Hi) };
}

PixelRect Moved(const PixelRect& rect, const glm::ivec2& by)
{
  return { rect.Lo + by, rect.Hi + by };
}

std::vector<PixelRect> InRows(const PixelRect& rect, long long most, int edge)
{
  const long long atOnce = std::max(1LL, most / std::max(rect.Size().x, 1) / edge) * edge;
  std::vector<PixelRect> parts;
  for (int y = rect.Lo.y; y < rect.Hi.y;)
  {
    const auto end = static_cast<int>(std::min<long long>(y / edge * edge + atOnce, rect.Hi.y));
    parts.push_back({ { rect.Lo.x, y }, { rect.Hi.x, end } });
    y = end;
  }
  return parts;
}

RayCamera::RayCamera(
  const glm::dmat4& worldToClip, const glm::ivec2& imageSize, const glm::dvec3& anchor)
  : WorldToClip(worldToClip)
  , ClipToWorld(glm::inverse(worldToClip))
  , Size(imageSize)
  , PixelSize(1.0 / glm::dvec2(imageSize))
  , Anchor(anchor)
{
  if (imageSize.x < 1 || imageSize.y < 1)
  {
    throw Error("A camera needs a picture of at least one pixel");
  }
  if (!AllFinite(worldToClip) || !AllFinite(this->ClipToWorld))
  {
    throw Error("The matrix of the camera, or of what it sees, cannot be inverted; check its view "
                "angle, clipping range and view-up direction, and whether the volume's scale is 0");
  }
  // A projective matrix means the same when it is negated. Make the one of the two for which
  // points in front of the eye have a positive w.
  const glm::dvec4 nearCentre = this->ClipToWorld[3] - this->ClipToWorld[2];
  if (nearCentre.w < 0.0)
  {
    this->WorldToClip = -this->WorldToClip;
    this->ClipToWorld = -this->ClipToWorld;
  }
  // All rays meet in the one point that the projection takes to x = y = w = 0.
  const glm::dvec4& apex = this->ClipToWorld[2];
  this->IsParallel = std::abs(apex.w) <= ParallelLimit * std::abs(this->ClipToWorld[3].w);
  if (!this->IsParallel)
  {
    this->EyePoint = glm::dvec3(apex) / apex.w;
  }
  const glm::dvec4& middle = this->ClipToWorld[3];
  const double apexWeight = this->IsParallel ? 0.0 : apex.w;
  this->Forward = glm::normalize(glm::dvec3(apex) * middle.w - glm::dvec3(middle) * apexWeight);
}

glm::dvec4 RayCamera::MiddleOf(int x, int y) const
{
  const double u = (2.0 * x + 1.0) * this->PixelSize.x - 1.0;
  const double v = (2.0 * y + 1.0) * this->PixelSize.y - 1.0;
  return this->ClipToWorld[0] * u + this->ClipToWorld[1] * v + this->ClipToWorld[3];
}

Ray RayCamera::RayOf(int x, int y) const
{
  // With m half way between the planes and c the column of z, the planes' points are m - c and
  // m + c; the direction between these homogeneous points is c.xyz m.w - m.xyz c.w.
  const glm::dvec4 middle = this->MiddleOf(x, y);
  const glm::dvec4& apex = this->ClipToWorld[2];
  const glm::dvec4 near = middle - apex;
  const glm::dvec4 far = middle + apex;
  const glm::dvec3 nearPoint = glm::dvec3(near) * (1.0 / near.w);

  Ray ray;
  if (this->IsParallel)
  {
    ray.Direction = this->Forward;
    ray.Near = glm::dot(nearPoint - this->Anchor, this->Forward);
    ray.Origin = nearPoint - this->Forward * ray.Near;
  }
  else
  {
    ray.Direction = glm::normalize(glm::dvec3(apex) * middle.w - glm::dvec3(middle) * apex.w);
    ray.Origin = this->EyePoint;
    ray.Near = glm::dot(nearPoint - this->EyePoint, ray.Direction);
  }
  ray.Far = far.w > 0.0 ? glm::dot(glm::dvec3(far) * (1.0 / far.w) - ray.Origin, ray.Direction)
                        : std::numeric_limits<double>::infinity();
  return ray;
}

double RayCamera::DistanceAtDepth(const Ray& ray, int x, int y, double depth) const
{
  const glm::dvec4 point = this->MiddleOf(x, y) + this->ClipToWorld[2] * (2.0 * depth - 1.0);
  return point.w > 0.0 ? glm::dot(glm::dvec3(point) / point.w - ray.Origin, ray.Direction)
                       : std::numeric_limits<double>::infinity();
}

PixelRect RayCamera::Footprint(const glm::dvec3& low, const glm::dvec3& high) const
{
  glm::dvec4 corner[8];
  double inFrontOfNear[8]; // signed: >= 0 behind the near plane, where rays are
  int behindNear = 0;
  int beforeFar = 0;
  // Parts of the product of matrix and corner, which four and two corners have in common.
  const glm::dmat4& m = this->WorldToClip;
  glm::dvec4 across[4];
  for (int i = 0; i < 4; ++i)
  {
    across[i] = m[0] * (i & 1 ? high.x : low.x) + m[1] * (i & 2 ? high.y : low.y);
  }
  const glm::dvec4 along[2] = { m[2] * low.z + m[3], m[2] * high.z + m[3] };
  for (int i = 0; i < 8; ++i)
  {
    corner[i] = across[i & 3] + along[i >> 2];
    inFrontOfNear[i] = corner[i].z + corner[i].w;
    behindNear += inFrontOfNear[i] >= 0.0 ? 1 : 0;
    beforeFar += corner[i].z - corner[i].w <= 1e-9 * std::abs(corner[i].w) ? 1 : 0;
  }
  if (beforeFar == 0)
  {
    return {};
  }
  // What the near plane leaves of the box is the convex hull of the corners behind the plane and
  // of the points where edges meet it.
  PixelBounds bounds;
  bool projected = true;
  for (int i = 0; i < 8; ++i)
  {
    if (inFrontOfNear[i] >= 0.0)
    {
      projected = bounds.Include(corner[i], this->Size) && projected;
    }
    for (int axis = 1; axis < 8 && behindNear < 8; axis <<= 1)
    {
      const int j = i | axis;
      if (j != i && (inFrontOfNear[i] < 0.0) != (inFrontOfNear[j] < 0.0))
      {
        const double part = inFrontOfNear[i] / (inFrontOfNear[i] - inFrontOfNear[j]);
        const glm::dvec4 meeting = corner[i] + (corner[j] - corner[i]) * part;
        projected = bounds.Include(meeting, this->Size) && projected;
      }
    }
  }
  return projected ? bounds.Pixels(this->Size) : PixelRect{ { 0, 0 }, this->Size };
}

RayCamera RayCamera::WithSize(const glm::ivec2& imageSize) const
{
  return RayCamera(this->WorldToClip, imageSize, this->Anchor);
}

RayCamera RayCamera::InSpace(const glm::dmat4& toWorld) const
{
  const glm::dvec4 anchor = glm::inverse(toWorld) * glm::dvec4(this->Anchor, 1.0);
  return RayCamera(this->WorldToClip * toWorld, this->Size, glm::dvec3(anchor));
}

} // namespace banyan
