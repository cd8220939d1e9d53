// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_ElasticWaveSimulation_h
#define banyan_Data_ElasticWaveSimulation_h

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace banyan
{

class ThreadPool;

/// An isotropic elastic solid at one point.
struct ElasticMaterial
{
  float Density;       ///< kg/m^3
  float PressureSpeed; ///< of P waves, m/s
  float ShearSpeed;    ///< of S waves, m/s; above 0, below 0.866 PressureSpeed
};

/// A point source: a moment tensor whose rate is a Gaussian in time.
struct MomentSource
{
  std::array<int, 3> Cell{};      ///< x, y, z
  std::array<double, 6> Moment{}; ///< the rate at its peak, xx, yy, zz, xy, xz, yz; N m / s
  double HalfDuration = 0.1;      ///< s; the rate is exp(-((t - Delay) / HalfDuration)^2)
  double Delay = 0.4;             ///< s; the time of the peak
};

/// Shape of the grid.
struct ElasticGrid
{
  int Size = 64; ///< N cells per axis
  double CellMetres = 100.0;
  int DampedCells = 16; ///< layers around the N^3 cells in which waves are damped
  /// True: the top (z = N - 1) is a free surface, as the ground is. False: damped like the others.
  bool FreeSurface = true;
};

/// Elastic waves in a block of ground:
///
///   density dv/dt = div(stress),   dstress/dt = lambda div(v) 1 + mu (grad v + (grad v)^T) -
///   source
///
/// Velocity and stress on a staggered grid, differences of fourth order in space and of second
/// order in time (Virieux; Levander), stress images at the free surface, where vertical differences
/// of velocity are of second order. Around the block the waves run into damped layers (Cerjan et
/// al.), which reflect a little of what hits them, a few percent of the amplitude.
///
/// Waves need about six cells per wavelength to travel at their right speed. N^3 cells and the
/// damped layers take about 80 bytes each.
///
/// Source: Virieux (1986), P-SV wave propagation in heterogeneous media; Levander (1988),
/// Fourth-order finite-difference P-SV seismograms; Cerjan, Kosloff, Kosloff, Reshef (1985), A
/// nonreflecting boundary condition; Graves (1996), Simulating seismic wave propagation in 3D.
class ElasticWaveSimulation
{
public:
  /// Gives the material at a cell's centre; x, y, z in [0, N), nothing else is asked for.
  using Ground = std::function<ElasticMaterial(int x, int y, int z)>;

  /// Everything is at rest at time 0. Throws Error when the ground is not solid everywhere or the
  /// source lies outside.
  ElasticWaveSimulation(
    const ElasticGrid& grid, const Ground& ground, const MomentSource& source, ThreadPool& pool);

  /// Goes to the time step that is nearest to the given time, which is not before the present one.
  void AdvanceTo(double seconds);

  double Time() const { return static_cast<double>(this->Steps) * this->TimeStep; }
  double TimeStepSeconds() const { return this->TimeStep; }
  std::int64_t StepsTaken() const { return this->Steps; }

  /// |v| in m/s at the N^3 cell centres (means of the nearest components), `[z][y][x]`, x fastest.
  /// Throws Error when the waves have become infinite.
  std::vector<float> Speed() const;
  /// The velocity at one cell's centre, m/s. This and the speed are those half a time step before
  /// `Time()`.
  std::array<float, 3> Velocity(int x, int y, int z) const;
  /// Kinetic and strain energy of the block with its damped layers, J. Velocity and stress are half
  /// a time step apart, so that it ripples by a fraction of a percent while waves travel.
  double Energy() const;

private:
  static constexpr int GhostCells = 2; ///< reach of the differences

  std::size_t Index(int x, int y, int z) const
  {
    return (static_cast<std::size_t>(z + this->Low) * this->Row + (y + this->Low)) * this->Row +
           (x + this->Low);
  }
  void SetMaterial(const Ground& ground);
  /// Density and shear modulus at the centres to where velocity and shear stress are.
  void Average(const std::vector<float>& density, const std::vector<float>& shear);
  void SetDamping();
  void Step();
  void AdvanceVelocity(int z);
  void AdvanceNormalStress(int z);
  void AdvanceShearStress(int z);
  void AddSource(double seconds);
  /// J/m^3 of what has index p; without the vertical component and its shear stresses if told so.
  double EnergyDensity(std::size_t p, bool vertical) const;
  /// Fill the ghosts above the free surface.
  void MirrorStress();
  void ExtendVelocity();
  /// Calls body(z) for each plane that is advanced, in any order and in parallel.
  void ForPlanes(const std::function<void(int z)>& body) const;

  ElasticGrid Grid;
  MomentSource Source;
  ThreadPool& Pool;
  int Low;                      ///< damped layers and ghosts below cell 0 along each axis
  std::size_t Row;              ///< cells along x and y with damped layers and ghosts
  int First, LastSide, LastTop; ///< range of cells that are advanced: sides, and z
  std::array<std::ptrdiff_t, 3> Stride;
  double TimeStep = 0.0;
  std::int64_t Steps = 0;
  std::array<std::vector<float>, 3> V;         ///< on the high faces of the cells
  std::array<std::vector<float>, 6> Stress;    ///< xx, yy, zz at centres; xy, xz, yz on high edges
  std::array<std::vector<float>, 3> Lightness; ///< time step / (density cell) at V
  std::array<std::vector<float>, 3> Shear;     ///< mu time step / cell at xy, xz, yz
  std::vector<float> Lambda, Modulus;          ///< lambda and lambda + 2 mu, as Shear, at centres
  std::array<std::vector<float>, 2> Damping;   ///< factor per step for sides and for z
};

} // namespace banyan

#endif
