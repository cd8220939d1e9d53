// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Render_Scenes_h
#define banyan_Testing_Core_Render_Scenes_h

#include "Base/ThreadPool.h"
#include "Render/Bricks/ArrayBrickSource.h"
#include "Render/Sampling/ImageError.h"
#include "Render/Scene/ProjectionTable.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace scenes
{

using Field = std::function<double(const glm::dvec3&)>; ///< over [0, 1]^3
using Function = std::function<glm::dvec4(double)>;     ///< over [0, 1]

inline double Linear(const glm::dvec3& p)
{
  return 0.1 + 0.3 * p.x + 0.25 * p.y + 0.3 * p.z;
}

inline double Radial(const glm::dvec3& p)
{
  return std::exp(-8.0 * glm::dot(p - 0.5, p - 0.5));
}

/// Eight blobs and two waves: the field of the project's standard scenes, in [0, 1].
inline double Standard(const glm::dvec3& p)
{
  static const double blobs[8][5] = { { .35, .40, .45, .10, 1.0 }, { .65, .55, .40, .08, .9 },
    { .50, .70, .65, .07, .8 }, { .25, .25, .70, .06, .9 }, { .75, .30, .70, .09, .7 },
    { .60, .20, .25, .05, 1.0 }, { .30, .75, .25, .06, .8 }, { .80, .80, .30, .05, .9 } };
  const double pi = std::acos(-1.0);
  double s = 0.1;
  for (const auto& b : blobs)
  {
    const glm::dvec3 away = p - glm::dvec3(b[0], b[1], b[2]);
    s += b[4] * std::exp(-glm::dot(away, away) / (2.0 * b[3] * b[3]));
  }
  s += 0.10 * std::sin(8 * pi * p.x) * std::sin(8 * pi * p.y) * std::sin(8 * pi * p.z);
  s += 0.06 * std::sin(2 * pi * (9 * p.x + 5 * p.y)) * std::sin(2 * pi * (7 * p.z - 3 * p.x));
  const double lo = -0.0597561449;
  const double hi = 1.18257499;
  return std::fmin(std::fmax((s - lo) / (hi - lo), 0.0), 1.0);
}

/// Smooth in colour and opacity; nowhere fully opaque.
inline glm::dvec4 Smooth(double value)
{
  const double x = std::fmin(std::fmax(value, 0.0), 1.0);
  const double pi = std::acos(-1.0);
  return { 0.5 + 0.5 * std::cos(2 * pi * (0.9 * x)), 0.5 + 0.5 * std::cos(2 * pi * (0.9 * x + .33)),
    0.5 + 0.5 * std::cos(2 * pi * (0.9 * x + .67)), 0.001 + 0.12 * x * x };
}

/// Nothing below 0.25, then smooth: most of the standard field is empty.
inline glm::dvec4 Sparse(double value)
{
  const double x = std::fmin(std::fmax((value - 0.25) / 0.75, 0.0), 1.0);
  glm::dvec4 entry = Smooth(value);
  entry.a = 0.4 * x * x;
  return entry;
}

inline banyan::TransferFunction Tabulate(const Function& function, int entries = 4096)
{
  banyan::TransferFunction table;
  for (int i = 0; i < entries; ++i)
  {
    table.Entries.emplace_back(function(i / (entries - 1.0)));
  }
  return table;
}

/// What a table says, in double.
inline Function NearestEntry(const banyan::TransferFunction& table)
{
  return [&table](double value)
  {
    const double last = table.Entries.size() - 1.0;
    const double position = (value - table.Low) / (table.High - table.Low) * last + 0.5;
    const double clamped = std::fmin(std::fmax(std::floor(position), 0.0), last);
    return glm::dvec4(table.Entries[static_cast<std::size_t>(clamped)]);
  };
}

/// Samples of a field at i / (n - 1) per axis, x fastest; an axis of one sample lies at 0.
template <class T = float>
std::vector<T> Sampled(const Field& field, const glm::ivec3& n, double scale = 1, double offset = 0)
{
  std::vector<T> values;
  values.reserve(static_cast<std::size_t>(n.x) * n.y * n.z);
  const glm::dvec3 last = glm::max(glm::dvec3(n - 1), glm::dvec3(1.0));
  for (int z = 0; z < n.z; ++z)
  {
    for (int y = 0; y < n.y; ++y)
    {
      for (int x = 0; x < n.x; ++x)
      {
        values.push_back(static_cast<T>(field(glm::dvec3(x, y, z) / last) * scale + offset));
      }
    }
  }
  return values;
}

/// A whole grid in memory, x fastest.
template <class T>
banyan::SampleArray ArrayOf(const std::vector<T>& values, const glm::ivec3& n)
{
  banyan::SampleArray array;
  array.Values = values.data();
  array.Type = banyan::ScalarTypeOf<T>();
  array.Stride[1] = n.x;
  array.Stride[2] = std::ptrdiff_t{ n.x } * n.y;
  array.Samples = { glm::ivec3(0), n };
  return array;
}

template <class T>
std::function<double(const glm::ivec3&)> ValueOf(const std::vector<T>& values, const glm::ivec3& n)
{
  return [&values, n](const glm::ivec3& p)
  { return static_cast<double>(values[p.x + std::size_t(n.x) * (p.y + std::size_t(n.y) * p.z)]); };
}

inline glm::dvec3 CentreOf(const banyan::Box& cells, const glm::dmat4& toWorld)
{
  return toWorld * glm::dvec4(0.5 * glm::dvec3(cells.Lo + cells.Hi), 1.0);
}

/// A scene that shows the whole grid of n samples from an oblique direction.
/// @param distance of the eye from the centre, in diagonals of the domain
inline banyan::RayScene Scene(const glm::ivec3& n, const glm::ivec2& picture,
  const glm::dmat4& toWorld = glm::dmat4(1.0), double distance = 1.4, bool parallel = false)
{
  const banyan::Box cells{ glm::ivec3(0), n - 1 };
  const glm::dvec3 centre = CentreOf(cells, toWorld);
  const glm::dvec3 corner = toWorld * glm::dvec4(glm::dvec3(cells.Hi), 1.0);
  const double diagonal = 2.0 * glm::length(corner - centre);
  const glm::dvec3 eye = centre + distance * diagonal * glm::dvec3(0.48, 0.36, 0.80);
  const glm::dmat4 view = glm::lookAt(eye, centre, glm::dvec3(0, 1, 0));
  const double aspect = double(picture.x) / picture.y;
  const double half = 0.45 * diagonal;
  const double nearPlane = std::fmax(distance - 0.8, 0.01) * diagonal;
  const double farPlane = (distance + 0.8) * diagonal;
  const glm::dmat4 projection =
    parallel ? glm::ortho(-half * aspect, half * aspect, -half, half, nearPlane, farPlane)
             : glm::perspective(std::acos(-1.0) / 4.0, aspect, nearPlane, farPlane);
  banyan::RayScene scene{ banyan::RayCamera(projection * view, picture, centre),
    { { 0, 0 }, picture }, toWorld, cells, Tabulate(Smooth), 1.0, 2.0f, {} };
  return scene;
}

struct Drawn
{
  banyan::FloatImage Image;
  banyan::RayStatistics Statistics;
};

struct DrawOptions
{
  int BrickCells = 16;
  int Threads = 1;
  std::uint64_t BudgetBytes = std::uint64_t{ 1 } << 30;
};

/// Draws and finishes an array with masks over [0, 1] of its finite range.
inline Drawn Draw(
  const banyan::RayScene& scene, const banyan::SampleArray& array, const DrawOptions& options = {})
{
  banyan::ThreadPool pool(options.Threads);
  const banyan::ValueRange range = banyan::FiniteRange(array, pool);
  const banyan::MaskRange masks =
    range.Empty() ? banyan::MaskRange{} : banyan::MaskRange{ range.Low, range.High };
  banyan::ArrayBrickSource source(array, options.BrickCells, masks, pool);
  Drawn drawn;
  drawn.Image =
    banyan::CastRays(scene, source, scene.DomainCells, options.BudgetBytes, pool, drawn.Statistics);
  banyan::FinishPicture(scene, drawn.Image);
  return drawn;
}

} // namespace scenes

#endif
