// SPDX-License-Identifier: BSD-3-Clause
#include "CameraPath.h"

#include "Base/Error.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace banyan::bench
{
namespace
{

struct Look
{
  glm::dvec3 Eye{ 0.0 };
  glm::dvec3 Center{ 0.0 };
};

/// From where everything is seen to right before a corner, across which the camera then looks.
Look ZoomedTo(const BenchScene& scene, double part)
{
  const glm::dvec3 size = scene.Data->Size();
  const glm::dvec3 target = size * glm::dvec3(0.80, 0.80, 0.80);
  // The eye turns to the corner in the first half of the way.
  const double turned = glm::smoothstep(0.0, 0.5, part);
  Look look;
  look.Center = glm::mix(0.5 * size, target, turned);
  const glm::dvec3 direction =
    glm::normalize(glm::mix(glm::dvec3(0.48, 0.36, 0.80), glm::dvec3(-0.55, 0.75, 0.40), turned));
  look.Eye = look.Center + glm::length(size) * 1.1 * std::pow(0.15 / 1.1, part) * direction;
  return look;
}

Look JumpedTo(const BenchScene& scene, int place)
{
  std::mt19937 random(static_cast<unsigned>(place));
  std::uniform_real_distribution<double> part(0.0, 1.0);
  const auto point = [&]
  {
    const double x = part(random);
    const double y = part(random);
    return glm::dvec3(x, y, part(random));
  };
  const glm::dvec3 size = scene.Data->Size();
  Look look;
  look.Center = size * (0.2 + 0.6 * point());
  const glm::dvec3 direction = glm::normalize(point() - 0.5 + glm::dvec3(1e-3));
  look.Eye = look.Center + glm::length(size) * (0.15 + 0.8 * part(random)) * direction;
  return look;
}

Look LookOf(const BenchScene& scene, const std::string& path, int frame, int frames)
{
  if (path == "zoom")
  {
    return ZoomedTo(scene, frames > 1 ? frame / (frames - 1.0) : 1.0);
  }
  if (path == "rest")
  {
    return ZoomedTo(scene, 0.8);
  }
  if (path == "jumps")
  {
    return JumpedTo(scene, frame / 10);
  }
  throw Error("There is no camera path '" + path + "'; --help lists them.");
}

} // namespace

const std::vector<std::string>& CameraPaths()
{
  static const std::vector<std::string> paths{ "zoom", "rest", "jumps", "standard" };
  return paths;
}

RayScene SceneOnPath(const BenchScene& scene, const std::string& path, int frame, int frames)
{
  if (path == "standard")
  {
    return ToRayScene(scene, 1.0, 1.0f - 1.0f / 255.0f);
  }
  const Look look = LookOf(scene, path, frame, frames);
  RayScene drawn = ToRayScene(scene, 1.0, 1.0f - 1.0f / 255.0f);
  const double diagonal = glm::length(scene.Data->Size());
  const double away = glm::length(look.Eye - 0.5 * scene.Data->Size());
  const glm::dmat4 projection =
    glm::perspective(glm::radians(scene.ViewAngleDegrees), 1.0, 1e-3 * diagonal, away + diagonal);
  drawn.Camera = RayCamera(projection * glm::lookAt(look.Eye, look.Center, scene.Up),
    glm::ivec2(scene.Picture), look.Center);
  return drawn;
}

} // namespace banyan::bench
