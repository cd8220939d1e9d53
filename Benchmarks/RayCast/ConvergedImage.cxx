// SPDX-License-Identifier: BSD-3-Clause
#include "ConvergedImage.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace banyan::bench
{
namespace
{

constexpr double NothingLeft = 1e-7;
/// Below this series are as exact as the library's functions, within 1e-12, and several times
/// faster.
constexpr double Small = 0.01;

/// -log(1 - a)
double DepthOf(double a)
{
  return a < Small
           ? a * (1.0 + a * (1.0 / 2 + a * (1.0 / 3 + a * (1.0 / 4 + a * (1.0 / 5 + a / 6)))))
           : -std::log1p(-a);
}

/// 1 - exp(-depth)
double OpacityOf(double depth)
{
  return depth < Small
           ? depth * (1.0 - depth / 2 * (1.0 - depth / 3 * (1.0 - depth / 4 * (1.0 - depth / 5))))
           : -std::expm1(-depth);
}

template <class T>
class ConvergedRays
{
public:
  ConvergedRays(const BenchScene& scene, const T* values, double sampleDistance)
    : Scene(scene)
    , Values(values)
    , Last(scene.Data->Samples - 1)
    , StrideY(scene.Data->Samples.x)
    , StrideZ(StrideY * scene.Data->Samples.y)
    , Step(sampleDistance * scene.Data->VoxelLength())
    , Camera(ToRayScene(scene, sampleDistance, 2.0f, 2).Camera)
  {
  }

  glm::dvec4 Integrate(int x, int y) const
  {
    const Ray ray = this->Camera.RayOf(x, y);
    const glm::dvec3 spacing = this->Scene.Data->Spacing;
    const glm::dvec3 origin = ray.Origin / spacing;
    const glm::dvec3 way = ray.Direction / spacing;
    const auto [enter, exit] = RayInterval(ray, origin, way, this->Last);
    glm::dvec3 color(0.0);
    double transmittance = 1.0;
    for (double k = std::floor(enter / this->Step);
         k * this->Step < exit && transmittance > NothingLeft; k += 1.0)
    {
      const double begin = std::max(k * this->Step, enter);
      const double end = std::min((k + 1.0) * this->Step, exit);
      const glm::dvec3 position = origin + 0.5 * (begin + end) * way;
      const glm::dvec4 entry = this->Scene.At(this->Interpolate(position));
      if (entry.a > 0.0 && end > begin)
      {
        const double depth = DepthOf(entry.a) * (end - begin) / this->Scene.UnitDistance;
        const double opacity = OpacityOf(depth);
        const double light = this->Scene.Shaded ? this->LightAt(position, ray.Direction) : 1.0;
        color += transmittance * opacity * light * glm::dvec3(entry);
        transmittance *= 1.0 - opacity;
      }
    }
    return { color, 1.0 - transmittance };
  }

private:
  double Interpolate(const glm::dvec3& anywhere) const
  {
    std::ptrdiff_t offset = 0;
    glm::dvec3 part;
    const std::ptrdiff_t strides[3] = { 1, this->StrideY, this->StrideZ };
    for (int axis = 0; axis < 3; ++axis)
    {
      const double position =
        std::clamp(anywhere[axis], 0.0, static_cast<double>(this->Last[axis]));
      const int cell = std::min(static_cast<int>(position), this->Last[axis] - 1);
      part[axis] = position - cell;
      offset += cell * strides[axis];
    }
    const T* corner = this->Values + offset;
    const auto alongX = [&](std::ptrdiff_t edge)
    { return corner[edge] + part.x * (double(corner[edge + 1]) - corner[edge]); };
    const double bottom = alongX(0) + part.y * (alongX(this->StrideY) - alongX(0));
    const double front = alongX(this->StrideZ);
    const double top = front + part.y * (alongX(this->StrideZ + this->StrideY) - front);
    return bottom + part.z * (top - bottom);
  }

  /// 0.3 + 0.7 |n . d|.
  double LightAt(const glm::dvec3& position, const glm::dvec3& direction) const
  {
    glm::dvec3 gradient;
    for (int axis = 0; axis < 3; ++axis)
    {
      gradient[axis] = this->SlopeAt(position, axis) / this->Scene.Data->Spacing[axis];
    }
    const double length = glm::length(gradient);
    return 0.3 + (length > 0.0 ? 0.7 * std::abs(glm::dot(gradient, direction)) / length : 0.0);
  }

  /// Per voxel: linear between the planes of samples before and behind.
  double SlopeAt(const glm::dvec3& position, int axis) const
  {
    const int cell =
      std::clamp(static_cast<int>(position[axis]), 0, std::max(this->Last[axis] - 1, 0));
    if (cell > 0 && cell + 1 < this->Last[axis])
    {
      // The same, in half the time.
      glm::dvec3 offset(0.0);
      offset[axis] = 1.0;
      return 0.5 * (this->Interpolate(position + offset) - this->Interpolate(position - offset));
    }
    const double part = std::clamp(position[axis] - cell, 0.0, 1.0);
    return (1.0 - part) * this->SlopeInPlane(position, axis, cell) +
           part * this->SlopeInPlane(position, axis, cell + 1);
  }

  /// The difference of the planes on both sides, and at the faces of the volume that of one side.
  double SlopeInPlane(glm::dvec3 position, int axis, int plane) const
  {
    const int before = std::max(plane - 1, 0);
    const int behind = std::min(plane + 1, this->Last[axis]);
    position[axis] = behind;
    const double high = this->Interpolate(position);
    position[axis] = before;
    return (high - this->Interpolate(position)) / std::max(behind - before, 1);
  }

  const BenchScene& Scene;
  const T* Values;
  glm::ivec3 Last;
  std::ptrdiff_t StrideY;
  std::ptrdiff_t StrideZ;
  double Step;
  RayCamera Camera;
};

template <class T>
FloatImage Integrate(
  const BenchScene& scene, const T* values, double sampleDistance, ThreadPool& pool)
{
  const ConvergedRays<T> rays(scene, values, sampleDistance);
  FloatImage image;
  image.Rect = { glm::ivec2(0), glm::ivec2(scene.Picture) };
  image.Pixels.resize(static_cast<std::size_t>(image.Rect.Count()));
  pool.ParallelFor(scene.Picture,
    [&](std::int64_t y)
    {
      for (int x = 0; x < scene.Picture; ++x)
      {
        image.At(x, static_cast<int>(y)) = rays.Integrate(x, static_cast<int>(y));
      }
    });
  return image;
}

/// FNV-1a over words of eight bytes (the last one filled up): quick, and nobody is out to deceive.
class Hash
{
public:
  void Add(const void* bytes, std::size_t count)
  {
    const char* begin = static_cast<const char*>(bytes);
    for (std::size_t i = 0; i < count; i += 8)
    {
      std::uint64_t word = 0;
      std::memcpy(&word, begin + i, std::min<std::size_t>(8, count - i));
      this->Value = (this->Value ^ word) * 1099511628211u;
      this->Value ^= this->Value >> 29;
    }
  }
  template <class T>
  void AddNumbers(const std::vector<T>& numbers)
  {
    this->Add(numbers.data(), numbers.size() * sizeof(T));
  }
  std::uint64_t Value = 14695981039346656037u;
};

/// Of how pictures are defined: another one makes kept pictures useless. 2: at faces, gradients are
/// differences of one side.
constexpr double Definition = 2.0;

std::uint64_t HashOf(const BenchScene& scene, double sampleDistance)
{
  const Volume& data = *scene.Data;
  Hash hash;
  hash.AddNumbers(data.Floats);
  hash.AddNumbers(data.Codes);
  hash.AddNumbers(scene.Nodes);
  hash.AddNumbers(std::vector<double>{ static_cast<double>(data.Samples.x),
    static_cast<double>(data.Samples.y), static_cast<double>(data.Samples.z), data.Spacing.x,
    data.Spacing.y, data.Spacing.z, scene.Eye.x, scene.Eye.y, scene.Eye.z, scene.Center.x,
    scene.Center.y, scene.Center.z, scene.Up.x, scene.Up.y, scene.Up.z, scene.ViewAngleDegrees,
    static_cast<double>(scene.Picture), scene.Low, scene.High, scene.UnitDistance,
    scene.Shaded ? Definition : 0.0, sampleDistance });
  return hash.Value;
}

} // namespace

FloatImage ConvergedImage(const BenchScene& scene, double sampleDistance, ThreadPool& pool)
{
  const Volume& data = *scene.Data;
  return data.Codes.empty() ? Integrate(scene, data.Floats.data(), sampleDistance, pool)
                            : Integrate(scene, data.Codes.data(), sampleDistance, pool);
}

FloatImage CachedConvergedImage(
  const BenchScene& scene, double sampleDistance, const std::string& folder, ThreadPool& pool)
{
  char hash[32];
  std::snprintf(
    hash, sizeof(hash), "%016llx", static_cast<unsigned long long>(HashOf(scene, sampleDistance)));
  const std::filesystem::path path =
    std::filesystem::path(folder) / (scene.Name + "-" + hash + ".reference");
  FloatImage image;
  image.Rect = { glm::ivec2(0), glm::ivec2(scene.Picture) };
  image.Pixels.resize(static_cast<std::size_t>(image.Rect.Count()));
  const auto bytes = static_cast<std::streamsize>(image.Pixels.size() * sizeof(image.Pixels[0]));
  std::ifstream earlier(path, std::ios::binary);
  if (earlier.read(reinterpret_cast<char*>(image.Pixels.data()), bytes))
  {
    return image;
  }
  image = ConvergedImage(scene, sampleDistance, pool);
  const std::filesystem::path unfinished = path.string() + ".partial";
  std::ofstream file(unfinished, std::ios::binary);
  file.write(reinterpret_cast<const char*>(image.Pixels.data()), bytes);
  file.close();
  std::error_code problem;
  std::filesystem::rename(unfinished, path, problem);
  if (!file || problem)
  {
    throw Error("The reference picture cannot be kept.", { path.string() });
  }
  return image;
}

} // namespace banyan::bench
