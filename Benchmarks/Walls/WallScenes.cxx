// SPDX-License-Identifier: BSD-3-Clause
#include "WallScenes.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Parallel/Fields/DrawnField.h"
#include "Render/Sampling/SamplingPlan.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace banyan::bench
{
namespace
{

/// Two waves over a plane of the volume, one row after the other.
struct Waves
{
  int Width;
  std::vector<float> Sines;
  std::vector<float> Cosines;

  /// @param length of the waves, in samples
  Waves(int width, int height, double length)
    : Width(width)
  {
    const double turn = 2.0 * std::acos(-1.0) / length;
    for (int v = 0; v < height; ++v)
    {
      for (int u = 0; u < width; ++u)
      {
        const double bent = turn * u + 1.3 * std::sin(0.37 * turn * v);
        this->Sines.push_back(static_cast<float>(std::sin(bent)));
        this->Cosines.push_back(static_cast<float>(std::cos(turn * v + std::sin(0.23 * turn * u))));
      }
    }
  }
  std::size_t At(int u, int v) const { return static_cast<std::size_t>(v) * this->Width + u; }
};

/// Bent gyroids, thin where the volume ends.
void FillSlice(Volume& volume, int z, const Waves& xy, const Waves& yz, const Waves& xz)
{
  const glm::ivec3 samples = volume.Samples;
  const auto away = [&](int axis, int at)
  {
    const double part = 2.0 * at / (samples[axis] - 1.0) - 1.0;
    return static_cast<float>(part * part * part * part);
  };
  std::vector<float> border;
  border.reserve(static_cast<std::size_t>(samples.x));
  for (int x = 0; x < samples.x; ++x)
  {
    border.push_back(away(0, x));
  }
  for (int y = 0; y < samples.y; ++y)
  {
    const float thin = 0.35f + 0.9f * (away(1, y) + away(2, z));
    const float sine = yz.Sines[yz.At(y, z)];
    const float cosine = yz.Cosines[yz.At(y, z)];
    const float* const ofXyS = &xy.Sines[xy.At(0, y)];
    const float* const ofXyC = &xy.Cosines[xy.At(0, y)];
    const float* const ofXzS = &xz.Sines[xz.At(0, z)];
    const float* const ofXzC = &xz.Cosines[xz.At(0, z)];
    std::uint8_t* const to =
      &volume.Codes[(static_cast<std::size_t>(z) * samples.y + y) * samples.x];
    for (int x = 0; x < samples.x; ++x)
    {
      const float value = ofXyS[x] * cosine + sine * ofXzC[x] + ofXzS[x] * ofXyC[x];
      const float inside = 200.0f * (value - thin - 0.9f * border[x]);
      to[x] = static_cast<std::uint8_t>(std::min(std::max(inside, 0.0f), 255.0f));
    }
  }
}

/// Nine in ten samples cannot be seen.
std::vector<glm::dvec4> Function()
{
  constexpr int nodes = 256;
  constexpr int firstVisible = 40;
  const double turn = 2.0 * std::acos(-1.0);
  std::vector<glm::dvec4> function;
  for (int i = 0; i < nodes; ++i)
  {
    const double x = i / (nodes - 1.0);
    const double seen = (i - firstVisible) / (nodes - 1.0 - firstVisible);
    function.emplace_back(0.5 + 0.5 * std::cos(turn * 0.9 * x),
      0.5 + 0.5 * std::cos(turn * (0.9 * x + 0.33)), 0.5 + 0.5 * std::cos(turn * (0.9 * x + 0.67)),
      i < firstVisible ? 0.0 : 0.02 + 0.28 * seen);
  }
  return function;
}

/// Whether all corners of the volume are in the middle nine tenths of the picture.
bool Fits(const glm::dmat4& worldToClip, const glm::dvec3& size)
{
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec3 at(
      (corner & 1) ? size.x : 0.0, (corner & 2) ? size.y : 0.0, (corner & 4) ? size.z : 0.0);
    const glm::dvec4 clip = worldToClip * glm::dvec4(at, 1.0);
    if (!(clip.w > 0.0) || std::max(std::abs(clip.x), std::abs(clip.y)) > 0.9 * clip.w)
    {
      return false;
    }
  }
  return true;
}

} // namespace

