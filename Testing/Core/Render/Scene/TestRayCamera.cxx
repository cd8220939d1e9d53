// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Render/Scene/RayCamera.h"
#include "Render/Scene/Viewpoint.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace
{

using namespace banyan;

const glm::dvec3 EyeAt(3.0, -2.0, 7.0);
const glm::dvec3 LookAt(0.5, 0.25, -1.0);
const glm::ivec2 Picture(64, 48);

glm::dmat4 View()
{
  return glm::lookAt(EyeAt, LookAt, glm::dvec3(0, 1, 0));
}

RayCamera Perspective()
{
  return RayCamera(
    glm::perspective(0.8, 64.0 / 48.0, 0.5, 50.0) * View(), Picture, glm::dvec3(0.0));
}

RayCamera OffAxis()
{
  return RayCamera(
    glm::frustum(-0.1, 0.35, -0.3, 0.05, 0.5, 50.0) * View(), Picture, glm::dvec3(0.0));
}

RayCamera Orthographic(const glm::dvec3& anchor = LookAt)
{
  return RayCamera(glm::ortho(-4.0, 4.0, -3.0, 3.0, 0.5, 50.0) * View(), Picture, anchor);
}

/// Where the pixel centres of a ray's points are, by projecting them.
void ExpectOnPixel(const glm::dmat4& worldToClip, const glm::dvec3& point, int x, int y)
{
  const glm::dvec4 clip = worldToClip * glm::dvec4(point, 1.0);
  EXPECT_NEAR((clip.x / clip.w * 0.5 + 0.5) * Picture.x, x + 0.5, 1e-9);
  EXPECT_NEAR((clip.y / clip.w * 0.5 + 0.5) * Picture.y, y + 0.5, 1e-9);
}

void ExpectNear(const glm::dvec3& a, const glm::dvec3& b, double tolerance)
{
  EXPECT_LE(glm::length(a - b), tolerance) << a.x << " " << a.y << " " << a.z;
}

TEST(RayCamera, PerspectiveRaysStartAtTheEye)
{
  const RayCamera camera = Perspective();
  EXPECT_FALSE(camera.Parallel());
  ExpectNear(camera.Eye(), EyeAt, 1e-12);
  ExpectNear(camera.ViewDirection(), glm::normalize(LookAt - EyeAt), 1e-12);
  const glm::dmat4 matrix = glm::perspective(0.8, 64.0 / 48.0, 0.5, 50.0) * View();
  for (const glm::ivec2& p : { glm::ivec2(0, 0), glm::ivec2(63, 0), glm::ivec2(17, 40) })
  {
    const Ray ray = camera.RayOf(p.x, p.y);
    EXPECT_NEAR(glm::length(ray.Direction), 1.0, 1e-14);
    EXPECT_GT(glm::dot(ray.Direction, camera.ViewDirection()), 0.5);
    ExpectOnPixel(matrix, ray.Origin + 10.0 * ray.Direction, p.x, p.y);
    // Clip planes are planes, not spheres.
    const double slant = glm::dot(ray.Direction, camera.ViewDirection());
    EXPECT_NEAR(ray.Near * slant, 0.5, 1e-12);
    EXPECT_NEAR(ray.Far * slant, 50.0, 1e-9);
  }
}

TEST(RayCamera, OffAxisFrustum)
{
  const RayCamera camera = OffAxis();
  ExpectNear(camera.Eye(), EyeAt, 1e-12);
  const Ray ray = camera.RayOf(5, 40);
  ExpectOnPixel(
    glm::frustum(-0.1, 0.35, -0.3, 0.05, 0.5, 50.0) * View(), ray.Origin + ray.Direction, 5, 40);
}

TEST(RayCamera, ParallelRaysStartInThePlaneOfTheAnchor)
{
  const glm::dvec3 forward = glm::normalize(LookAt - EyeAt);
  const RayCamera camera = Orthographic();
  EXPECT_TRUE(camera.Parallel());
  ExpectNear(camera.ViewDirection(), forward, 1e-12);
  const glm::dmat4 matrix = glm::ortho(-4.0, 4.0, -3.0, 3.0, 0.5, 50.0) * View();
  const double toAnchor = glm::length(LookAt - EyeAt);
  for (const glm::ivec2& p : { glm::ivec2(0, 0), glm::ivec2(63, 47) })
  {
    const Ray ray = camera.RayOf(p.x, p.y);
    ExpectNear(ray.Direction, forward, 1e-12);
    EXPECT_NEAR(glm::dot(ray.Origin - LookAt, forward), 0.0, 1e-12);
    ExpectOnPixel(matrix, ray.Origin, p.x, p.y);
    EXPECT_NEAR(ray.Near, 0.5 - toAnchor, 1e-11);
    EXPECT_NEAR(ray.Far, 50.0 - toAnchor, 1e-11);
  }
  // Another anchor moves t, not the line.
  const Ray moved = Orthographic(LookAt + 2.0 * forward).RayOf(3, 4);
  const Ray ray = camera.RayOf(3, 4);
  ExpectNear(moved.Origin, ray.Origin + 2.0 * forward, 1e-12);
}

TEST(RayCamera, ClipPlanesDoNotMoveTheLattice)
{
  const auto direction = [](double near, double far)
  {
    const glm::dmat4 matrix = glm::perspective(0.8, 64.0 / 48.0, near, far) * View();
    return RayCamera(matrix, Picture, glm::dvec3(0.0)).RayOf(60, 3);
  };
  const Ray a = direction(0.5, 50.0);
  const Ray b = direction(3.0, 11.0);
  ExpectNear(a.Origin, b.Origin, 1e-12);
  ExpectNear(a.Direction, b.Direction, 1e-13);
}

TEST(RayCamera, NegatedMatrixIsTheSameCamera)
{
  const glm::dmat4 matrix = glm::perspective(0.8, 64.0 / 48.0, 0.5, 50.0) * View();
  const Ray a = RayCamera(matrix, Picture, glm::dvec3(0.0)).RayOf(9, 9);
  const RayCamera negated(-matrix, Picture, glm::dvec3(0.0));
  ExpectNear(negated.RayOf(9, 9).Direction, a.Direction, 1e-15);
  EXPECT_FALSE(negated.Footprint(LookAt - 1.0, LookAt + 1.0).Empty());
}

TEST(RayCamera, InfiniteFarPlane)
{
  const glm::dmat4 matrix = glm::infinitePerspective(0.8, 64.0 / 48.0, 0.5) * View();
  const RayCamera camera(matrix, Picture, glm::dvec3(0.0));
  const Ray ray = camera.RayOf(1, 2);
  EXPECT_GT(ray.Far, 1e6);
  ExpectNear(ray.Direction, Perspective().RayOf(1, 2).Direction, 1e-12);
}

TEST(RayCamera, DepthGivesBackTheDistance)
{
  for (const RayCamera& camera : { Perspective(), OffAxis(), Orthographic() })
  {
    const Ray ray = camera.RayOf(11, 29);
    EXPECT_NEAR(camera.DistanceAtDepth(ray, 11, 29, 0.0), ray.Near, 1e-10);
    EXPECT_NEAR(camera.DistanceAtDepth(ray, 11, 29, 1.0), ray.Far, 1e-9);
  }
  const glm::dmat4 matrix = glm::perspective(0.8, 64.0 / 48.0, 0.5, 50.0) * View();
  const Ray ray = Perspective().RayOf(11, 29);
  const glm::dvec4 clip = matrix * glm::dvec4(ray.Origin + 6.5 * ray.Direction, 1.0);
  EXPECT_NEAR(Perspective().DistanceAtDepth(ray, 11, 29, clip.z / clip.w * 0.5 + 0.5), 6.5, 1e-10);
}

TEST(RayCamera, RefusesWhatCannotBeInverted)
{
  EXPECT_THROW(RayCamera(glm::dmat4(0.0), Picture, glm::dvec3(0.0)), Error);
  glm::dmat4 matrix(1.0);
  matrix[1][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(RayCamera(matrix, Picture, glm::dvec3(0.0)), Error);
  EXPECT_THROW(RayCamera(glm::dmat4(1.0), { 0, 5 }, glm::dvec3(0.0)), Error);
}

TEST(RayCamera, OtherSpacesSeeTheSameLines)
{
  glm::dmat4 toWorld = glm::translate(glm::dmat4(1.0), glm::dvec3(1, 2, 3));
  toWorld = glm::rotate(toWorld, 0.7, glm::normalize(glm::dvec3(1, 2, -1)));
  toWorld = glm::scale(toWorld, glm::dvec3(0.5, -2.0, 3.0)); // mirrors
  for (const RayCamera& camera : { Perspective(), OffAxis(), Orthographic() })
  {
    const RayCamera other = camera.InSpace(toWorld);
    EXPECT_EQ(other.Parallel(), camera.Parallel());
    const Ray ray = camera.RayOf(20, 30);
    const Ray there = other.RayOf(20, 30);
    const glm::dvec3 origin(toWorld * glm::dvec4(there.Origin, 1.0));
    const glm::dvec3 direction(toWorld * glm::dvec4(there.Direction, 0.0));
    ExpectNear(glm::normalize(direction), ray.Direction, 1e-11);
    ExpectNear(glm::cross(origin - ray.Origin, ray.Direction), glm::dvec3(0.0), 1e-10);
    EXPECT_NEAR(there.Near * glm::length(direction) + glm::dot(origin - ray.Origin, ray.Direction),
      ray.Near, 1e-10);

    const Viewpoint view = InIndexSpace(camera, toWorld);
    EXPECT_EQ(view.Parallel, camera.Parallel());
    ExpectNear(glm::normalize(view.Direction), other.ViewDirection(), 1e-11);
    if (!camera.Parallel())
    {
      ExpectNear(view.Eye, other.Eye(), 1e-10);
    }
  }
}

bool Meets(const Ray& ray, const glm::dvec3& low, const glm::dvec3& high)
{
  double enter = ray.Near;
  double exit = ray.Far;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double a = (low[axis] - ray.Origin[axis]) / ray.Direction[axis];
    const double b = (high[axis] - ray.Origin[axis]) / ray.Direction[axis];
    enter = std::max(enter, std::min(a, b));
    exit = std::min(exit, std::max(a, b));
  }
  return enter <= exit;
}

TEST(RayCamera, FootprintsCoverTheirBoxes)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> position(-6.0, 8.0);
  int met = 0;
  for (const RayCamera& camera : { Perspective(), OffAxis(), Orthographic() })
  {
    for (int i = 0; i < 300; ++i)
    {
      const glm::dvec3 a(position(random), position(random), position(random));
      const glm::dvec3 b(position(random), position(random), position(random));
      const glm::dvec3 low = glm::min(a, b);
      const glm::dvec3 high = glm::max(a, b); // the eye is inside of some, or beside, or behind
      const PixelRect footprint = camera.Footprint(low, high);
      for (int pixel = i % 3; pixel < Picture.x * Picture.y; pixel += 3)
      {
        const int x = pixel % Picture.x;
        const int y = pixel / Picture.x;
        if (Meets(camera.RayOf(x, y), low, high))
        {
          ++met;
          EXPECT_EQ(Intersection(footprint, PixelRect{ { x, y }, { x + 1, y + 1 } }).Count(), 1);
        }
      }
    }
  }
  EXPECT_GT(met, 10000);
}

