// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scene/BytePicture.h"

#include "Base/ThreadPool.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

/// Weights of a pixel's neighbours are multiples of 1/256.
constexpr int One = 256;

/// A pixel of a picture, and nothing outside of it.
const std::uint8_t* PixelAt(const BytePicture& picture, int x, int y)
{
  static constexpr std::uint8_t none[4] = { 0, 0, 0, 0 };
  const PixelRect& rect = picture.Rect;
  if (x < rect.Lo.x || y < rect.Lo.y || x >= rect.Hi.x || y >= rect.Hi.y)
  {
    return none;
  }
  const auto at = static_cast<std::size_t>(y - rect.Lo.y) * static_cast<std::size_t>(rect.Size().x);
  return &picture.Pixels[4 * (at + static_cast<std::size_t>(x - rect.Lo.x))];
}

/// @param at in pixels; pixel centres are at halves
void TakeBetween(const BytePicture& old, const glm::dvec2& at, std::uint8_t* pixel)
{
  const glm::dvec2 corner = glm::floor(at - 0.5);
  const glm::ivec2 low(corner);
  const glm::ivec2 part((at - 0.5 - corner) * static_cast<double>(One));
  const std::uint8_t* const near[2][2] = { { PixelAt(old, low.x, low.y),
                                             PixelAt(old, low.x + 1, low.y) },
    { PixelAt(old, low.x, low.y + 1), PixelAt(old, low.x + 1, low.y + 1) } };
  for (int c = 0; c < 4; ++c)
  {
    const int below = (One - part.x) * near[0][0][c] + part.x * near[0][1][c];
    const int above = (One - part.x) * near[1][0][c] + part.x * near[1][1][c];
    pixel[c] = static_cast<std::uint8_t>(
      ((One - part.y) * below + part.y * above + One * One / 2) / (One * One));
  }
}

/// The pixels around the old picture's rectangle, in the new picture.
PixelRect NewRect(const BytePicture& old, const glm::dmat3& toOld, const glm::ivec2& size)
{
  const PixelRect whole{ glm::ivec2(0), size };
  const glm::dmat3 toNew = glm::inverse(toOld);
  glm::dvec2 low(std::numeric_limits<double>::infinity());
  glm::dvec2 high = -low;
  for (int corner = 0; corner < 4; ++corner)
  {
    const PixelRect& rect = old.Rect;
    const glm::dvec2 pixel(
      corner & 1 ? rect.Hi.x + 1 : rect.Lo.x - 1, corner & 2 ? rect.Hi.y + 1 : rect.Lo.y - 1);
    const glm::dvec3 point = toNew * glm::dvec3(2.0 * pixel / glm::dvec2(old.Size) - 1.0, 1.0);
    if (!(point.z > 0.0))
    {
      return whole; // behind the eye
    }
    const glm::dvec2 seen = (glm::dvec2(point) / point.z + 1.0) * 0.5 * glm::dvec2(size);
    low = glm::min(low, seen);
    high = glm::max(high, seen);
  }
  const glm::dvec2 most(size);
  return { glm::ivec2(glm::clamp(glm::floor(low), glm::dvec2(0.0), most)),
    glm::ivec2(glm::clamp(glm::ceil(high), glm::dvec2(0.0), most)) };
}

} // namespace

BytePicture RoundToBytes(const FloatImage& picture, const glm::ivec2& size)
{
  BytePicture bytes{ size, picture.Rect, {} };
  bytes.Pixels.resize(4 * picture.Pixels.size());
  std::uint8_t* to = bytes.Pixels.data();
  for (const glm::vec4& pixel : picture.Pixels)
  {
    for (int c = 0; c < 4; ++c)
    {
      *to++ = static_cast<std::uint8_t>(
        (static_cast<int>(510.0f * std::clamp(pixel[c], 0.0f, 1.0f)) + 1) / 2);
    }
  }
  return bytes;
}

FloatImage ToFloats(const BytePicture& picture)
{
  FloatImage floats;
  floats.Rect = picture.Rect;
  floats.Pixels.resize(picture.Pixels.size() / 4);
  const std::uint8_t* from = picture.Pixels.data();
  for (glm::vec4& pixel : floats.Pixels)
  {
    pixel = glm::vec4(from[0], from[1], from[2], from[3]) * (1.0f / 255.0f);
    from += 4;
  }
  return floats;
}

