// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_BytePicture_h
#define banyan_Render_Scene_BytePicture_h

#include "Render/Scene/FloatImage.h"

#include <glm/mat3x3.hpp>

#include <cstdint>
#include <vector>

namespace banyan
{

class ThreadPool;

/// A part of a picture with 8 bits per channel, as the screen has them: premultiplied RGBA.
struct BytePicture
{
  glm::ivec2 Size{ 0 };             ///< of the whole picture
  PixelRect Rect;                   ///< in it
  std::vector<std::uint8_t> Pixels; ///< `[y][x][channel]`, y up; 4 * Rect.Count() of them
};

/// Rounds each channel to the nearest of 0 to 255.
/// @param size of the whole picture
BytePicture RoundToBytes(const FloatImage& picture, const glm::ivec2& size);

/// The inverse, as far as there is one.
FloatImage ToFloats(const BytePicture& picture);

/// The picture of one plane, seen by another camera: each pixel of the new picture takes what the
/// four pixels around its point of the old one have, in proportion (bilinear). Nothing is shown
/// outside of the old rectangle.
/// @param toOld takes homogeneous points (x, y, 1) of the new picture, both from -1 to 1, to those
/// of the old one
/// @param size of the new picture, in pixels
BytePicture SeenAnew(
  const BytePicture& old, const glm::dmat3& toOld, const glm::ivec2& size, ThreadPool& threads);

/// The matrix of SeenAnew for a plane that is parallel to the old picture.
/// @param oldToClip what took points of the world to clip space in the old picture; invertible
/// @param newToClip in the new one
/// @param point of the plane, in world space
/// @return the unit matrix where the new camera sees the plane from the side, or from behind
glm::dmat3 OldPictureOfPlane(
  const glm::dmat4& oldToClip, const glm::dmat4& newToClip, const glm::dvec3& point);

/// Whether two cameras see all that is between the clipping planes of the new one from the same
/// eye, or along the same parallel rays: SeenAnew has no parallax then, and is as sharp as the old
/// picture.
/// @param size of the old picture, in pixels: a tenth of one is nothing
bool HaveSameEye(const glm::dmat4& oldToClip, const glm::dmat4& newToClip, const glm::ivec2& size);

/// Whether SeenAnew shows all that a new picture should have: nothing ends at the edges of the old
/// one, or the new one lies within it.
bool ShowsAll(const BytePicture& old, const glm::dmat3& toOld);

} // namespace banyan

#endif
