// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_StokesSolution_h
#define banyan_Testing_StokesSolution_h

#include "ElasticWaveSimulation.h"

#include <array>
#include <cmath>

namespace banyan
{

/// Velocity at offset r (metres) from a point source in an endless homogeneous solid: Aki,
/// Richards, Quantitative Seismology (2002), equation 4.29, differentiated in time.
/// @tparam Source has Moment, HalfDuration and Delay, as MomentSource
template <typename Source>
std::array<double, 3> StokesVelocity(
  const ElasticMaterial& solid, const Source& source, const std::array<double, 3>& r, double time)
{
  const auto rate = [&](double t)
  {
    const double phase = (t - source.Delay) / source.HalfDuration;
    return std::exp(-phase * phase);
  };
  const auto acceleration = [&](double t)
  { return -2.0 * (t - source.Delay) / (source.HalfDuration * source.HalfDuration) * rate(t); };
  const double alpha = solid.PressureSpeed, beta = solid.ShearSpeed, rho = solid.Density;
  const double distance = std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
  const double tp = distance / alpha, ts = distance / beta;
  double between = 0.0; // integral of tau * rate(time - tau) from tp to ts
  const int parts = 200;
  for (int i = 0; i < parts; ++i)
  {
    const double tau = tp + (ts - tp) * (i + 0.5) / parts;
    between += tau * rate(time - tau) * (ts - tp) / parts;
  }
  constexpr int component[3][3] = { { 0, 3, 4 }, { 3, 1, 5 }, { 4, 5, 2 } };
  const double scale = 1.0 / (4.0 * 3.141592653589793 * rho);
  std::array<double, 3> v{};
  for (int n = 0; n < 3; ++n)
    for (int p = 0; p < 3; ++p)
      for (int q = 0; q < 3; ++q)
      {
        const double m = source.Moment[component[p][q]];
        const double gn = r[n] / distance, gp = r[p] / distance, gq = r[q] / distance;
        const double np = n == p, nq = n == q, pq = p == q;
        const double mixed = gn * pq + gp * nq + gq * np;
        v[n] +=
          m * scale *
          ((15 * gn * gp * gq - 3 * mixed) / std::pow(distance, 4) * between +
            (6 * gn * gp * gq - mixed) / (alpha * alpha * distance * distance) * rate(time - tp) -
            (6 * gn * gp * gq - mixed - gq * np) / (beta * beta * distance * distance) *
              rate(time - ts) +
            gn * gp * gq / (std::pow(alpha, 3) * distance) * acceleration(time - tp) -
            (gn * gp - np) * gq / (std::pow(beta, 3) * distance) * acceleration(time - ts));
      }
  return v;
}

} // namespace banyan

#endif
