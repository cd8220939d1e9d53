// SPDX-License-Identifier: BSD-3-Clause
#include "RandomSpectrum.h"

#include <cmath>

namespace banyan
{

namespace
{

constexpr double TwoPi = 6.283185307179586;

/// The finaliser of SplitMix64: every bit of the result depends on every bit of the number.
std::uint64_t Scramble(std::uint64_t number)
{
  number += 0x9e3779b97f4a7c15u;
  number = (number ^ (number >> 30)) * 0xbf58476d1ce4e5b9u;
  number = (number ^ (number >> 27)) * 0x94d049bb133111ebu;
  return number ^ (number >> 31);
}

/// In (0, 1).
double Uniform(std::uint64_t bits)
{
  return (static_cast<double>(bits >> 12) + 0.5) / 4503599627370496.0;
}

} // namespace

RandomSpectrum::RandomSpectrum(std::uint64_t seed, double peak, double cutOff)
  : Seed(seed)
  , Peak(peak)
  , CutOff(cutOff)
{
  // The ensemble's energy: the sum over all wave vectors of the energy density.
  double energy = 0.0;
  const int reach = static_cast<int>(std::ceil(3.0 * cutOff));
  for (int z = -reach; z <= reach; ++z)
  {
    for (int y = -reach; y <= reach; ++y)
    {
      for (int x = -reach; x <= reach; ++x)
      {
        const double k = std::sqrt(static_cast<double>(x * x + y * y + z * z));
        energy += k > 0.0 ? this->Shape(k) / (2.0 * TwoPi * k * k) : 0.0;
      }
    }
  }
  this->Scale = 1.5 / energy;
}

double RandomSpectrum::Shape(double k) const
{
  const double squared = k * k;
  return squared * squared / std::pow(squared + this->Peak * this->Peak, 17.0 / 6.0) *
         std::exp(-squared / (this->CutOff * this->CutOff));
}

std::array<std::complex<float>, 3> RandomSpectrum::Coefficient(int kx, int ky, int kz) const
{
  if (kx == 0 && ky == 0 && kz == 0)
  {
    return {};
  }
  // Of two opposite wave vectors one is drawn, and the other is its conjugate.
  const bool drawn = kx > 0 || (kx == 0 && (ky > 0 || (ky == 0 && kz > 0)));
  const int sign = drawn ? 1 : -1;
  const double k[3] = { static_cast<double>(kx), static_cast<double>(ky), static_cast<double>(kz) };
  std::uint64_t state = this->Seed;
  for (const int component : { kx, ky, kz })
  {
    state = Scramble(state ^ static_cast<std::uint64_t>(sign * component + 65536));
  }
  std::array<std::complex<double>, 3> noise;
  for (std::complex<double>& value : noise)
  {
    // Box and Muller: |value|^2 has the mean 1.
    state = Scramble(state);
    const double radius = std::sqrt(-std::log(Uniform(state)));
    state = Scramble(state);
    value = std::polar(radius, sign * TwoPi * Uniform(state));
  }
  const double squared = k[0] * k[0] + k[1] * k[1] + k[2] * k[2];
  const std::complex<double> along =
    (k[0] * noise[0] + k[1] * noise[1] + k[2] * noise[2]) / squared;
  // Two of three directions are left, so |u|^2 / 2 has the mean amplitude^2.
  const double amplitude =
    std::sqrt(this->Scale * this->Shape(std::sqrt(squared)) / (2.0 * TwoPi * squared));
  std::array<std::complex<float>, 3> velocity;
  for (int c = 0; c < 3; ++c)
  {
    velocity[c] = std::complex<float>(amplitude * (noise[c] - k[c] * along));
  }
  return velocity;
}

} // namespace banyan
