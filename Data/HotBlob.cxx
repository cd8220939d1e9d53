#include "HotBlob.h"

#include <cmath>
#include <random>

namespace banyan
{

namespace
{

constexpr float Centre[3] = { 3.1415927f, 3.1415927f, 1.25f };
constexpr float Radius = 0.85f;
constexpr float Waviness = 0.12f; ///< standard deviation of the surface, in radii
constexpr int RippleCount = 48;

/// In [0, 1). The standard's own distributions may differ between libraries; this does not.
float Uniform(std::mt19937_64& random)
{
  return static_cast<float>(random() >> 40) / 16777216.0f;
}

} // namespace

HotBlob::HotBlob(std::uint64_t seed, float edgeWidth)
  : EdgeWidth(edgeWidth)
{
  std::mt19937_64 random(seed);
  for (int i = 0; i < RippleCount; ++i)
  {
    // A direction uniform on the sphere, and two to seven waves along a circumference.
    const float up = 2.0f * Uniform(random) - 1.0f;
    const float around = 6.2831853f * Uniform(random);
    const float number = (2.0f + 5.0f * Uniform(random)) / Radius;
    const float flat = std::sqrt(1.0f - up * up);
    this->Ripples.push_back(
      { { number * flat * std::cos(around), number * flat * std::sin(around), number * up },
        6.2831853f * Uniform(random), Waviness * std::sqrt(2.0f / RippleCount) });
  }
}

float HotBlob::Temperature(float x, float y, float z) const
{
  const float d[3] = { x - Centre[0], y - Centre[1], z - Centre[2] };
  const float distance = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  // Far from the edge the ripples cannot matter, and tanh is 1 to the last bit.
  const float reach = 6.0f * Waviness * Radius + 10.0f * this->EdgeWidth;
  if (std::abs(distance - Radius) > reach)
  {
    return distance < Radius ? 1.0f : 0.0f;
  }
  float swell = 0.0f;
  for (const Ripple& ripple : this->Ripples)
  {
    swell += ripple.Amplitude * std::cos(ripple.WaveVector[0] * d[0] + ripple.WaveVector[1] * d[1] +
                                         ripple.WaveVector[2] * d[2] + ripple.Phase);
  }
  return 0.5f - 0.5f * std::tanh((distance - Radius * (1.0f + swell)) / this->EdgeWidth);
}

} // namespace banyan
