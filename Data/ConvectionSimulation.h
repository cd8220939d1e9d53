// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_ConvectionSimulation_h
#define banyan_Data_ConvectionSimulation_h

#include "StaggeredBox.h"

#include <array>
#include <cstdint>
#include <vector>

namespace banyan
{

/// Physical parameters of the side-heated box.
struct ConvectionParameters
{
  double Rayleigh = 1e7; ///< buoyancy against viscosity and conduction; 0: conduction only
  double Prandtl = 0.71; ///< viscosity over thermal diffusivity; that of air
  /// Time steps are this share of the largest that is stable; at most 1.
  double Courant = 0.8;
};

/// Flow in a closed cube with a hot wall (x = 0, temperature 1/2) opposite to a cold wall (x = 1,
/// temperature -1/2); the other four walls are insulated and no wall lets the fluid slip
/// (Boussinesq approximation). It starts at rest:
///
///   du/dt = -div(u u) - grad(p) + nu lap(u) + T e_z,     div u = 0
///   dT/dt = -div(u T) + kappa lap(T)
///
/// Lengths are in units of the box edge, temperature of the difference between the walls, time of
/// sqrt(edge / (expansion * gravity * difference)), the free-fall time; then
/// nu = sqrt(Prandtl / Rayleigh) and kappa = 1 / sqrt(Prandtl Rayleigh). With Rayleigh 0 there is
/// no buoyancy, the fluid stays at rest, and time is in units of edge^2 / diffusivity (kappa = 1).
///
/// N^3 cells (`StaggeredBox`). Momentum: centred differences of second order, which neither make
/// nor lose energy. Temperature: upwind-biased differences of third order with Koren's limiter, so
/// that it stays between the walls' temperatures. Williamson's third-order Runge-Kutta scheme;
/// each stage ends with the projection onto flows without divergence. The layers along the walls
/// are about Rayleigh^(-1/4) thick, and want two cells.
///
/// Source: Harlow, Welch, Numerical calculation of time-dependent viscous incompressible flow
/// (1965); Koren, A robust upwind discretization method (1993); Williamson, Low-Storage
/// Runge-Kutta Schemes (1980), case 7.
class ConvectionSimulation
{
public:
  static constexpr float HotWall = 0.5f;
  static constexpr float ColdWall = -0.5f;

  /// Fluid at temperature 0.
  /// @param size N cells per axis, at least 4
  ConvectionSimulation(int size, const ConvectionParameters& parameters, ThreadPool& pool);

  /// Sets the temperature.
  /// @param values at the cell centres, `[z][y][x]`, x fastest, N^3 of them
  void SetTemperature(const std::vector<float>& values);

  /// Goes to a time not before the present one, in as many steps as stability asks for.
  /// Throws Error when the flow has become infinite (it was unstable).
  void AdvanceTo(double time);

  double Time() const { return this->Now; }
  std::int64_t StepsTaken() const { return this->Steps; }
  int Size() const { return this->State.Size(); }

  /// At the cell centres, `[z][y][x]`, x fastest, N^3 values.
  std::vector<float> Temperature() const { return this->State.Inner(3); }
  /// Component 0, 1 or 2 on the faces on the low side of each cell, as above.
  std::vector<float> FaceVelocity(int component) const { return this->State.Inner(component); }
  /// Component 0, 1, 2 in turn at the cell centres, as the means of two faces: `[z][y][x][3]`.
  std::vector<float> Velocity() const;

  /// Heat per time that enters through the hot wall and leaves through the cold one. Divided by
  /// the diffusivity it is the Nusselt number: 1 for conduction alone.
  double HeatThroughHotWall() const;
  double HeatThroughColdWall() const;
  double Diffusivity() const { return this->Kappa; }
  double MeanTemperature() const;
  /// The largest |div u| over all cells.
  double LargestDivergence() const { return this->State.LargestDivergence() * this->Size(); }

private:
  void Step(double timeLeft);
  double LargestSpeed() const;
  double StableTimeStep() const;
  /// Rate = weight * Rate + timeStep * right-hand side without the pressure.
  void AddRates(float weight, float timeStep);
  void AddMomentumRates(int component, int z, float weight, float timeStep);
  void AddTemperatureRates(int z, float weight, float timeStep);
  void AddToState(float share);
  double HeatThrough(int x, float wall) const;

  ConvectionParameters Parameters;
  ThreadPool& Pool;
  double Nu = 1.0, Kappa = 1.0;
  StaggeredBox State; ///< velocity and temperature
  std::array<std::vector<float>, 4> Rate;
  double Now = 0.0;
  std::int64_t Steps = 0;
};

} // namespace banyan

#endif
