// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scene/BytePicture.h"

#include "Base/ThreadPool.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace
{

using namespace banyan;

/// A picture whose red is 10 times the column, and whose green is 10 times the row.
BytePicture Ramp(const glm::ivec2& size, const PixelRect& rect)
{
  BytePicture picture{ size, rect, {} };
  for (int y = rect.Lo.y; y < rect.Hi.y; ++y)
  {
    for (int x = rect.Lo.x; x < rect.Hi.x; ++x)
    {
      for (const int value : { 10 * x, 10 * y, 7, 255 })
      {
        picture.Pixels.push_back(static_cast<std::uint8_t>(value));
      }
    }
  }
  return picture;
}

int At(const BytePicture& picture, int x, int y, int channel)
{
  const PixelRect& rect = picture.Rect;
  const auto at = static_cast<std::size_t>((y - rect.Lo.y) * rect.Size().x + x - rect.Lo.x);
  return picture.Pixels[4 * at + static_cast<std::size_t>(channel)];
}

TEST(BytePicture, RoundsToTheNearest)
{
  const FloatImage image{ { { 0, 0 }, { 1, 1 } },
    PixelVector{ glm::vec4(0.0f, 1.0f, 0.4999f, 1.5f) } };
  const BytePicture bytes = RoundToBytes(image, { 1, 1 });
  EXPECT_EQ(bytes.Pixels, (std::vector<std::uint8_t>{ 0, 255, 127, 255 }));
}

TEST(BytePicture, SeenAsItIsStaysAsItIs)
{
  ThreadPool threads(2);
  const BytePicture old = Ramp({ 20, 16 }, { { 3, 2 }, { 17, 15 } });
  const BytePicture seen = SeenAnew(old, glm::dmat3(1.0), old.Size, threads);
  for (int y = 2; y < 15; ++y)
  {
    for (int x = 3; x < 17; ++x)
    {
      for (int c = 0; c < 4; ++c)
      {
        EXPECT_EQ(At(seen, x, y, c), At(old, x, y, c)) << x << " " << y << " " << c;
      }
    }
  }
}

TEST(BytePicture, IsLinearBetweenPixelsOfASmallerOne)
{
  ThreadPool threads(1);
  const BytePicture old = Ramp({ 20, 16 }, { { 0, 0 }, { 20, 16 } });
  const BytePicture seen = SeenAnew(old, glm::dmat3(1.0), { 40, 32 }, threads);
  EXPECT_EQ(seen.Size, glm::ivec2(40, 32));
  for (int x = 1; x < 39; ++x)
  {
    // Pixel centres of the large picture lie at quarters of the small one's pixels.
    EXPECT_NEAR(At(seen, x, 16, 0), 10.0 * ((x + 0.5) / 2.0 - 0.5), 1.0);
  }
}

/// A camera at a distance on the z axis that looks at a point.
glm::dmat4 Camera(const glm::dvec3& eye, const glm::dvec3& at, const glm::dvec3& up)
{
  return glm::perspective(0.6, 1.25, 1.0, 20.0) * glm::lookAt(eye, at, up);
}

TEST(BytePicture, PointsOfThePlaneStayWhereTheyAre)
{
  const glm::dvec3 up(0, 1, 0);
  const glm::dmat4 before = Camera({ 0, 0, 5 }, { 0, 0, 0 }, up);
  for (const glm::dmat4& after :
    { Camera({ 0.4, 0.2, 5 }, { 0.4, 0.2, 0 }, up), Camera({ 0, 0, 4 }, { 0, 0, 0 }, up),
      Camera({ 0, 0, 5 }, { 0, 0, 0 }, { 0.3, 1, 0 }), Camera({ 2, 0.5, 4.5 }, { 0, 0, 0 }, up) })
  {
    const glm::dmat3 toOld = OldPictureOfPlane(before, after, glm::dvec3(0.0));
    for (const glm::dvec4& point :
      { glm::dvec4(0, 0, 0, 1), glm::dvec4(0.7, -0.4, 0, 1), glm::dvec4(-0.5, 0.6, 0, 1) })
    {
      const glm::dvec4 now = after * point;
      const glm::dvec4 then = before * point;
      const glm::dvec3 old = toOld * glm::dvec3(now.x / now.w, now.y / now.w, 1.0);
      EXPECT_NEAR(old.x / old.z, then.x / then.w, 1e-9);
      EXPECT_NEAR(old.y / old.z, then.y / then.w, 1e-9);
    }
  }
}

TEST(BytePicture, APlaneFromBehindIsNotTurned)
{
  const glm::dvec3 up(0, 1, 0);
  const glm::dmat4 before = Camera({ 0, 0, 5 }, { 0, 0, 0 }, up);
  const glm::dmat4 after = Camera({ 0, 0, -5 }, { 0, 0, 0 }, up);
  EXPECT_EQ(OldPictureOfPlane(before, after, glm::dvec3(0.0)), glm::dmat3(1.0));
}

TEST(BytePicture, OneEyeSeesNoParallax)
{
  const glm::ivec2 size(1000, 800);
  const glm::dvec3 up(0, 1, 0);
  const glm::dvec3 eye(0, 0, 5);
  const glm::dmat4 before = Camera(eye, { 0, 0, 0 }, up);
  EXPECT_TRUE(HaveSameEye(before, before, size));
  EXPECT_TRUE(HaveSameEye(before, Camera(eye, { 0, 0, 0 }, { 1, 1, 0 }), size)); // rolls
  EXPECT_TRUE(HaveSameEye(before, Camera(eye, { 0.5, 0.3, 0 }, up), size));      // looks aside
  const glm::dmat4 narrow =
    glm::perspective(0.3, 1.25, 1.0, 20.0) * glm::lookAt(eye, glm::dvec3(0.0), up);
  EXPECT_TRUE(HaveSameEye(before, narrow, size));
  EXPECT_FALSE(HaveSameEye(before, Camera({ 0.01, 0, 5 }, { 0, 0, 0 }, up), size));
  EXPECT_FALSE(HaveSameEye(before, Camera({ 0, 0, 4.9 }, { 0, 0, 0 }, up), size));
  EXPECT_FALSE(HaveSameEye(before, Camera(eye, { 0, 0, 10 }, up), size)); // looks away
}

TEST(BytePicture, ParallelRaysStayWhatTheyAreButForTheirDirection)
{
  const glm::ivec2 size(1000, 800);
  const glm::dvec3 up(0, 1, 0);
  const auto camera = [&](double height, const glm::dvec3& eye, const glm::dvec3& at)
  {
    return glm::ortho(-1.25 * height, 1.25 * height, -height, height, 1.0, 20.0) *
           glm::lookAt(eye, at, up);
  };
  const glm::dmat4 before = camera(2.0, { 0, 0, 5 }, { 0, 0, 0 });
  EXPECT_TRUE(HaveSameEye(before, camera(1.5, { 0, 0, 5 }, { 0, 0, 0 }), size));
  EXPECT_TRUE(HaveSameEye(before, camera(2.0, { 0.7, -0.3, 5 }, { 0.7, -0.3, 0 }), size));
  EXPECT_FALSE(HaveSameEye(before, camera(2.0, { 0.1, 0, 5 }, { 0, 0, 0 }), size));
}

TEST(BytePicture, OneThatEndsAtTheEdgeDoesNotShowAllOfALargerOne)
{
  const glm::dmat3 unit(1.0);
  glm::dmat3 larger(1.0);
  larger[0][0] = larger[1][1] = 1.2; // of the new picture's edges in the old one
  glm::dmat3 within(1.0);
  within[0][0] = within[1][1] = 0.5;
  const BytePicture inside = Ramp({ 20, 16 }, { { 1, 1 }, { 19, 15 } });
  const BytePicture ends = Ramp({ 20, 16 }, { { 1, 1 }, { 20, 15 } });
  EXPECT_TRUE(ShowsAll(inside, larger));
  EXPECT_FALSE(ShowsAll(ends, larger));
  EXPECT_TRUE(ShowsAll(ends, unit));
  EXPECT_TRUE(ShowsAll(ends, within));
}

} // namespace
