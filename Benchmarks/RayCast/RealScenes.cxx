// SPDX-License-Identifier: BSD-3-Clause
#include "RealScenes.h"

#include "RawSeries.h"

#include "Base/Error.h"

#include <algorithm>
#include <cmath>

namespace banyan::bench
{
namespace
{

/// A point of a transfer function; between points it is linear.
struct Point
{
  double Part; ///< of the way from the scene's Low to its High
  double R, G, B;
  double Opacity; ///< over the shortest edge of a cell
};

struct Look
{
  const char* Series;
  const char* Scene;
  bool IsCodes; ///< the values are integers from 0 to 255, and drawn as such
  glm::dvec3 Up;
  double Distance; ///< of the eye, in diagonals
  std::vector<Point> Points;
};

const std::vector<Look>& Looks()
{
  static const std::vector<Look> looks = {
    { "bonsai", "bonsai", true, { 0, 1, 0 }, 0.9,
      { { 0.00, 0.0, 0.0, 0.0, 0.0 }, { 0.13, 0.1, 0.3, 0.1, 0.0 }, { 0.20, 0.2, 0.6, 0.2, 0.06 },
        { 0.30, 0.4, 0.7, 0.2, 0.10 }, { 0.38, 0.6, 0.4, 0.2, 0.15 }, { 0.60, 0.7, 0.5, 0.3, 0.35 },
        { 1.00, 1.0, 0.9, 0.8, 0.60 } } },
    { "engine", "engine", true, { 0, 1, 0 }, 0.9,
      { { 0.00, 0.0, 0.0, 0.0, 0.0 }, { 0.25, 0.4, 0.4, 0.5, 0.0 }, { 0.35, 0.6, 0.6, 0.7, 0.04 },
        { 0.55, 0.8, 0.8, 0.8, 0.08 }, { 0.70, 0.9, 0.6, 0.2, 0.40 },
        { 1.00, 1.0, 0.8, 0.4, 0.80 } } },
    { "isabel_velmag", "isabel", false, { 0, 1, 0 }, 0.9,
      { { 0.00, 0.1, 0.1, 0.5, 0.0 }, { 0.20, 0.1, 0.3, 0.8, 0.01 }, { 0.45, 0.2, 0.8, 0.6, 0.04 },
        { 0.70, 0.9, 0.8, 0.2, 0.15 }, { 1.00, 0.9, 0.1, 0.1, 0.50 } } },
    { "viscous_fingers_run01", "viscous-fingers", false, { 0, 1, 0 }, 1.0,
      { { 0.00, 0.2, 0.3, 0.8, 0.0 }, { 0.08, 0.2, 0.5, 0.9, 0.0 }, { 0.15, 0.3, 0.8, 0.8, 0.06 },
        { 0.50, 0.9, 0.8, 0.4, 0.20 }, { 1.00, 0.9, 0.2, 0.1, 0.50 } } },
    { "turbulence", "turbulence", false, { 0, 1, 0 }, 1.0,
      { { 0.00, 0.0, 0.0, 0.3, 0.0 }, { 0.18, 0.1, 0.2, 0.7, 0.0 }, { 0.30, 0.1, 0.6, 0.8, 0.05 },
        { 0.50, 0.9, 0.8, 0.3, 0.25 }, { 1.00, 1.0, 0.2, 0.1, 0.70 } } },
  };
  return looks;
}

glm::dvec4 Between(const std::vector<Point>& points, double part)
{
  std::size_t next = 1;
  while (next + 1 < points.size() && points[next].Part < part)
  {
    ++next;
  }
  const Point& a = points[next - 1];
  const Point& b = points[next];
  const double way = (part - a.Part) / (b.Part - a.Part);
  return glm::dvec4(a.R, a.G, a.B, a.Opacity) * (1.0 - way) +
         glm::dvec4(b.R, b.G, b.B, b.Opacity) * way;
}

std::shared_ptr<const Volume> LastStep(const RawSeries& series, bool isCodes)
{
  auto volume = std::make_shared<Volume>();
  volume->Samples = series.Samples();
  const float* values = series.Step(series.Steps() - 1);
  volume->Floats.assign(values, values + series.VoxelsPerStep());
  // What cannot be drawn must not make renderers differ.
  for (float& value : volume->Floats)
  {
    value = std::isfinite(value) ? value : 0.0f;
  }
  if (isCodes)
  {
    volume->Codes.assign(volume->Floats.begin(), volume->Floats.end());
    volume->Floats.clear();
  }
  return volume;
}

} // namespace

BenchScene RealScene(const std::string& description, int picture)
{
  const RawSeries series = RawSeries::Open(description);
  const auto look = std::find_if(Looks().begin(), Looks().end(),
    [&](const Look& known) { return series.Name() == known.Series; });
  if (look == Looks().end())
  {
    throw Error("No camera and no transfer function are known for '" + series.Name() + "'.");
  }
  BenchScene scene;
  scene.Name = look->Scene;
  scene.Data = LastStep(series, look->IsCodes);
  scene.Picture = picture;
  scene.Up = look->Up;
  scene.LookFromAfar(look->Distance);
  const auto& floats = scene.Data->Floats;
  const auto [low, high] = std::minmax_element(floats.begin(), floats.end());
  scene.Low = look->IsCodes ? 0.0 : *low;
  scene.High = look->IsCodes ? 255.0 : *high;
  scene.UnitDistance = scene.Data->VoxelLength();
  for (int i = 0; i < 256; ++i)
  {
    scene.Nodes.push_back(Between(look->Points, i / 255.0));
  }
  return scene;
}

} // namespace banyan::bench
