// SPDX-License-Identifier: BSD-3-Clause
// Segments of several volumes along one ray, against formulas.
#include "Render/Raycast/RayTile.h"
#include "Render/Raycast/SegmentMixer.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace banyan;

/// Segments of a pixel in any order, mixed.
glm::vec4 MixOf(const std::vector<RaySegments>& volumes, float limit = -1.0f)
{
  SegmentMixer mixer(volumes.size());
  for (std::size_t i = 0; i < volumes.size(); ++i)
  {
    mixer.Add(i, volumes[i]);
  }
  std::vector<glm::vec4> pixels(RayTile::Slots, glm::vec4(7.0f));
  mixer.Mix(limit, pixels.data());
  EXPECT_EQ(pixels[1], glm::vec4(0.0f));
  return pixels[0];
}

/// Of a medium with one colour.
RaySegment Segment(double begin, double length, const glm::vec3& color, double density)
{
  RaySegment segment;
  segment.Begin = begin;
  segment.Length = static_cast<float>(length);
  segment.Transmittance = static_cast<float>(std::exp(-density * length));
  for (int i = 0; i < 3; ++i)
  {
    segment.Color[i] = (1.0f - segment.Transmittance) * color[i];
  }
  return segment;
}

TEST(SegmentMixer, AFormula)
{
  const glm::vec3 red(1.0f, 0.1f, 0.0f);
  const glm::vec3 blue(0.0f, 0.2f, 1.0f);
  // Red from 0 to 2, blue from 1 to 3: red alone, both, blue alone.
  const double r = 0.4;
  const double b = 0.9;
  const double first = std::exp(-r);
  const double second = first * std::exp(-r - b);
  const glm::vec3 both = (float(r) * red + float(b) * blue) / float(r + b);
  const glm::vec3 expected = float(1.0 - first) * red + float(first - second) * both +
                             float(second * (1.0 - std::exp(-b))) * blue;
  const auto check = [&](const glm::vec4& pixel)
  {
    EXPECT_NEAR(pixel.a, 1.0 - std::exp(-2.0 * (r + b)), 1e-6);
    for (int i = 0; i < 3; ++i)
    {
      EXPECT_NEAR(pixel[i], expected[i], 1e-6) << i;
    }
  };
  check(MixOf({ { Segment(0, 2, red, r) }, { Segment(1, 2, blue, b) } }));
  check(MixOf({ { Segment(1, 2, blue, b) }, { Segment(0, 2, red, r) } }));
  // However they are cut, and in whatever order parts come.
  RaySegments reds;
  RaySegments blues;
  for (int i = 9; i >= 0; --i)
  {
    reds.push_back(Segment(0.2 * i, 0.2, red, r));
  }
  for (int i = 0; i < 7; ++i)
  {
    blues.push_back(Segment(1.0 + i * 2.0 / 7.0, 2.0 / 7.0, blue, b));
  }
  check(MixOf({ reds, blues }));
}

RaySegment Surface(double at, const glm::vec3& color, float opacity)
{
  RaySegment surface;
  surface.Begin = at;
  surface.Transmittance = 1.0f - opacity;
  for (int i = 0; i < 3; ++i)
  {
    surface.Color[i] = opacity * color[i];
  }
  return surface;
}

/// Layers one behind the other: colour and opacity.
glm::vec4 Layered(const std::vector<glm::vec4>& layers)
{
  glm::dvec4 pixel(0.0);
  for (const glm::vec4& layer : layers)
  {
    pixel += (1.0 - pixel.a) * layer.a * glm::dvec4(layer.r, layer.g, layer.b, 1.0);
  }
  return pixel;
}

