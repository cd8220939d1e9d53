// SPDX-License-Identifier: BSD-3-Clause
#include "PreIntegrationTimes.h"

#include "Base/Timer.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan::bench
{
namespace
{

constexpr int Plain = 4096;  ///< entries, as the ray caster's
constexpr int Between = 512; ///< entries for each end
constexpr int Repetitions = 5;
/// Rays lie as close together as those of large pictures, since neighbours use the same samples.
constexpr int Picture = 1024;
constexpr int Part = 64; ///< pixels in its middle, per side

BenchScene OfSize(BenchScene scene, int pixels)
{
  scene.Picture = pixels;
  return scene;
}

/// Premultiplied colours, and transmittances, of intervals of one length.
std::vector<glm::vec4> PlainTable(const BenchScene& scene, double length)
{
  std::vector<glm::vec4> table;
  for (int i = 0; i < Plain; ++i)
  {
    const glm::dvec4 entry = scene.At(scene.Low + (scene.High - scene.Low) * i / (Plain - 1.0));
    const double left = std::pow(1.0 - std::min(entry.a, 1.0 - 1e-7), length / scene.UnitDistance);
    table.emplace_back(glm::vec3(entry) * static_cast<float>(1.0 - left), left);
  }
  return table;
}

/// The same for values that rise from one to another, front by back.
std::vector<glm::vec4> TableBetween(const BenchScene& scene, double length)
{
  std::vector<glm::dvec4> entries;
  std::vector<glm::dvec4> sums{ glm::dvec4(0.0) };
  for (int i = 0; i < Between; ++i)
  {
    const glm::dvec4 entry = scene.At(scene.Low + (scene.High - scene.Low) * i / (Between - 1.0));
    const double extinction = -std::log1p(-std::min(entry.a, 1.0 - 1e-7)) / scene.UnitDistance;
    entries.emplace_back(glm::dvec3(entry) * extinction, extinction);
    sums.push_back(sums.back() + entries.back());
  }
  std::vector<glm::vec4> table;
  table.reserve(std::size_t{ Between } * Between);
  for (int front = 0; front < Between; ++front)
  {
    for (int back = 0; back < Between; ++back)
    {
      const auto low = static_cast<std::size_t>(std::min(front, back));
      const auto high = static_cast<std::size_t>(std::max(front, back));
      const glm::dvec4 mean = (sums[high + 1] - sums[low]) / static_cast<double>(high - low + 1);
      const double left = std::exp(-mean.a * length);
      const glm::dvec3 colour = mean.a > 0.0 ? glm::dvec3(mean) / mean.a : glm::dvec3(0.0);
      table.emplace_back(glm::vec3(colour * (1.0 - left)), left);
    }
  }
  return table;
}

template <class T>
class Loop
{
public:
  Loop(const BenchScene& scene, const T* values, double voxels)
    : Scene(ToRayScene(OfSize(scene, Picture), 1.0, 1.0f))
    , Values(values)
    , Last(scene.Data->Samples - 1)
    , StrideY(scene.Data->Samples.x)
    , StrideZ(this->StrideY * scene.Data->Samples.y)
    , Step(voxels * scene.Data->VoxelLength())
    , Low(static_cast<float>(scene.Low))
    , PerValue(static_cast<float>(1.0 / (scene.High - scene.Low)))
  {
  }

  /// @return nanoseconds per sample; sum is there to be used
  template <Method Way>
  double Draw(const std::vector<glm::vec4>& table, float& sum) const
  {
    std::int64_t samples = 0;
    const Timer timer;
    for (int y = (Picture - Part) / 2; y < (Picture + Part) / 2; ++y)
    {
      for (int x = (Picture - Part) / 2; x < (Picture + Part) / 2; ++x)
      {
        sum += this->Ray<Way>(x, y, table, samples);
      }
    }
    return 1e9 * timer.Seconds() / static_cast<double>(std::max<std::int64_t>(samples, 1));
  }

private:
  template <Method Way>
  float Ray(int x, int y, const std::vector<glm::vec4>& table, std::int64_t& samples) const
  {
    const banyan::Ray ray = this->Scene.Camera.RayOf(x, y);
    const glm::dmat4 toIndex = glm::inverse(this->Scene.IndexToWorld);
    const glm::dvec3 origin(toIndex * glm::dvec4(ray.Origin, 1.0));
    const glm::dvec3 way = glm::dmat3(toIndex) * ray.Direction;
    const auto [enter, exit] = RayInterval(ray, origin, way, this->Last);
    const auto count = static_cast<std::int64_t>(std::max(0.0, (exit - enter) / this->Step));
    const glm::vec3 step(way * this->Step);
    glm::vec3 at(origin + way * (Way == Method::Ends ? enter : enter + 0.5 * this->Step));
    glm::vec3 colour(0.0f);
    float left = 1.0f;
    float front = Way == Method::Ends ? this->At(at) : 0.0f;
    for (std::int64_t i = 0; i < count; ++i)
    {
      glm::vec4 entry;
      if (Way == Method::Middle)
      {
        entry = table[Number(this->At(at), Plain)];
        at += step;
      }
      else if (Way == Method::Ends)
      {
        at += step;
        const float back = this->At(at);
        entry = table[Number(front, Between) * Between + Number(back, Between)];
        front = back;
      }
      else
      {
        const float low = this->At(at - 0.5f * step);
        const float high = this->At(at + 0.5f * step);
        const float shift = this->At(at) - 0.5f * (low + high);
        entry = table[Number(low + shift, Between) * Between + Number(high + shift, Between)];
        at += step;
      }
      colour += left * glm::vec3(entry);
      left *= entry.a;
    }
    samples += count;
    return colour.r + left;
  }

  static std::size_t Number(float part, int entries)
  {
    const float inside = std::min(std::max(part, 0.0f), 1.0f);
    return static_cast<std::size_t>(inside * static_cast<float>(entries - 1) + 0.5f);
  }

  /// The value there, as a part of the function's range.
  float At(const glm::vec3& position) const
  {
    const T* corner = this->Values;
    glm::vec3 part;
    const std::ptrdiff_t strides[3] = { 1, this->StrideY, this->StrideZ };
    for (int axis = 0; axis < 3; ++axis)
    {
      const float inside =
        std::min(std::max(position[axis], 0.0f), static_cast<float>(this->Last[axis]));
      const int cell = std::min(static_cast<int>(inside), this->Last[axis] - 1);
      part[axis] = inside - static_cast<float>(cell);
      corner += cell * strides[axis];
    }
    const auto alongX = [&](std::ptrdiff_t edge)
    {
      const auto begin = static_cast<float>(corner[edge]);
      return begin + part.x * (static_cast<float>(corner[edge + 1]) - begin);
    };
    const float bottom = alongX(0) + part.y * (alongX(this->StrideY) - alongX(0));
    const float behind = alongX(this->StrideZ);
    const float top = behind + part.y * (alongX(this->StrideZ + this->StrideY) - behind);
    return (bottom + part.z * (top - bottom) - this->Low) * this->PerValue;
  }

  RayScene Scene;
  const T* Values;
  glm::ivec3 Last;
  std::ptrdiff_t StrideY;
  std::ptrdiff_t StrideZ;
  double Step;
  float Low;
  float PerValue;
};

template <class T>
MethodTimes Measure(const BenchScene& scene, const T* values, double voxels, Method method)
{
  const Timer building;
  const double length = voxels * scene.Data->VoxelLength();
  const std::vector<glm::vec4> table =
    method == Method::Middle ? PlainTable(scene, length) : TableBetween(scene, length);
  MethodTimes times{ std::numeric_limits<double>::infinity(), 1e3 * building.Seconds() };
  const Loop<T> loop(scene, values, voxels);
  float sum = 0.0f;
  for (int i = 0; i < Repetitions; ++i)
  {
    const double nanoseconds =
      method == Method::Middle ? loop.template Draw<Method::Middle>(table, sum)
      : method == Method::Ends ? loop.template Draw<Method::Ends>(table, sum)
                               : loop.template Draw<Method::Slope>(table, sum);
    times.NanosecondsPerSample = std::min(times.NanosecondsPerSample, nanoseconds);
  }
  // Uses the sum, so that no compiler leaves the pictures out.
  times.TableMilliseconds += std::isfinite(sum) ? 0.0 : 1e-300;
  return times;
}

} // namespace

MethodTimes TimesOf(const BenchScene& scene, double voxels, Method method)
{
  const Volume& data = *scene.Data;
  return data.Codes.empty() ? Measure(scene, data.Floats.data(), voxels, method)
                            : Measure(scene, data.Codes.data(), voxels, method);
}

} // namespace banyan::bench
