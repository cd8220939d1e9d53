// SPDX-License-Identifier: BSD-3-Clause
#include "PlaybackScene.h"

#include "Base/Error.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace banyan::bench
{
namespace
{

constexpr int Entries = 4096;
constexpr double Pi = 3.14159265358979324;

/// Opacity of an edge of a cell at a part of the range.
/// @param shift of the function, in parts of the range
double OpacityAt(const std::string& name, double part, double shift)
{
  part -= shift;
  if (name == "ramp")
  {
    return part < 0.004 ? 0.0 : 0.15 * std::min(part, 1.0);
  }
  if (name == "top")
  {
    return part < 0.7 ? 0.0 : 0.3;
  }
  if (name == "ends")
  {
    const double away = std::abs(part - 0.5) * 2.0;
    return away < 0.1 ? 0.0 : 0.2 * std::min(away, 1.0);
  }
  throw Error("There is no function '" + name + "'; --help lists them.");
}

TransferFunction FunctionOf(const std::string& name, const ValueRange& range, double shift)
{
  TransferFunction function;
  function.Low = range.Low;
  function.High = range.High;
  for (int i = 0; i < Entries; ++i)
  {
    const double part = i / (Entries - 1.0);
    const auto wave = [part](double phase)
    { return 0.5 + 0.5 * std::cos(2.0 * Pi * (0.9 * part + phase)); };
    function.Entries.emplace_back(wave(0.0), wave(0.33), wave(0.67), OpacityAt(name, part, shift));
  }
  return function;
}

RayCamera CameraOf(const FieldPlace& place, int picture, double turn)
{
  const glm::dvec3 low(place.Bounds[0], place.Bounds[2], place.Bounds[4]);
  const glm::dvec3 high(place.Bounds[1], place.Bounds[3], place.Bounds[5]);
  const glm::dvec3 centre = 0.5 * (low + high);
  const double diagonal = glm::length(high - low);
  const glm::dvec3 from(
    glm::rotate(glm::dmat4(1.0), turn, glm::dvec3(0, 1, 0)) * glm::dvec4(0.48, 0.36, 0.80, 0.0));
  const glm::dmat4 view = glm::lookAt(centre + 1.4 * diagonal * from, centre, glm::dvec3(0, 1, 0));
  const glm::dmat4 projection = glm::perspective(Pi / 4.5, 1.0, 0.5 * diagonal, 2.5 * diagonal);
  return { projection * view, { picture, picture }, centre };
}

} // namespace

RayScene MakePlaybackScene(
  const PlaybackOptions& options, const FieldPlace& place, const ValueRange& range, int frame)
{
  const double turn = options.Mode == PlayMode::Turn ? frame * Pi / 90.0 : 0.0;
  // Half a hundredth of the range to and fro.
  const double shift =
    options.Mode == PlayMode::Function ? 0.0005 * std::abs(frame % 20 - 10) : 0.0;
  RayScene scene{ CameraOf(place, options.Picture, turn),
    { { 0, 0 }, { options.Picture, options.Picture } }, place.IndexToPhysical, place.Cells,
    FunctionOf(options.Function, range, shift), place.CellSize };
  scene.Transfer.UnitDistance = place.CellSize;
  scene.Shading.On = options.Shaded;
  return scene;
}

} // namespace banyan::bench
