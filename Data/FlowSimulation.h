#ifndef banyan_Data_FlowSimulation_h
#define banyan_Data_FlowSimulation_h

#include "FieldTransform.h"

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace banyan
{

/// Physical parameters. Lengths are in units in which the box has edge 2 pi.
struct FlowParameters
{
  float Viscosity = 0.01f;   ///< of momentum
  float Diffusivity = 0.01f; ///< of temperature
  float Buoyancy = 1.0f;     ///< upward (+z) acceleration per unit of temperature above the mean
  /// Largest allowed value of time step * (|u|+|v|+|w|) / cell; stable below 0.82.
  float Courant = 0.6f;
  float LongestTimeStep = 0.05f;
};

/// Incompressible flow with buoyancy in a periodic box [0, 2 pi)^3 (Boussinesq approximation):
///
///   du/dt = u x curl(u) - grad(P) + Viscosity lap(u) + Buoyancy (T - mean T) e_z,   div u = 0
///   dT/dt = -div(u T) + Diffusivity lap(T)
///
/// Pseudo-spectral in space (products are formed on the grid, modes from N/3 on are removed, so
/// nothing is aliased), Williamson's third-order Runge-Kutta scheme in time, with diffusion
/// integrated exactly. Velocity stays free of divergence and the mean temperature stays what it
/// was, both up to single precision.
///
/// Source: Canuto, Hussaini, Quarteroni, Zang: Spectral Methods, Evolution to Complex Geometries
/// (2007), chapter 3; Williamson, Low-Storage Runge-Kutta Schemes (1980), case 7.
class FlowSimulation
{
public:
  /// @param size N samples per axis, even and at least 8
  FlowSimulation(int size, const FlowParameters& parameters, ThreadPool& pool);

  /// Sets the state. Each function is given a position in the box and called once per sample, from
  /// several threads. Modes that the scheme cannot carry are removed, and so is divergence.
  using Scalar = std::function<float(float x, float y, float z)>;
  void SetState(const std::array<Scalar, 3>& velocity, const Scalar& temperature);

  /// Goes to a time not before the present one, in as many steps as stability asks for.
  /// Throws Error when the flow has become infinite (it was unstable).
  void AdvanceTo(double time);

  double Time() const { return this->Now; }
  std::int64_t StepsTaken() const { return this->Steps; }
  int Size() const { return this->N; }

  /// Values on the grid, `[z][y][x]`, x fastest, N^3 of them.
  std::vector<float> Temperature() const;
  std::array<std::vector<float>, 3> Velocity() const;
  std::array<std::vector<float>, 3> Vorticity() const;

  /// Mean of |u|^2 / 2, from the coefficients.
  double KineticEnergy() const;
  /// The largest |k . u| over all coefficients.
  double LargestDivergence() const;

private:
  using Complex = PeriodicField::Complex;

  void Step(double timeLeft);
  /// Fills `Scratch` with velocity (0-2), vorticity (3-5) and temperature (6), as coefficients.
  void CopyState();
  /// Turns the values in `Scratch` into u x omega (0-2) and u T (3-5).
  void FormProducts();
  /// The largest stable time step for the velocity values in `Scratch`, at most `timeLeft`.
  double StableTimeStep(double timeLeft) const;
  /// Rate = weight * Rate + timeStep * right-hand side from the products' coefficients.
  void AddRates(float weight, float timeStep);
  /// State += share * Rate, then both decay by diffusion over `seconds`.
  void AddAndDiffuse(float share, double seconds);
  /// Removes the modes that the scheme does not carry, and divergence, from the state.
  void Project();

  FlowParameters Parameters;
  ThreadPool& Pool;
  int N;
  FieldTransform Transform;
  std::vector<PeriodicField> State;   ///< u, v, w, T as coefficients
  std::vector<PeriodicField> Rate;    ///< of the same
  std::vector<PeriodicField> Scratch; ///< seven fields
  double Now = 0.0;
  std::int64_t Steps = 0;
};

} // namespace banyan

#endif
