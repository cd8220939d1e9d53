// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Render_Analytic_h
#define banyan_Testing_Core_Render_Analytic_h

#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace analytic
{

/// A level of 8 bits.
constexpr double OneLevel = 1.0 / 255.0;

/// The part of a ray inside a box: points Origin + t * Direction with Enter <= t <= Exit.
struct Chord
{
  glm::dvec3 Origin;
  glm::dvec3 Direction;
  double Enter = 0.0;
  double Exit = 0.0;

  double Length() const { return std::max(0.0, this->Exit - this->Enter); }
  glm::dvec3 At(double t) const { return this->Origin + t * this->Direction; }
};

/// What a pixel's ray sees of a box from the origin to `size`. Shares only the camera with the ray
/// caster.
inline Chord ChordOf(const banyan::RayCamera& camera, const glm::dvec3& size, int x, int y)
{
  const banyan::Ray ray = camera.RayOf(x, y);
  Chord chord{ ray.Origin, ray.Direction, ray.Near, ray.Far };
  for (int axis = 0; axis < 3; ++axis)
  {
    if (ray.Direction[axis] != 0.0)
    {
      const double a = -ray.Origin[axis] / ray.Direction[axis];
      const double b = (size[axis] - ray.Origin[axis]) / ray.Direction[axis];
      chord.Enter = std::max(chord.Enter, std::min(a, b));
      chord.Exit = std::min(chord.Exit, std::max(a, b));
    }
    else if (ray.Origin[axis] < 0.0 || ray.Origin[axis] > size[axis])
    {
      chord.Exit = chord.Enter;
    }
  }
  return chord;
}

/// Opacity per unit distance of an extinction.
inline double OpacityOf(double extinction)
{
  return -std::expm1(-extinction);
}

/// The premultiplied picture of a chord in closed form.
using Integral = std::function<glm::dvec4(const Chord&)>;

/// Requires every pixel of a picture to be the integral, within `bound` per channel, and the
/// picture to show something. Failures name the place of the call.
inline void ExpectIntegral(const banyan::FloatImage& image, const banyan::RayScene& scene,
  const glm::dvec3& size, const Integral& integral, double bound,
  const char* file = __builtin_FILE(), int line = __builtin_LINE())
{
  const ::testing::ScopedTrace trace(file, line, "ExpectIntegral");
  double worst = 0.0;
  double strongest = 0.0;
  for (int y = scene.Viewport.Lo.y; y < scene.Viewport.Hi.y; ++y)
  {
    for (int x = scene.Viewport.Lo.x; x < scene.Viewport.Hi.x; ++x)
    {
      const Chord chord = ChordOf(scene.Camera, size, x, y);
      const glm::dvec4 truth = chord.Length() > 0.0 ? integral(chord) : glm::dvec4(0.0);
      const banyan::PixelRect& rect = image.Rect;
      const bool drawn = x >= rect.Lo.x && x < rect.Hi.x && y >= rect.Lo.y && y < rect.Hi.y;
      const glm::dvec4 pixel = drawn ? glm::dvec4(image.At(x, y)) : glm::dvec4(0.0);
      for (int channel = 0; channel < 4; ++channel)
      {
        const double difference = std::abs(pixel[channel] - truth[channel]);
        // Not std::max: a NaN has to come through.
        worst = difference <= worst ? worst : difference;
      }
      strongest = std::max(strongest, truth.a);
    }
  }
  EXPECT_LE(worst, bound);
  EXPECT_GT(strongest, 0.1) << "the test sees nothing";
}

} // namespace analytic

#endif
