// SPDX-License-Identifier: BSD-3-Clause
#include "BasinModel.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace banyan
{

namespace
{

constexpr double Pi = 3.141592653589793;

// Density, P speed, S speed: typical of loose and packed sediments and of crystalline rock.
constexpr ElasticMaterial SoftSediment = { 2000.0f, 2400.0f, 1200.0f };
constexpr ElasticMaterial FirmSediment = { 2250.0f, 3300.0f, 1800.0f };
constexpr ElasticMaterial Rock = { 2600.0f, 5000.0f, 2900.0f };
constexpr ElasticMaterial DeepRock = { 2750.0f, 5800.0f, 3350.0f };
constexpr double DeepRockDepth = 6500.0;
constexpr double RippleMetres = 150.0;

} // namespace

BasinModel::BasinModel(std::uint64_t seed)
{
  std::mt19937_64 random(seed);
  // The standard's own distributions may differ between libraries; this does not.
  const auto uniform = [&](double low, double high)
  { return low + (high - low) * static_cast<double>(random() >> 11) / 9007199254740992.0; };

  for (auto& border : this->Waves)
  {
    for (Wave& wave : border)
    {
      const double number = 2.0 * Pi / uniform(2500.0, 8000.0);
      const double direction = uniform(0.0, 2.0 * Pi);
      wave = { number * std::cos(direction), number * std::sin(direction), uniform(0.0, 2.0 * Pi) };
    }
  }
  this->Centre = { EdgeMetres * uniform(0.4, 0.6), EdgeMetres * uniform(0.4, 0.6) };
  this->Radius = { EdgeMetres * uniform(0.36, 0.46), EdgeMetres * uniform(0.28, 0.36) };
  this->Depth = uniform(2600.0, 3200.0);
  this->SourcePlace = { EdgeMetres * uniform(0.3, 0.45), EdgeMetres * uniform(0.5, 0.65),
    uniform(7800.0, 8800.0) };

  // Slip direction d in a plane with normal n: M = n d + d n (Aki and Richards, 3.2).
  const double strike = uniform(0.0, 2.0 * Pi), dip = uniform(0.9, 1.3), rake = uniform(0.3, 1.2);
  const double n[3] = { -std::sin(dip) * std::sin(strike), std::sin(dip) * std::cos(strike),
    std::cos(dip) };
  const double d[3] = { std::cos(rake) * std::cos(strike) +
                          std::sin(rake) * std::cos(dip) * std::sin(strike),
    std::cos(rake) * std::sin(strike) - std::sin(rake) * std::cos(dip) * std::cos(strike),
    std::sin(rake) * std::sin(dip) };
  constexpr double PeakRate = 1e16; // N m/s: a magnitude of about 4.3
  constexpr int pairs[6][2] = { { 0, 0 }, { 1, 1 }, { 2, 2 }, { 0, 1 }, { 0, 2 }, { 1, 2 } };
  for (int c = 0; c < 6; ++c)
  {
    const auto [i, j] = pairs[c];
    this->Moment[c] = PeakRate * (n[i] * d[j] + n[j] * d[i]);
  }
}

double BasinModel::Ripple(int border, double x, double y) const
{
  double sum = 0.0;
  for (const Wave& wave : this->Waves[border])
  {
    sum += std::cos(wave.KX * x + wave.KY * y + wave.Phase);
  }
  return RippleMetres * sum / std::sqrt(0.5 * this->Waves[border].size());
}

ElasticMaterial BasinModel::At(double x, double y, double depth) const
{
  const double ex = (x - this->Centre[0]) / this->Radius[0];
  const double ey = (y - this->Centre[1]) / this->Radius[1];
  const double bowl = 1.0 - ex * ex - ey * ey;
  if (bowl > 0.0)
  {
    const double floor = this->Depth * bowl + this->Ripple(0, x, y) * bowl;
    if (depth < std::min(0.35 * this->Depth + this->Ripple(1, x, y), floor))
    {
      return SoftSediment;
    }
    if (depth < floor)
    {
      return FirmSediment;
    }
  }
  return depth < DeepRockDepth + this->Ripple(2, x, y) ? Rock : DeepRock;
}

MomentSource BasinModel::Source(int size) const
{
  const double cell = EdgeMetres / size;
  MomentSource source;
  source.HalfDuration = 2.8 * cell / SoftSediment.ShearSpeed;
  source.Delay = 3.0 * source.HalfDuration;
  source.Moment = this->Moment;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double place = axis < 2 ? this->SourcePlace[axis] : EdgeMetres - this->SourcePlace[axis];
    source.Cell[axis] = static_cast<int>(place / cell);
  }
  return source;
}

} // namespace banyan
