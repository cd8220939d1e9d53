// SPDX-License-Identifier: BSD-3-Clause
#include "HotBlobs.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace banyan
{

namespace
{

constexpr float Pi = 3.1415927f;
constexpr int BallCount = 3;
constexpr int RippleCount = 48;
constexpr float Waviness = 0.12f; ///< standard deviation of a surface, in radii

/// In [low, high). The standard's own distributions may differ between libraries; this does not.
float Uniform(std::mt19937_64& random, float low, float high)
{
  return low + (high - low) * static_cast<float>(random() >> 40) / 16777216.0f;
}

} // namespace

HotBlobs::HotBlobs(std::uint64_t seed, float edgeWidth)
  : EdgeWidth(edgeWidth)
{
  std::mt19937_64 random(seed);
  const float turn = Uniform(random, 0.0f, 2.0f * Pi);
  for (int i = 0; i < BallCount; ++i)
  {
    Ball ball;
    // Around the axis of the box, apart from each other, low enough to have room to rise.
    const float angle = turn + 2.0f * Pi * i / BallCount + Uniform(random, -0.3f, 0.3f);
    const float away = Uniform(random, 0.9f, 1.25f);
    ball.Centre = { Pi + away * std::cos(angle), Pi + away * std::sin(angle),
      Uniform(random, 1.0f, 1.6f) };
    ball.Radius = Uniform(random, 0.5f, 0.8f);
    for (int j = 0; j < RippleCount; ++j)
    {
      // A direction uniform on the sphere, and two to seven waves along a circumference.
      const float up = Uniform(random, -1.0f, 1.0f);
      const float around = Uniform(random, 0.0f, 2.0f * Pi);
      const float number = Uniform(random, 2.0f, 7.0f) / ball.Radius;
      const float flat = std::sqrt(1.0f - up * up);
      ball.Ripples.push_back(
        { { number * flat * std::cos(around), number * flat * std::sin(around), number * up },
          Uniform(random, 0.0f, 2.0f * Pi), Waviness * std::sqrt(2.0f / RippleCount) });
    }
    this->Balls.push_back(ball);
  }
}

float HotBlobs::InBall(const Ball& ball, float x, float y, float z) const
{
  const float d[3] = { x - ball.Centre[0], y - ball.Centre[1], z - ball.Centre[2] };
  const float distance = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  // Far from the edge the ripples cannot matter, and tanh is 1 to the last bit.
  const float reach = 6.0f * Waviness * ball.Radius + 10.0f * this->EdgeWidth;
  if (std::abs(distance - ball.Radius) > reach)
  {
    return distance < ball.Radius ? 1.0f : 0.0f;
  }
  float swell = 0.0f;
  for (const Ripple& ripple : ball.Ripples)
  {
    swell += ripple.Amplitude * std::cos(ripple.WaveVector[0] * d[0] + ripple.WaveVector[1] * d[1] +
                                         ripple.WaveVector[2] * d[2] + ripple.Phase);
  }
  return 0.5f - 0.5f * std::tanh((distance - ball.Radius * (1.0f + swell)) / this->EdgeWidth);
}

float HotBlobs::Temperature(float x, float y, float z) const
{
  float cold = 1.0f;
  for (const Ball& ball : this->Balls)
  {
    cold *= 1.0f - this->InBall(ball, x, y, z);
  }
  return 1.0f - cold;
}

} // namespace banyan