BytePicture SeenAnew(
  const BytePicture& old, const glm::dmat3& toOld, const glm::ivec2& size, ThreadPool& threads)
{
  BytePicture seen{ size, NewRect(old, toOld, size), {} };
  if (seen.Rect.Empty() || old.Rect.Empty())
  {
    seen.Rect = PixelRect{};
    return seen;
  }
  const int width = seen.Rect.Size().x;
  seen.Pixels.resize(4 * static_cast<std::size_t>(seen.Rect.Count()));
  // Points of the old picture in its pixels, from pixels of the new one.
  const glm::dvec2 half = 0.5 * glm::dvec2(old.Size);
  const glm::dmat3 toPixels(half.x, 0, 0, 0, half.y, 0, half.x, half.y, 1);
  const glm::dmat3 toPoints(2.0 / size.x, 0, 0, 0, 2.0 / size.y, 0, -1, -1, 1);
  const glm::dmat3 map = toPixels * toOld * toPoints;
  threads.ParallelFor(seen.Rect.Size().y,
    [&](std::int64_t row)
    {
      std::uint8_t* pixel = &seen.Pixels[4 * static_cast<std::size_t>(row * width)];
      glm::dvec3 point =
        map * glm::dvec3(seen.Rect.Lo.x + 0.5, seen.Rect.Lo.y + static_cast<double>(row) + 0.5, 1);
      for (int x = 0; x < width; ++x, pixel += 4, point += map[0])
      {
        const glm::dvec2 at = glm::dvec2(point) / point.z;
        const bool inside = point.z > 0.0 && at.x > old.Rect.Lo.x - 1 && at.y > old.Rect.Lo.y - 1 &&
                            at.x < old.Rect.Hi.x + 1 && at.y < old.Rect.Hi.y + 1;
        if (inside)
        {
          TakeBetween(old, at, pixel);
        }
      }
    });
  return seen;
}

glm::dmat3 OldPictureOfPlane(
  const glm::dmat4& oldToClip, const glm::dmat4& newToClip, const glm::dvec3& point)
{
  const glm::dmat4 fromClip = glm::inverse(oldToClip);
  const glm::dvec4 seen = oldToClip * glm::dvec4(point, 1.0);
  // Points of the old picture at the depth of the plane, in world space: linear in (x, y, 1).
  const glm::dvec4 at = seen / seen.w;
  const glm::dmat3 unit(1.0);
  glm::dmat3 toNew;
  for (int i = 0; i < 3; ++i)
  {
    const glm::dvec4 old = i == 0   ? glm::dvec4(1, 0, 0, 0)
                           : i == 1 ? glm::dvec4(0, 1, 0, 0)
                                    : glm::dvec4(0, 0, at.z, 1);
    const glm::dvec4 seenNow = newToClip * (fromClip * old);
    toNew[i] = glm::dvec3(seenNow.x, seenNow.y, seenNow.w);
  }
  const glm::dvec3 middle = toNew * glm::dvec3(at.x, at.y, 1.0);
  const double area = glm::determinant(toNew) / (middle.z * middle.z * middle.z);
  // The area is negative from behind, and none from the side.
  return seen.w > 0.0 && middle.z > 0.0 && area > 0.0 && std::isfinite(area) ? glm::inverse(toNew)
                                                                             : unit;
}

bool HaveSameEye(const glm::dmat4& oldToClip, const glm::dmat4& newToClip, const glm::ivec2& size)
{
  constexpr double little = 0.1; // pixels
  const auto map = [&](double depth)
  {
    const glm::dvec4 point = glm::inverse(newToClip) * glm::dvec4(0.0, 0.0, depth, 1.0);
    return OldPictureOfPlane(oldToClip, newToClip, glm::dvec3(point) / point.w);
  };
  const glm::dmat3 near = map(-1.0);
  const glm::dmat3 far = map(1.0);
  const glm::dmat3 unit(1.0);
  if (oldToClip != newToClip && (near == unit || far == unit))
  {
    return false; // a camera sees nothing of the other one's picture
  }
  for (int corner = 0; corner < 4; ++corner)
  {
    const glm::dvec3 at(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, 1.0);
    const glm::dvec3 a = near * at;
    const glm::dvec3 b = far * at;
    const glm::dvec2 pixels = (glm::dvec2(a) / a.z - glm::dvec2(b) / b.z) * 0.5 * glm::dvec2(size);
    if (!(a.z > 0.0 && b.z > 0.0 && glm::length(pixels) <= little))
    {
      return false;
    }
  }
  return true;
}

bool ShowsAll(const BytePicture& old, const glm::dmat3& toOld)
{
  const PixelRect& rect = old.Rect;
  if (rect.Lo.x > 0 && rect.Lo.y > 0 && rect.Hi.x < old.Size.x && rect.Hi.y < old.Size.y)
  {
    return true;
  }
  for (int corner = 0; corner < 4; ++corner)
  {
    const glm::dvec3 at = toOld * glm::dvec3(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, 1.0);
    if (!(at.z > 0.0 && std::abs(at.x) <= at.z && std::abs(at.y) <= at.z))
    {
      return false;
    }
  }
  return true;
}

} // namespace banyan