TEST(SegmentMixer, SurfacesCutVolumes)
{
  const glm::vec3 red(1.0f, 0.1f, 0.0f);
  const glm::vec3 blue(0.0f, 0.2f, 1.0f);
  const auto medium = [&](double length)
  { return glm::vec4(red, float(1.0 - std::exp(-0.6 * length))); };
  const glm::vec4 surface(blue, 0.3f);
  const auto check = [&](const RaySegments& surfaces, int cuts, glm::vec4 expected)
  {
    RaySegments reds;
    for (int i = 0; i < cuts; ++i)
    {
      reds.push_back(Segment(2.0 + 2.0 * i / cuts, 2.0 / cuts, red, 0.6));
    }
    for (const glm::vec4& pixel : { MixOf({ surfaces, reds }), MixOf({ reds, surfaces }) })
    {
      for (int i = 0; i < 4; ++i)
      {
        EXPECT_NEAR(pixel[i], expected[i], 1e-6) << cuts << ", " << i;
      }
    }
  };
  for (const int cuts : { 1, 2, 7 })
  {
    // Before the volume, where it begins, in it, where it ends, and behind it.
    for (const double at : { 1.0, 2.0, 2.7, 3.0, 4.0, 5.0 })
    {
      const double inside = std::clamp(at - 2.0, 0.0, 2.0);
      check({ Surface(at, blue, 0.3f) }, cuts,
        Layered({ medium(inside), surface, medium(2.0 - inside) }));
    }
    // One behind the other, in any order.
    check({ Surface(3.5, red, 0.8f), Surface(1.0, blue, 0.3f), Surface(2.5, blue, 0.3f) }, cuts,
      Layered({ surface, medium(0.5), surface, medium(1.0), glm::vec4(red, 0.8f), medium(0.5) }));
    // An opaque one hides what is behind it.
    check({ Surface(3.0, blue, 1.0f) }, cuts, Layered({ medium(1.0), glm::vec4(blue, 1.0f) }));
    // Two of one colour in one place let through what both do.
    check({ Surface(3.0, blue, 0.3f), Surface(3.0, blue, 0.5f) }, cuts,
      Layered({ medium(1.0), glm::vec4(blue, 0.65f), medium(1.0) }));
    // Of two colours, equally opaque, each counts the same.
    check({ Surface(3.0, blue, 0.5f), Surface(3.0, red, 0.5f) }, cuts,
      Layered({ medium(1.0), glm::vec4(0.5f * (red + blue), 0.75f), medium(1.0) }));
  }
  // Without a volume, on surfaces of two volumes.
  const glm::vec4 both = MixOf({ { Surface(3.0, blue, 0.3f) }, { Surface(1.0, red, 0.5f) } });
  const glm::vec4 expected = Layered({ glm::vec4(red, 0.5f), surface });
  for (int i = 0; i < 4; ++i)
  {
    EXPECT_NEAR(both[i], expected[i], 1e-6) << i;
  }
}

TEST(SegmentMixer, OpaqueAndNothing)
{
  RaySegment wall = Segment(1.0, 0.5, glm::vec3(0.0f, 1.0f, 0.0f), 1.0);
  wall.Transmittance = 0.0f;
  wall.Color[1] = 1.0f;
  const RaySegment mist = Segment(0.0, 3.0, glm::vec3(1.0f), 0.1);
  const glm::vec4 pixel = MixOf({ { mist }, { wall } });
  EXPECT_NEAR(pixel.a, 1.0f, 1e-6);
  const double before = std::exp(-0.1);
  EXPECT_NEAR(pixel.r, 1.0 - before, 2e-3);
  EXPECT_NEAR(pixel.g, 1.0, 1e-3);
  EXPECT_EQ(MixOf({ {}, {} }), glm::vec4(0.0f));
  // Far from where t is 0.
  const double far = 1e9;
  const glm::vec4 there = MixOf(
    { { Segment(far, 1, glm::vec3(1.0f), 0.5) }, { Segment(far + 0.5, 1, glm::vec3(1.0f), 0.5) } });
  EXPECT_NEAR(there.a, 1.0 - std::exp(-1.0), 1e-6);
  // A ray ends at the limit.
  RaySegments many;
  for (int i = 0; i < 10; ++i)
  {
    many.push_back(Segment(i, 1.0, glm::vec3(1.0f), 1.0));
  }
  EXPECT_NEAR(MixOf({ many }, 0.05f).a, 1.0 - std::exp(-3.0), 1e-6);
}

} // namespace
