// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_JetInflow_h
#define banyan_Data_JetInflow_h

#include "FlowSimulation.h"

#include <array>
#include <cstdint>
#include <vector>

namespace banyan
{

/// Shape of a round jet along +z in the box of edge 2 pi.
struct JetParameters
{
  double Diameter = 0.5;      ///< of the nozzle, where the velocity is half the jet's
  double EdgeWidth = 0.06;    ///< of the nozzle's shear layer (tanh profile)
  double Speed = 1.0;         ///< in the nozzle, beyond the co-flow's
  double CoFlow = 0.05;       ///< everywhere else
  double Unsteadiness = 0.15; ///< r.m.s. of each velocity component in the nozzle, over Speed
  double FringeWidth = 0.7;   ///< the inflow is imposed for z below this
  double FringeRate = 20.0;   ///< in the middle of the fringe, per unit of time
};

/// Makes a periodic box hold a jet: in a fringe at its bottom the velocity is drawn towards a
/// nozzle's, which erases what comes in through the bottom (from the top) and starts the jet anew.
/// In the nozzle, small turbulence that the seed decides is carried along with the jet (Taylor's
/// hypothesis), so that the jet breaks up as real ones do.
///
/// Source: Nordstrom, Nordin, Henningson, The Fringe Region Technique and the Fourier Method Used
/// in the Direct Numerical Simulation of Spatially Evolving Viscous Flows (1999).
class JetInflow : public FlowForcing
{
public:
  /// @param size N of the grid
  JetInflow(std::uint64_t seed, int size, const JetParameters& parameters);

  bool ActsOnPlane(int z) const override { return this->Rates[z] > 0.0f; }
  std::array<float, 3> Acceleration(
    int x, int y, int z, double time, const std::array<float, 3>& velocity) const override;

  /// Mean velocity along z in the nozzle's plane at a position; the start of the whole box.
  float MeanSpeed(float x, float y) const;
  /// The share of nozzle fluid there: 1 in the nozzle, exactly 0 away from it.
  float Concentration(float x, float y) const;
  /// Planes from z = 0 to the middle of the fringe: the scalar is set there, to what the nozzle
  /// gives, so that none that has left through the top comes back.
  int NozzlePlanes() const { return this->Nozzle; }

private:
  struct Wave
  {
    std::array<double, 3> Number;
    std::array<double, 3> Amplitude; ///< at right angles to Number
    double Phase;
  };
  /// 1 in the nozzle, 0 outside, with a smooth edge.
  double Profile(double x, double y) const;

  JetParameters Parameters;
  double Cell;
  int Nozzle;
  std::vector<float> Rates;    ///< of each plane
  std::vector<float> Profiles; ///< `[y][x]`
  std::vector<Wave> Waves;
};

} // namespace banyan

#endif
