// SPDX-License-Identifier: BSD-3-Clause
#include "JetInflow.h"

#include <cmath>
#include <random>

namespace banyan
{

namespace
{

constexpr double Pi = 3.141592653589793;
constexpr int WaveCount = 48;
/// What is less of a nozzle than this is none.
constexpr double ProfileCutOff = 1e-4;

/// In [low, high). The standard's own distributions may differ between libraries; this does not.
double Uniform(std::mt19937_64& random, double low, double high)
{
  return low + (high - low) * static_cast<double>(random() >> 11) / 9007199254740992.0;
}

std::array<double, 3> Direction(std::mt19937_64& random)
{
  const double up = Uniform(random, -1.0, 1.0);
  const double around = Uniform(random, 0.0, 2.0 * Pi);
  const double flat = std::sqrt(1.0 - up * up);
  return { flat * std::cos(around), flat * std::sin(around), up };
}

} // namespace

JetInflow::JetInflow(std::uint64_t seed, int size, const JetParameters& parameters)
  : Parameters(parameters)
  , Cell(2.0 * Pi / size)
  , Nozzle(static_cast<int>(std::ceil(0.5 * parameters.FringeWidth / this->Cell)))
{
  for (int z = 0; z < size; ++z)
  {
    const double place = z * this->Cell / parameters.FringeWidth;
    const double wave = std::sin(Pi * place);
    this->Rates.push_back(
      place < 1.0 ? static_cast<float>(parameters.FringeRate * wave * wave) : 0.0f);
  }
  for (int y = 0; y < size; ++y)
  {
    for (int x = 0; x < size; ++x)
    {
      this->Profiles.push_back(static_cast<float>(this->Profile(x * this->Cell, y * this->Cell)));
    }
  }
  std::mt19937_64 random(seed);
  for (int i = 0; i < WaveCount; ++i)
  {
    // Wave lengths from half a diameter to three, the longer ones stronger.
    const double length =
      parameters.Diameter * std::exp(Uniform(random, std::log(0.5), std::log(3.0)));
    const auto along = Direction(random), other = Direction(random);
    Wave wave;
    double squared = 0.0;
    for (int c = 0; c < 3; ++c)
    {
      wave.Number[c] = 2.0 * Pi / length * along[c];
      const int next = (c + 1) % 3, last = (c + 2) % 3;
      wave.Amplitude[c] = along[next] * other[last] - along[last] * other[next];
      squared += wave.Amplitude[c] * wave.Amplitude[c];
    }
    // Each wave has the mean energy of its share; a cosine's mean square is one half.
    const double strength =
      parameters.Unsteadiness * parameters.Speed * std::sqrt(3.0 * 2.0 / WaveCount / squared);
    for (double& amplitude : wave.Amplitude)
    {
      amplitude *= strength;
    }
    wave.Phase = Uniform(random, 0.0, 2.0 * Pi);
    this->Waves.push_back(wave);
  }
}

double JetInflow::Profile(double x, double y) const
{
  const double radius = std::hypot(x - Pi, y - Pi);
  const double profile =
    0.5 + 0.5 * std::tanh((0.5 * this->Parameters.Diameter - radius) / this->Parameters.EdgeWidth);
  return profile < ProfileCutOff ? 0.0 : profile;
}

float JetInflow::MeanSpeed(float x, float y) const
{
  return static_cast<float>(this->Parameters.CoFlow + this->Parameters.Speed * this->Profile(x, y));
}

float JetInflow::Concentration(float x, float y) const
{
  return static_cast<float>(this->Profile(x, y));
}

std::array<float, 3> JetInflow::Acceleration(
  int x, int y, int z, double time, const std::array<float, 3>& velocity) const
{
  const double profile = this->Profiles[static_cast<std::size_t>(y) * this->Rates.size() + x];
  const double speed = this->Parameters.CoFlow + this->Parameters.Speed * profile;
  std::array<double, 3> target = { 0.0, 0.0, speed };
  if (profile > 0.0)
  {
    const double behind =
      z * this->Cell - (this->Parameters.CoFlow + this->Parameters.Speed) * time;
    for (const Wave& wave : this->Waves)
    {
      const double value = profile * std::cos(wave.Number[0] * (x * this->Cell - Pi) +
                                              wave.Number[1] * (y * this->Cell - Pi) +
                                              wave.Number[2] * behind + wave.Phase);
      for (int c = 0; c < 3; ++c)
      {
        target[c] += wave.Amplitude[c] * value;
      }
    }
  }
  std::array<float, 3> acceleration;
  for (int c = 0; c < 3; ++c)
  {
    acceleration[c] = static_cast<float>(this->Rates[z] * (target[c] - velocity[c]));
  }
  return acceleration;
}

} // namespace banyan
