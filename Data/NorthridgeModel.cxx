// SPDX-License-Identifier: BSD-3-Clause
#include "NorthridgeModel.h"

#include "Base/Error.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace banyan
{

namespace
{

constexpr double Pi = 3.141592653589793;
constexpr double Degree = Pi / 180.0;

/// A bowl of sediments: an ellipse at the surface, metres and degrees from east to its longer axis.
struct Bowl
{
  double X, Y, Length, Width, Direction, Depth;
};
constexpr Bowl Bowls[] = {
  { 29000.0, 51000.0, 15000.0, 8500.0, 0.0, 4000.0 },    // the valley
  { 51000.0, 27000.0, 26000.0, 14500.0, -35.0, 7500.0 }, // the basin
};
constexpr double Waviness = 0.15;
constexpr double DeepestFloor = 12000.0; ///< no floor is deeper, whatever the seed

// Speeds of S waves, m/s: sediments reach the second one at the third's depth; rock begins with a
// weathered surface.
constexpr double FirmSediment = 2000.0, FirmDepth = 5000.0;
constexpr double RockSurface = 1800.0, Rock = 3300.0, WeatheredDepth = 1500.0;
constexpr double RockGrowth = 1.0 / 60.0; // m/s per metre

/// Centre of the fault's upper edge, its size, and the angles of fault and slip.
constexpr double FaultX = 30500.0, FaultY = 54500.0, FaultTop = 5000.0;
constexpr double FaultLength = 18000.0, FaultWidth = 21000.0;
constexpr double Strike = 122.0 * Degree, Dip = 40.0 * Degree, Rake = 101.0 * Degree;
constexpr double TotalMoment = 1.3e19; // N m: magnitude 6.7
constexpr double RuptureSpeed = 2800.0;
constexpr int AlongStrike = 12, AlongDip = 14;

using Vector = std::array<double, 3>;

/// Northward strikes are 0; the fault dips to the right of its strike.
const Vector AxisOfStrike = { std::sin(Strike), std::cos(Strike), 0.0 };
const Vector AxisOfDip = { std::cos(Strike) * std::cos(Dip), -std::sin(Strike) * std::cos(Dip),
  -std::sin(Dip) };
const Vector Normal = { std::cos(Strike) * std::sin(Dip), -std::sin(Strike) * std::sin(Dip),
  std::cos(Dip) };

/// Moment tensor of a unit shear crack (Aki and Richards, 3.2): what lies above slips against what
/// lies below.
std::array<double, 6> ShearCrack()
{
  constexpr int pairs[6][2] = { { 0, 0 }, { 1, 1 }, { 2, 2 }, { 0, 1 }, { 0, 2 }, { 1, 2 } };
  Vector slip;
  for (int c = 0; c < 3; ++c)
  {
    slip[c] = std::cos(Rake) * AxisOfStrike[c] - std::sin(Rake) * AxisOfDip[c];
  }
  std::array<double, 6> moment;
  for (int c = 0; c < 6; ++c)
  {
    const auto [i, j] = pairs[c];
    moment[c] = slip[i] * Normal[j] + slip[j] * Normal[i];
  }
  return moment;
}

} // namespace

NorthridgeModel::NorthridgeModel(std::uint64_t seed, double slowest)
  : Slowest(slowest)
{
  if (!(slowest >= 100.0 && slowest <= 1500.0))
  {
    throw Error("S waves in the softest sediments need a speed from 100 to 1500 m/s.");
  }
  std::mt19937_64 random(seed);
  // The standard's own distributions may differ between libraries; this does not.
  const auto uniform = [&](double low, double high)
  { return low + (high - low) * static_cast<double>(random() >> 11) / 9007199254740992.0; };
  const auto draw = [&](Wave& wave, double shortest, double longest)
  {
    const double number = 2.0 * Pi / uniform(shortest, longest);
    const double direction = uniform(0.0, 2.0 * Pi);
    wave = { number * std::cos(direction), number * std::sin(direction), uniform(0.0, 2.0 * Pi) };
  };
  for (Wave& wave : this->Waves)
  {
    draw(wave, 8000.0, 25000.0);
  }
  for (Wave& wave : this->SlipWaves)
  {
    draw(wave, 8000.0, 16000.0);
  }
}

double NorthridgeModel::Floor(double x, double y) const
{
  double deepest = 0.0;
  for (const Bowl& bowl : Bowls)
  {
    const double c = std::cos(bowl.Direction * Degree), s = std::sin(bowl.Direction * Degree);
    const double a = (c * (x - bowl.X) + s * (y - bowl.Y)) / bowl.Length;
    const double b = (c * (y - bowl.Y) - s * (x - bowl.X)) / bowl.Width;
    const double inside = 1.0 - a * a - b * b;
    // Bowls with steep sides and a broad floor.
    deepest = std::max(deepest, inside > 0.0 ? bowl.Depth * std::pow(inside, 0.75) : 0.0);
  }
  if (deepest == 0.0)
  {
    return 0.0;
  }
  double sum = 0.0;
  for (const Wave& wave : this->Waves)
  {
    sum += std::cos(wave.KX * x + wave.KY * y + wave.Phase);
  }
  return deepest * (1.0 + Waviness * sum / std::sqrt(0.5 * this->Waves.size()));
}

ElasticMaterial NorthridgeModel::At(const std::array<double, 3>& point) const
{
  const double depth = std::max(0.0, -point[2]);
  const bool sediment = depth < DeepestFloor && depth < this->Floor(point[0], point[1]);
  const double shear =
    sediment
      ? this->Slowest + (FirmSediment - this->Slowest) * std::sqrt(std::min(1.0, depth / FirmDepth))
      : Rock + RockGrowth * depth - (Rock - RockSurface) * std::exp(-depth / WeatheredDepth);
  // Castagna's line for sediments full of water, Poisson's solid for rock, Gardner's rule for both.
  const double pressure = sediment ? 1360.0 + 1.16 * shear : std::sqrt(3.0) * shear;
  const double density = 310.0 * std::pow(pressure, 0.25);
  return { static_cast<float>(density), static_cast<float>(pressure), static_cast<float>(shear) };
}

double NorthridgeModel::SlowestIn(const std::array<double, 3>& low, double edge) const
{
  double slowest = HUGE_VAL;
  // A large box may have a whole bowl between its corners.
  const int parts = edge > 5000.0 ? 4 : edge > 500.0 ? 2 : 1;
  for (int i = 0; i <= parts; ++i)
  {
    for (int j = 0; j <= parts; ++j)
    {
      const Vector point = { low[0] + i * edge / parts, low[1] + j * edge / parts, low[2] + edge };
      slowest = std::min<double>(slowest, this->At(point).ShearSpeed);
    }
  }
  return slowest;
}

double NorthridgeModel::DecayRate(const ElasticMaterial& material, double hertz)
{
  const double quality = 0.05 * material.ShearSpeed;
  return Pi * hertz / quality;
}

std::vector<MomentPoint> NorthridgeModel::Fault(double halfDuration) const
{
  std::vector<MomentPoint> points;
  std::vector<double> slips;
  double total = 0.0;
  const std::array<double, 6> crack = ShearCrack();
  // The break begins a quarter of the width above the lower edge, near the south-eastern end.
  const double startStrike = 0.35 * FaultLength, startDip = 0.75 * FaultWidth;
  for (int j = 0; j < AlongDip; ++j)
  {
    for (int i = 0; i < AlongStrike; ++i)
    {
      const double strike = FaultLength * ((i + 0.5) / AlongStrike - 0.5);
      const double dip = FaultWidth * (j + 0.5) / AlongDip;
      double slip = 1.0;
      for (const Wave& wave : this->SlipWaves)
      {
        slip += 0.25 * std::cos(wave.KX * strike + wave.KY * dip + wave.Phase);
      }
      // Less towards the edges.
      slip *= std::sin(Pi * (i + 0.5) / AlongStrike) * std::sin(Pi * (j + 0.5) / AlongDip);
      slip = std::max(slip, 0.0);
      MomentPoint point;
      point.Place = { FaultX, FaultY, -FaultTop };
      for (int c = 0; c < 3; ++c)
      {
        point.Place[c] += strike * AxisOfStrike[c] + dip * AxisOfDip[c];
      }
      point.HalfDuration = halfDuration;
      point.Delay =
        3.0 * halfDuration + std::hypot(strike - startStrike, dip - startDip) / RuptureSpeed;
      points.push_back(point);
      slips.push_back(slip);
      total += slip;
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    // What the rate adds up to over time is the moment.
    const double rate = TotalMoment * slips[i] / total / (halfDuration * std::sqrt(Pi));
    for (int c = 0; c < 6; ++c)
    {
      points[i].Moment[c] = rate * crack[c];
    }
  }
  return points;
}

} // namespace banyan
