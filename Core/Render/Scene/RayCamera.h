// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_RayCamera_h
#define banyan_Render_Scene_RayCamera_h

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace banyan
{

/// A rectangle of pixels, half-open: Lo <= (x, y) < Hi; y goes up, as in OpenGL.
struct PixelRect
{
  glm::ivec2 Lo{ 0 };
  glm::ivec2 Hi{ 0 };

  glm::ivec2 Size() const
  {
    return { Hi.x > Lo.x ? Hi.x - Lo.x : 0, Hi.y > Lo.y ? Hi.y - Lo.y : 0 };
  }
  bool Empty() const { return Hi.x <= Lo.x || Hi.y <= Lo.y; }
  long long Count() const { return static_cast<long long>(this->Size().x) * this->Size().y; }
  friend bool operator==(const PixelRect& a, const PixelRect& b)
  {
    return a.Lo == b.Lo && a.Hi == b.Hi;
  }
};

/// Empty rectangles come back as the all-zero rectangle.
PixelRect Intersection(const PixelRect& a, const PixelRect& b);

/// Smallest rectangle around both; an empty one counts as nothing.
PixelRect Union(const PixelRect& a, const PixelRect& b);
/// The rectangle so many pixels to the right and up.
PixelRect Moved(const PixelRect& rect, const glm::ivec2& by);

/// Cuts a rectangle into parts of whole rows, from the lowest one on.
/// @param most pixels of a part, if that is enough for the least rows
/// @param edge number of rows in pictures whose multiples parts end at
std::vector<PixelRect> InRows(const PixelRect& rect, long long most, int edge);

/// A ray in the space that the camera was given in: p(t) = Origin + t * Direction, |Direction| = 1.
/// t = 0 is the eye (perspective) or the plane through `Anchor` (parallel projection), so that
/// samples at multiples of a step form one lattice for all pixels, tiles, ranks and clip planes.
struct Ray
{
  glm::dvec3 Origin;
  glm::dvec3 Direction; ///< from the near to the far clipping plane
  double Near = 0;      ///< t of the near clipping plane
  double Far = 0;       ///< t of the far clipping plane; may be infinite
};

/// Rays through pixel centres, from nothing but the matrix that takes world points to clip space
/// (z in [-1, 1]): works for off-axis and parallel projections alike.
class RayCamera
{
public:
  /// @param worldToClip invertible; throws Error otherwise
  /// @param imageSize pixels of the whole picture (not of one tile), at least 1 x 1
  /// @param anchor where t = 0 is for parallel projections; any point, the same on all ranks
  RayCamera(const glm::dmat4& worldToClip, const glm::ivec2& imageSize, const glm::dvec3& anchor);

  glm::ivec2 ImageSize() const { return this->Size; }
  bool Parallel() const { return this->IsParallel; }
  glm::dvec3 Eye() const { return this->EyePoint; }          ///< perspective only
  glm::dvec3 ViewDirection() const { return this->Forward; } ///< of the centre ray, unit

  /// The matrix it was made from, or its negative: points before the eye have w > 0.
  const glm::dmat4& WorldToClipMatrix() const { return this->WorldToClip; }
  /// The inverse of that.
  const glm::dmat4& ClipToWorldMatrix() const { return this->ClipToWorld; }
  const glm::dvec3& AnchorPoint() const { return this->Anchor; }

  /// 1 over the picture's size: what pixel centres are multiplied with.
  const glm::dvec2& PerPixel() const { return this->PixelSize; }

  /// The ray through the centre of pixel (x, y), bottom left is (0, 0).
  Ray RayOf(int x, int y) const;

  /// t along `ray`, which is RayOf(x, y), where the depth buffer has `depth` in [0, 1].
  double DistanceAtDepth(const Ray& ray, int x, int y, double depth) const;

  /// Pixels whose rays may meet a box (axis-aligned in the camera's space) between the clipping
  /// planes; empty when there is none. At most a pixel too large per side for a box that lies
  /// between the planes; what is in front of the near plane does not count.
  PixelRect Footprint(const glm::dvec3& low, const glm::dvec3& high) const;

  /// The same view in a picture of another size: each of its pixels covers as large a part of it.
  RayCamera WithSize(const glm::ivec2& imageSize) const;

  /// The same camera seen from another space: `toWorld` is affine and takes points of that space to
  /// the present one. `Ray::Direction` has unit length in that other space, so `t` has its unit.
  RayCamera InSpace(const glm::dmat4& toWorld) const;

private:
  /// Homogeneous point of pixel centre (x, y) half way between the clip planes in clip space.
  glm::dvec4 MiddleOf(int x, int y) const;

  glm::dmat4 WorldToClip;
  glm::dmat4 ClipToWorld;
  glm::ivec2 Size;
  glm::dvec2 PixelSize; ///< 1 / Size
  glm::dvec3 Anchor;
  glm::dvec3 EyePoint{ 0.0 };
  glm::dvec3 Forward{ 0.0 };
  bool IsParallel = false;
};

} // namespace banyan

#endif
