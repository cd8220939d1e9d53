// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_RandomSpectrum_h
#define banyan_Data_RandomSpectrum_h

#include <array>
#include <complex>
#include <cstdint>

namespace banyan
{

/// A random velocity field, given by its Fourier coefficients: Gaussian, isotropic, free of
/// divergence, with the energy spectrum
///
///   E(k) = c k^4 / (k^2 + kp^2)^(17/6) exp(-(k / kc)^2)
///
/// (von Karman's: it rises as k^4, falls as k^(-5/3) behind its peak near kp) where c makes the
/// mean of |u|^2 / 2 over the ensemble equal to 3/2, an r.m.s. velocity of 1 in each direction.
///
/// A coefficient depends on the seed and its own wave vector only: grids of any size carry the same
/// large eddies.
///
/// Source: von Karman, Progress in the Statistical Theory of Turbulence (1948); Rogallo, Numerical
/// Experiments in Homogeneous Turbulence (1981), section 3, for random phases.
class RandomSpectrum
{
public:
  /// @param peak kp; the box has edge 2 pi
  /// @param cutOff kc, above which there is next to nothing
  RandomSpectrum(std::uint64_t seed, double peak, double cutOff);

  /// Opposite wave vectors have conjugate coefficients. The mean is zero.
  std::array<std::complex<float>, 3> Coefficient(int kx, int ky, int kz) const;

private:
  double Shape(double k) const;

  std::uint64_t Seed;
  double Peak;
  double CutOff;
  double Scale = 1.0;
};

} // namespace banyan

#endif