BenchScene WallScene(const std::string& name, double part, ThreadPool& pool)
{
  if (name != "deep" && name != "flat")
  {
    throw Error("There is no volume '" + name + "': deep and flat are there.");
  }
  const glm::dvec3 full = name == "deep" ? glm::dvec3(512, 512, 2048) : glm::dvec3(4096, 2048, 128);
  auto volume = std::make_shared<Volume>();
  const glm::ivec3 samples = glm::max(glm::ivec3(glm::round(part * full)), glm::ivec3(2));
  volume->Samples = samples;
  volume->Codes.resize(static_cast<std::size_t>(samples.x) * samples.y * samples.z);
  const double length = 0.25 * std::min({ samples.x, samples.y, samples.z });
  const Waves xy(samples.x, samples.y, length);
  const Waves yz(samples.y, samples.z, length);
  const Waves xz(samples.x, samples.z, length);
  pool.ParallelFor(
    samples.z, [&](std::int64_t z) { FillSlice(*volume, static_cast<int>(z), xy, yz, xz); });
  BenchScene scene;
  scene.Name = name;
  scene.Center = 0.5 * volume->Size();
  scene.Low = 0.0;
  scene.High = 255.0;
  scene.UnitDistance = std::min({ samples.x, samples.y, samples.z }) / 256.0;
  scene.Nodes = Function();
  scene.Data = std::move(volume);
  return scene;
}

RayScene SeenOnWall(
  const BenchScene& scene, const std::string& view, const glm::ivec2& picture, double pan)
{
  if (view != "whole" && view != "turned-30" && view != "turned-80" && view != "zoomed")
  {
    throw Error(
      "There is no view '" + view + "': whole, turned-30, turned-80 and zoomed are there.");
  }
  const double turn = glm::radians(view == "turned-30" ? 30.0 : view == "turned-80" ? 80.0 : 0.0);
  const double lift = glm::radians(12.0);
  const glm::dvec3 way(
    std::sin(turn) * std::cos(lift), std::sin(lift), std::cos(turn) * std::cos(lift));
  const glm::dvec3 size = scene.Data->Size();
  const double diagonal = glm::length(size);
  const double half =
    std::tan(glm::radians(15.0)); // of the picture's height, one away from the eye
  const double aspect = static_cast<double>(picture.x) / picture.y;
  const auto clipFrom = [&](double away, double enlarged)
  {
    const double near = std::max(away - 0.55 * diagonal, 0.01 * away);
    const double up = near * half / enlarged;
    return glm::frustum(-up * aspect, up * aspect, -up, up, near, away + 0.55 * diagonal) *
           glm::lookAt(scene.Center + away * way, scene.Center, glm::dvec3(0.0, 1.0, 0.0));
  };
  double low = 0.1 * diagonal;
  double high = 10.0 * diagonal;
  for (int step = 0; step < 40; ++step)
  {
    const double middle = 0.5 * (low + high);
    (Fits(clipFrom(middle, 1.0), size) ? high : low) = middle;
  }
  const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), glm::dvec3(2.0 * pan, 0.0, 0.0));
  RayScene seen = ToRayScene(scene, 1.0, 0.999f);
  seen.Camera =
    RayCamera(moved * clipFrom(high, view == "zoomed" ? 4.0 : 1.0), picture, scene.Center);
  seen.Viewport = { glm::ivec2(0), picture };
  return seen;
}

RayScene PlannedOnWall(const BenchScene& scene, BrickSource& source, const std::string& view,
  const Wall& wall, double pan, ThreadPool& pool)
{
  RayScene planned = SeenOnWall(scene, view, wall.Size, pan);
  const auto draw = [&](const RayScene& probe)
  {
    RayStatistics statistics;
    return CastViewport(probe, source, probe.DomainCells, ~std::uint64_t{ 0 }, pool, statistics);
  };
  const int coarsest = DrawnField::CoarsestLevelOf(planned.DomainCells.Size());
  const SamplingPlan plan = PlanSamplings(planned, { 1.0, planned.SampleDistance, coarsest }, draw);
  planned.Samplings = plan.Samplings;
  planned.OpacityLimit = plan.OpacityLimit;
  return planned;
}

} // namespace banyan::bench
