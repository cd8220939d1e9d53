// SPDX-License-Identifier: BSD-3-Clause
// Would integrals over the values between samples (pre-integration) be worth their second look-up?
//
//   banyan-bench-preintegration [SERIES.json...]
//
// Prints, as CSV, errors of pictures of 64^2 pixels against samples 1/16 of a voxel apart, of the
// standard scenes and of real data as banyan-bench-raycast takes it, for three ways to integrate
// over an interval: the entry of its middle, the mean over the values between its ends, and the
// mean over those that the slope at its middle spans. Slow and obvious: double precision, no tables
// but sums. And what a sample takes in a plain loop with tables, and the tables themselves
// (PreIntegrationTimes.h).
#include "PreIntegrationTimes.h"
#include "RealScenes.h"
#include "StandardScenes.h"

#include "Base/ThreadPool.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace
{

using namespace banyan;
using namespace banyan::bench;

constexpr int Pixels = 64;

class Integrator
{
public:
  explicit Integrator(const BenchScene& scene)
    : Data(*scene.Data)
    , Scene(ToRayScene(scene, 1.0, 1.0f))
    , WorldToIndex(glm::inverse(this->Scene.IndexToWorld))
  {
    for (const glm::vec4& entry : this->Scene.Transfer.Entries)
    {
      const double opacity = std::min<double>(entry.a, 1.0 - 1e-7);
      const double extinction = -std::log1p(-opacity) / this->Scene.Transfer.UnitDistance;
      const glm::dvec4 now(glm::dvec3(entry) * extinction, extinction);
      this->Sums.push_back(this->Sums.empty()
                             ? glm::dvec4(0.0)
                             : this->Sums.back() + 0.5 * (this->Entries.back() + now));
      this->Entries.push_back(now);
    }
  }

  /// Premultiplied colour of a pixel.
  /// @param voxels sample distance
  glm::dvec3 Pixel(int x, int y, double voxels, Method method) const
  {
    const Ray ray = this->Scene.Camera.RayOf(x, y);
    const glm::dvec3 origin(this->WorldToIndex * glm::dvec4(ray.Origin, 1.0));
    const glm::dvec3 direction = glm::dmat3(this->WorldToIndex) * ray.Direction;
    double enter = ray.Near;
    double exit = ray.Far;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double low = -origin[axis] / direction[axis];
      const double high = (this->Data.Samples[axis] - 1 - origin[axis]) / direction[axis];
      enter = std::max(enter, std::min(low, high));
      exit = std::min(exit, std::max(low, high));
    }
    const auto value = [&](double t)
    { return this->EntryOf(this->ValueAt(origin + direction * t)); };
    const double step = voxels * this->Data.VoxelLength();
    glm::dvec3 colour(0.0);
    double transmittance = 1.0;
    for (double number = std::floor(enter / step); number * step < exit; ++number)
    {
      const double begin = std::max(enter, number * step);
      const double length = std::min(exit, (number + 1.0) * step) - begin;
      if (length > 0.0)
      {
        const glm::dvec4 mean = this->MeanOf(value, begin, length, method);
        const double opacity = -std::expm1(-mean.a * length);
        colour +=
          transmittance * opacity * (mean.a > 0.0 ? glm::dvec3(mean) / mean.a : glm::dvec3(0.0));
        transmittance *= 1.0 - opacity;
      }
    }
    return colour;
  }

private:
  template <class Value>
  glm::dvec4 MeanOf(const Value& value, double begin, double length, Method method) const
  {
    const double middle = begin + 0.5 * length;
    if (method == Method::Ends)
    {
      return this->MeanBetween(value(begin), value(begin + length), value(middle));
    }
    if (method == Method::Slope)
    {
      const double away = 1e-3 * this->Data.VoxelLength();
      const double rise =
        (value(middle + away) - value(middle - away)) / (2.0 * away) * 0.5 * length;
      return this->MeanBetween(value(middle) - rise, value(middle) + rise, value(middle));
    }
    return this->Entries[Nearest(value(middle))];
  }

  glm::dvec4 MeanBetween(double a, double b, double middle) const
  {
    const std::size_t first = Nearest(this->Inside(a));
    const std::size_t last = Nearest(this->Inside(b));
    return first == last ? this->Entries[Nearest(middle)]
                         : (this->Sums[last] - this->Sums[first]) /
                             (static_cast<double>(last) - static_cast<double>(first));
  }

  static std::size_t Nearest(double entry) { return static_cast<std::size_t>(entry + 0.5); }

  double Inside(double entry) const
  {
    return std::clamp(entry, 0.0, static_cast<double>(this->Entries.size() - 1));
  }

  double EntryOf(double value) const
  {
    const TransferFunction& transfer = this->Scene.Transfer;
    return this->Inside((value - transfer.Low) / (transfer.High - transfer.Low) *
                        static_cast<double>(this->Entries.size() - 1));
  }

  double ValueAt(const glm::dvec3& p) const
  {
    const glm::ivec3 n = this->Data.Samples;
    const glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(p)), glm::ivec3(0), n - 2);
    const glm::dvec3 part = p - glm::dvec3(cell);
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner)
    {
      const glm::ivec3 far(corner & 1, corner >> 1 & 1, corner >> 2);
      const glm::ivec3 at = cell + far;
      const std::size_t index =
        at.x + static_cast<std::size_t>(n.x) * (at.y + static_cast<std::size_t>(n.y) * at.z);
      const double value =
        this->Data.Codes.empty() ? this->Data.Floats[index] : this->Data.Codes[index];
      const glm::dvec3 weight = glm::mix(1.0 - part, part, glm::dvec3(far));
      sum += value * weight.x * weight.y * weight.z;
    }
    return sum;
  }

  const Volume& Data;
  RayScene Scene;
  glm::dmat4 WorldToIndex;
  std::vector<glm::dvec4> Entries; ///< colour times extinction, extinction
  std::vector<glm::dvec4> Sums;    ///< of the entries up to each, by trapezoids
};