TEST(RayCamera, FootprintsAreTight)
{
  // A box that covers pixels [16, 48) x [12, 36) of an orthographic picture from the front.
  const RayCamera camera(
    glm::ortho(0.0, 64.0, 0.0, 48.0, -10.0, 10.0), { 64, 48 }, glm::dvec3(0.0));
  EXPECT_EQ(camera.Footprint({ 16, 12, -1 }, { 48, 36, 1 }), (PixelRect{ { 16, 12 }, { 48, 36 } }));
  // Pixels whose centres are outside do not count: compositors cut pictures off there.
  EXPECT_EQ(
    camera.Footprint({ 16.3, 11.7, -1 }, { 48.3, 35.7, 1 }), (PixelRect{ { 16, 12 }, { 48, 36 } }));
}

TEST(RayCamera, FootprintsOfWhatCannotBeSeen)
{
  const RayCamera camera = Perspective();
  const glm::dvec3 forward = camera.ViewDirection();
  const glm::dvec3 behind = EyeAt - 5.0 * forward;
  EXPECT_TRUE(camera.Footprint(behind - 1.0, behind + 1.0).Empty());
  const glm::dvec3 beyond = EyeAt + 60.0 * forward;
  EXPECT_TRUE(camera.Footprint(beyond - 1.0, beyond + 1.0).Empty());
  const glm::dvec3 beside = EyeAt + 5.0 * forward + 50.0 * glm::dvec3(0, 1, 0);
  EXPECT_TRUE(camera.Footprint(beside - 1.0, beside + 1.0).Empty());
  const PixelRect whole{ { 0, 0 }, Picture };
  EXPECT_EQ(camera.Footprint(EyeAt - 5.0, EyeAt + 5.0), whole);
}

TEST(PixelRect, IntersectionAndUnion)
{
  const PixelRect a{ { 0, 0 }, { 10, 10 } };
  const PixelRect b{ { 5, 8 }, { 20, 9 } };
  EXPECT_EQ(Intersection(a, b), (PixelRect{ { 5, 8 }, { 10, 9 } }));
  EXPECT_EQ(Union(a, b), (PixelRect{ { 0, 0 }, { 20, 10 } }));
  EXPECT_EQ(Intersection(a, PixelRect{ { 11, 0 }, { 12, 1 } }), PixelRect{});
  EXPECT_EQ(Union(PixelRect{ { 7, 7 }, { 7, 9 } }, b), b);
  EXPECT_EQ((PixelRect{ { 0, 0 }, { 1 << 20, 1 << 20 } }).Count(), 1LL << 40);
}

} // namespace
