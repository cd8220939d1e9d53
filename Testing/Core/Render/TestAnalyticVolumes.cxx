// SPDX-License-Identifier: BSD-3-Clause
// Volumes whose picture is known in closed form.
#include "Render/Analytic.h"

namespace
{

using namespace banyan;
using analytic::Chord;
using analytic::ExpectIntegral;
using analytic::OneLevel;
using analytic::OpacityOf;

const glm::ivec3 Samples(17, 12, 21);
const glm::dvec3 Spacing(1.0, 1.6, 0.7);
const glm::dvec3 Size = glm::dvec3(Samples - 1) * Spacing;
const glm::ivec2 Pixels(40, 33);

enum class View
{
  Perspective,
  Parallel,
  Inside
};
constexpr View Views[] = { View::Perspective, View::Parallel, View::Inside };

RayScene SceneOf(View view, double sampleDistance)
{
  const glm::dmat4 toWorld = glm::scale(glm::dmat4(1.0), Spacing);
  RayScene scene = scenes::Scene(
    Samples, Pixels, toWorld, view == View::Inside ? 0.1 : 1.4, view == View::Parallel);
  scene.SampleDistance = sampleDistance;
  return scene;
}

/// 0 at one face, 1 at the opposite one.
scenes::Field Ramp(int axis)
{
  return [axis](const glm::dvec3& p) { return p[axis]; };
}

/// Draws with a transfer function over [0, 1] from all three viewpoints and compares.
void ExpectEverywhere(const scenes::Field& field, const scenes::Function& function,
  double sampleDistance, const analytic::Integral& integral, double bound,
  const char* file = __builtin_FILE(), int line = __builtin_LINE())
{
  const testing::ScopedTrace trace(file, line, "ExpectEverywhere");
  const std::vector<float> values = scenes::Sampled(field, Samples);
  for (const View view : Views)
  {
    SCOPED_TRACE(static_cast<int>(view));
    RayScene scene = SceneOf(view, sampleDistance);
    scene.Transfer = scenes::Tabulate(function);
    const scenes::Drawn drawn = scenes::Draw(scene, scenes::ArrayOf(values, Samples));
    ExpectIntegral(drawn.Image, scene, Size, integral, bound);
  }
}

TEST(AnalyticVolumes, ConstantVolumesAbsorbByLength)
{
  const glm::dvec3 color(0.9, 0.4, 0.1);
  for (const double extinction : { 0.02, 0.3, 4.0 })
  {
    for (const double step : { 0.37, 1.0, 5.0 }) // what a step is does not matter
    {
      SCOPED_TRACE(testing::Message() << extinction << ", " << step);
      ExpectEverywhere([](const glm::dvec3&) { return 0.6; },
        [&](double) { return glm::dvec4(color, OpacityOf(extinction)); }, step,
        [&](const Chord& chord)
        { return glm::dvec4(color, 1.0) * OpacityOf(extinction * chord.Length()); },
        1e-4);
    }
  }
}

TEST(AnalyticVolumes, UnitDistanceIsALength)
{
  const std::vector<float> values = scenes::Sampled([](const glm::dvec3&) { return 0.5; }, Samples);
  for (const double unit : { 0.25, 3.0 })
  {
    RayScene scene = SceneOf(View::Perspective, 0.9);
    scene.Transfer = scenes::Tabulate([](double) { return glm::dvec4(1, 1, 1, OpacityOf(0.05)); });
    scene.Transfer.UnitDistance = unit;
    ExpectIntegral(
      scenes::Draw(scene, scenes::ArrayOf(values, Samples)).Image, scene, Size,
      [&](const Chord& chord) { return glm::dvec4(OpacityOf(0.05 * chord.Length() / unit)); },
      1e-4);
  }
}

TEST(AnalyticVolumes, RampsOfExtinctionAbsorbByTheirMean)
{
  // On a straight line a linear extinction has the mean of its ends.
  const double most = 0.25;
  const glm::dvec3 color(0.2, 0.7, 1.0);
  for (int axis = 0; axis < 3; ++axis)
  {
    ExpectEverywhere(
      Ramp(axis), [&](double value) { return glm::dvec4(color, OpacityOf(most * value)); }, 0.3,
      [&](const Chord& chord)
      {
        const double middle = chord.At(0.5 * (chord.Enter + chord.Exit))[axis] / Size[axis];
        return glm::dvec4(color, 1.0) * OpacityOf(most * middle * chord.Length());
      },
      0.3 * OneLevel);
  }
}

TEST(AnalyticVolumes, RampsOfColorAreSeenFrontToBack)
{
  // The integral of (a + b t) k exp(-k t) from 0 to L.
  const double k = 0.12;
  for (int axis = 0; axis < 3; ++axis)
  {
    ExpectEverywhere(
      Ramp(axis), [&](double value) { return glm::dvec4(value, 1.0 - value, 0.5, OpacityOf(k)); },
      0.3,
      [&](const Chord& chord)
      {
        const double length = chord.Length();
        const double a = chord.At(chord.Enter)[axis] / Size[axis];
        const double b = chord.Direction[axis] / Size[axis];
        const double left = std::exp(-k * length);
        const double ramp = a * (1.0 - left) + b * (1.0 - left * (1.0 + k * length)) / k;
        return glm::dvec4(ramp, 1.0 - left - ramp, 0.5 * (1.0 - left), 1.0 - left);
      },
      0.3 * OneLevel);
  }
}

TEST(AnalyticVolumes, HalvesHideEachOther)
{
  // Red below one half, green above, each with an extinction of its own: what lies in front counts
  // in full. The border is met within half a step.
  const double red = 0.10;
  const double green = 0.15;
  const double step = 0.05;
  for (int axis = 0; axis < 3; ++axis)
  {
    ExpectEverywhere(
      Ramp(axis),
      [&](double value)
      {
        return value < 0.5 ? glm::dvec4(1, 0, 0, OpacityOf(red))
                           : glm::dvec4(0, 1, 0, OpacityOf(green));
      },
      step,
      [&](const Chord& chord)
      {
        const double border = (0.5 * Size[axis] - chord.Origin[axis]) / chord.Direction[axis];
        const double change = std::clamp(border, chord.Enter, chord.Exit);
        const bool redFirst = chord.At(0.5 * (chord.Enter + change))[axis] < 0.5 * Size[axis];
        const double first = change - chord.Enter;
        const double second = chord.Exit - change;
        const bool redSecond = chord.At(0.5 * (change + chord.Exit))[axis] < 0.5 * Size[axis];
        const double front = OpacityOf((redFirst ? red : green) * first);
        const double back = (1.0 - front) * OpacityOf((redSecond ? red : green) * second);
        return glm::dvec4((redFirst ? front : 0.0) + (redSecond ? back : 0.0),
          (redFirst ? 0.0 : front) + (redSecond ? 0.0 : back), 0.0, front + back);
      },
      OneLevel);
  }
}

TEST(AnalyticVolumes, BallsAbsorbByTheirImpactParameter)
{
  // A ball of extinction exp(-r^2 / (2 g^2)): its integral along a line that passes the centre at a
  // distance d is sqrt(2 pi) g exp(-d^2 / (2 g^2)).
  const int n = 49;
  const double g = 6.0;
  const double most = 0.12;
  const glm::dvec3 size(n - 1.0);
  const std::vector<float> values = scenes::Sampled(
    [&](const glm::dvec3& p)
    {
      const glm::dvec3 away = (p - 0.5) * (n - 1.0);
      return std::exp(-glm::dot(away, away) / (2.0 * g * g));
    },
    glm::ivec3(n));
  for (const bool parallel : { false, true })
  {
    RayScene scene = scenes::Scene(glm::ivec3(n), Pixels, glm::dmat4(1.0), 1.4, parallel);
    scene.SampleDistance = 0.5;
    scene.Transfer =
      scenes::Tabulate([&](double value) { return glm::dvec4(1, 1, 1, OpacityOf(most * value)); });
    ExpectIntegral(
      scenes::Draw(scene, scenes::ArrayOf(values, glm::ivec3(n))).Image, scene, size,
      [&](const Chord& chord)
      {
        const glm::dvec3 d = glm::cross(0.5 * size - chord.Origin, chord.Direction);
        const double depth =
          most * std::sqrt(2.0 * std::acos(-1.0)) * g * std::exp(-glm::dot(d, d) / (2.0 * g * g));
        return glm::dvec4(OpacityOf(depth));
      },
      OneLevel);
  }
}

TEST(AnalyticVolumes, EndsOfRaysCountByTheirLength)
{
  // Chords that are shorter than a step, at edges and corners, and depths inside the volume.
  const std::vector<float> values = scenes::Sampled([](const glm::dvec3&) { return 0.5; }, Samples);
  RayScene scene = SceneOf(View::Perspective, 30.0); // longer than any chord
  scene.Transfer = scenes::Tabulate([](double) { return glm::dvec4(1, 1, 1, OpacityOf(0.1)); });
  ExpectIntegral(
    scenes::Draw(scene, scenes::ArrayOf(values, Samples)).Image, scene, Size,
    [](const Chord& chord) { return glm::dvec4(OpacityOf(0.1 * chord.Length())); }, 1e-4);
}

} // namespace