std::vector<glm::dvec3> Draw(
  const Integrator& integrator, double voxels, Method method, ThreadPool& pool)
{
  std::vector<glm::dvec3> picture(std::size_t{ Pixels } * Pixels);
  pool.ParallelFor(static_cast<std::int64_t>(picture.size()),
    [&](std::int64_t pixel)
    {
      picture[static_cast<std::size_t>(pixel)] = integrator.Pixel(
        static_cast<int>(pixel % Pixels), static_cast<int>(pixel / Pixels), voxels, method);
    });
  return picture;
}

void Compare(const BenchScene& scene, ThreadPool& pool)
{
  const Integrator integrator(scene);
  const std::vector<glm::dvec3> exact = Draw(integrator, 1.0 / 16.0, Method::Middle, pool);
  const std::pair<Method, const char*> methods[] = { { Method::Middle, "middle" },
    { Method::Ends, "ends" }, { Method::Slope, "slope" } };
  for (const auto& [method, name] : methods)
  {
    for (const double voxels : { 0.5, 1.0, 2.0 })
    {
      const std::vector<glm::dvec3> picture = Draw(integrator, voxels, method, pool);
      double largest = 0.0;
      double squares = 0.0;
      for (std::size_t i = 0; i < picture.size(); ++i)
      {
        const glm::dvec3 error = glm::abs(picture[i] - exact[i]) * 255.0;
        largest = std::max({ largest, error.r, error.g, error.b });
        squares += glm::dot(error, error);
      }
      const MethodTimes times = TimesOf(scene, voxels, method);
      std::printf("%s,%s,%g,%.4f,%.4f,%.2f,%.2f\n", scene.Name.c_str(), name, voxels, largest,
        std::sqrt(squares / (3.0 * static_cast<double>(picture.size()))),
        times.NanosecondsPerSample, times.TableMilliseconds);
    }
  }
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    ThreadPool& pool = ThreadPool::Process();
    std::printf("scene,method,sample_distance,max_error,rms_error,ns_per_sample,table_ms\n");
    const auto standard = StandardVolume(256, pool);
    Compare(StandardScene(standard, StandardFunction::S1, false, Pixels), pool);
    Compare(StandardScene(standard, StandardFunction::S2, false, Pixels), pool);
    for (int i = 1; i < argc; ++i)
    {
      Compare(RealScene(argv[i], Pixels), pool);
    }
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
