#ifndef banyan_Render_RayCamera_h
#define banyan_Render_RayCamera_h

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

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

PixelRect Intersection(const PixelRect& a, const PixelRect& b);

/// A ray in the space that the camera was given in: p(t) = Origin + t * Direction, |Direction| = 1.
/// t = 0 is the eye (perspective) or the plane through `Anchor` (parallel projection), so that
/// samples at multiples of a step form one lattice for all pixels, tiles, ranks and clip planes.
struct Ray
{
  glm::dvec3 Origin;
  glm::dvec3 Direction;
  double Near = 0; ///< t of the near clipping plane
  double Far = 0;  ///< t of the far clipping plane
};

/// Rays through pixel centres, from nothing but the matrix that takes world points to clip space
/// (z in [-1, 1]): works for off-axis and parallel projections alike.
class RayCamera
{
public:
  /// @param worldToClip invertible; throws Error otherwise
  /// @param imageSize pixels of the whole picture (not of one tile)
  /// @param anchor where t = 0 is for parallel projections; any point, the same on all ranks
  RayCamera(const glm::dmat4& worldToClip, const glm::ivec2& imageSize, const glm::dvec3& anchor);

  glm::ivec2 ImageSize() const { return this->Size; }
  bool Parallel() const { return this->IsParallel; }
  glm::dvec3 Eye() const { return this->EyePoint; }          ///< perspective only
  glm::dvec3 ViewDirection() const { return this->Forward; } ///< of the centre ray, unit

  /// The ray through the centre of pixel (x, y), bottom left is (0, 0).
  Ray RayOf(int x, int y) const;

  /// t along `ray` where the depth buffer has `depth` in [0, 1].
  double DistanceAtDepth(const Ray& ray, int x, int y, double depth) const;

  /// Pixels that a box (axis-aligned in world space) may touch; the whole image when part of the
  /// box is behind the eye; empty when it is off screen.
  PixelRect Footprint(const glm::dvec3& low, const glm::dvec3& high) const;

  /// The same camera seen from another space: `toWorld` is affine and takes points of that space to
  /// the present one. `Ray::Direction` has unit length in that other space.
  RayCamera InSpace(const glm::dmat4& toWorld) const;

private:
  glm::dmat4 WorldToClip;
  glm::dmat4 ClipToWorld;
  glm::ivec2 Size;
  glm::dvec3 Anchor;
  glm::dvec3 EyePoint{ 0.0 };
  glm::dvec3 Forward{ 0.0 };
  bool IsParallel = false;
};

} // namespace banyan

#endif
