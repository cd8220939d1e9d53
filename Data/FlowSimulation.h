// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_FlowSimulation_h
#define banyan_Data_FlowSimulation_h

#include "FieldTransform.h"

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace banyan
{

/// An acceleration that depends on place, time and the velocity there.
class FlowForcing
{
public:
  virtual ~FlowForcing() = default;
  /// False where the acceleration is zero on the whole plane of samples z, which saves asking.
  virtual bool ActsOnPlane(int z) const = 0;
  /// At a sample of the grid. Called from several threads.
  virtual std::array<float, 3> Acceleration(
    int x, int y, int z, double time, const std::array<float, 3>& velocity) const = 0;
};

/// Physical parameters. Lengths are in units in which the box has edge 2 pi.
struct FlowParameters
{
  float Viscosity = 0.01f;   ///< of momentum
  float Diffusivity = 0.01f; ///< of temperature
  float Buoyancy = 1.0f;     ///< upward (+z) acceleration per unit of temperature above the mean
  /// Largest allowed value of time step * (|u|+|v|+|w|) / cell; stable below 0.82.
  float Courant = 0.6f;
  float LongestTimeStep = 0.05f;
  /// Without it, temperature stays zero, and a step takes two thirds of the time.
  bool WithTemperature = true;
  /// Added to the equation of motion when set; not owned. It cannot change the mean velocity: a
  /// uniform pressure gradient balances its mean.
  const FlowForcing* Forcing = nullptr;
};

/// Incompressible flow with buoyancy in a periodic box [0, 2 pi)^3 (Boussinesq approximation):
///
///   du/dt = u x curl(u) - grad(P) + Viscosity lap(u) + Buoyancy (T - mean T) e_z + forcing,
///   div u = 0
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

  /// Sets the velocity by its coefficients and the temperature to zero. The function is called from
  /// several threads, once for each stored mode that the scheme carries: kx >= 0, and where kx is 0
  /// it has to give conjugates for opposite wave vectors. Divergence is removed.
  using Spectrum = std::function<std::array<PeriodicField::Complex, 3>(int kx, int ky, int kz)>;
  void SetVelocitySpectrum(const Spectrum& spectrum);

  /// Goes to a time not before the present one, in as many steps as stability asks for.
  /// Throws Error when the flow has become infinite (it was unstable).
  void AdvanceTo(double time);

  /// Takes one step, as long as stability allows and no longer than `timeLeft` (positive).
  /// Returns its length. Throws as `AdvanceTo` does.
  double Step(double timeLeft);

  double Time() const { return this->Now; }
  std::int64_t StepsTaken() const { return this->Steps; }
  int Size() const { return this->N; }

  /// Values on the grid, `[z][y][x]`, x fastest, N^3 of them.
  std::vector<float> Temperature() const;
  std::array<std::vector<float>, 3> Velocity() const;
  std::array<std::vector<float>, 3> Vorticity() const;

  /// Velocity through the cells' lower faces: component c is the mean of that component over the
  /// face between sample i - 1 and sample i along axis c, where a cell reaches half a spacing to
  /// each side of its sample. What flows into a cell flows out of it, up to single precision.
  std::array<std::vector<float>, 3> FaceVelocity() const;

  /// Mean of |u|^2 / 2, from the coefficients.
  double KineticEnergy() const;
  /// Mean of |curl u|^2 / 2: without forces, energy decays at 2 Viscosity times this.
  double Enstrophy() const;
  /// The largest |k . u| over all coefficients.
  double LargestDivergence() const;

private:
  using Complex = PeriodicField::Complex;

  /// Fills `Scratch` with velocity (0-2), vorticity (3-5) and temperature (6), as coefficients.
  void CopyState();
  /// Turns the values in `Scratch` into u x omega + forcing (0-2) and u T (3-5).
  void FormProducts(double time);
  /// The forcing on a plane, from the velocities in `Scratch`: three times `[y][x]`, or nothing.
  std::vector<float> ForcingOnPlane(int z, double time) const;
  /// The largest stable time step for the velocity values in `Scratch`, at most `timeLeft`.
  double StableTimeStep(double timeLeft) const;
  /// Rate = weight * Rate + timeStep * right-hand side from the products' coefficients.
  void AddRates(float weight, float timeStep);
  /// State += share * Rate, then both decay by diffusion over `seconds`.
  void AddAndDiffuse(float share, double seconds);
  /// Removes the modes that the scheme does not carry, and divergence, from the state.
  void Project();

  /// The values of the vector field whose coefficients are a function of k and the velocity's.
  using VectorMode = std::function<std::array<Complex, 3>(
    const std::array<float, 3>& k, const std::array<Complex, 3>& velocity)>;
  std::array<std::vector<float>, 3> VectorField(const VectorMode& mode) const;
  /// Half the sum of k^power |u|^2 over all coefficients; power is 0 or 2.
  double SumOfSquares(int power) const;

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
