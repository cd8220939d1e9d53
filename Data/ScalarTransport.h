// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_ScalarTransport_h
#define banyan_Data_ScalarTransport_h

#include <array>
#include <vector>

namespace banyan
{

class ThreadPool;

/// A scalar carried and spread by a flow in a periodic box, which stays between its bounds:
///
///   dc/dt = -div(u c) + Diffusivity lap(c)
///
/// Finite volumes with van Leer's limiter in space and Heun's method in time: where c is smooth
/// second order; at a front no new extremum appears. Flows without divergence (as
/// `FlowSimulation::FaceVelocity` gives) leave a uniform c uniform, and what leaves a cell enters
/// its neighbour, so that the total is kept; both up to single precision. A spectral method would
/// be more exact in smooth places, but ring around fronts and fill the surroundings with noise.
///
/// Source: van Leer, Towards the Ultimate Conservative Difference Scheme II (1974); Gottlieb, Shu,
/// Tadmor, Strong Stability-Preserving High-Order Time Discretization Methods (2001), section 2.
class ScalarTransport
{
public:
  using FaceVelocity = std::array<std::vector<float>, 3>;

  /// @param size N cells per axis, at least 4
  /// @param cell their width
  ScalarTransport(int size, double cell, double diffusivity, ThreadPool& pool);

  /// Carries the scalar over a time during which the velocity goes evenly from one to the other,
  /// in as many steps as the bounds ask for.
  /// @param from, to velocities through the lower faces of the cells, three times `[z][y][x]`
  void Advance(const FaceVelocity& from, const FaceVelocity& to, double seconds);

  /// Means over the cells, `[z][y][x]`, x fastest. The start is zero; may be changed in between.
  std::vector<float>& Values() { return this->Scalar; }
  const std::vector<float>& Values() const { return this->Scalar; }

private:
  /// result = old + share * (from + Euler step of `from` - old).
  void Stage(const std::vector<float>& from, const FaceVelocity& velocity, double seconds,
    float share, std::vector<float>& result);
  /// Into one cell, through all its faces, per area.
  double LargestInflow(const FaceVelocity& velocity) const;
  FaceVelocity Mix(const FaceVelocity& from, const FaceVelocity& to, float share) const;

  int N;
  double Cell, Diffusivity;
  ThreadPool& Pool;
  std::vector<float> Scalar, Between;
};

} // namespace banyan

#endif
