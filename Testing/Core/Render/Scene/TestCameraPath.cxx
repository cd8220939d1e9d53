// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scene/CameraPath.h"

#include <glm/gtc/matrix_transform.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace banyan;

/// Of a camera that turns about an axis beside the origin, and looks at that.
glm::dmat4 Orbit(double angle)
{
  const glm::dvec3 focus(3.0, -2.0, 1.0);
  const glm::dvec3 eye = focus + 10.0 * glm::dvec3(std::cos(angle), std::sin(angle), 0.3);
  return glm::lookAt(eye, focus, glm::dvec3(0.0, 0.0, 1.0));
}

double Difference(const glm::dmat4& a, const glm::dmat4& b)
{
  double worst = 0.0;
  for (int i = 0; i < 16; ++i)
  {
    worst = std::max(worst, std::abs(a[i / 4][i % 4] - b[i / 4][i % 4]));
  }
  return worst;
}

TEST(CameraPath, AnEvenTurnGoesOn)
{
  CameraPath path;
  path.Add(Orbit(0.9), 0.96); // another pace before: the last move counts
  path.Add(Orbit(1.00), 1.00);
  path.Add(Orbit(1.05), 1.04);
  EXPECT_LT(Difference(path.After(0.0), Orbit(1.05)), 1e-12);
  EXPECT_LT(Difference(path.After(0.2), Orbit(1.30)), 1e-9);
  EXPECT_LT(Difference(path.After(0.05), Orbit(1.10)), 1e-9) << "whole moves";
  EXPECT_LT(Difference(path.After(99.0), Orbit(1.05 + 16 * 0.05)), 1e-9);
}

TEST(CameraPath, AnEvenWalkGoesOn)
{
  CameraPath path;
  const auto at = [](double way)
  { return glm::translate(Orbit(0.4), way * glm::dvec3(1.0, 0.5, -2.0)); };
  path.Add(at(1.0), 10.0);
  path.Add(at(1.5), 10.1);
  EXPECT_LT(Difference(path.After(0.3), at(3.0)), 1e-9);
}

TEST(CameraPath, NothingIsKnownOfACameraAtRest)
{
  CameraPath path;
  path.Add(Orbit(0.0), 1.0);
  EXPECT_EQ(Difference(path.After(1.0), Orbit(0.0)), 0.0);
  path.Add(Orbit(0.5), 1.3);
  EXPECT_EQ(Difference(path.After(1.0), Orbit(0.5)), 0.0) << "a move of 0.3 s";
  path.Add(Orbit(0.6), 1.3);
  EXPECT_EQ(Difference(path.After(1.0), Orbit(0.6)), 0.0) << "two moves at once";
  path.Begin();
  path.Add(Orbit(0.7), 1.4);
  EXPECT_EQ(Difference(path.After(1.0), Orbit(0.7)), 0.0);
}

} // namespace
