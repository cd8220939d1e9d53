// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_JetSimulation_h
#define banyan_Data_JetSimulation_h

#include "FlowSimulation.h"
#include "JetInflow.h"
#include "ScalarTransport.h"

namespace banyan
{

/// A turbulent round jet along +z and the concentration of nozzle fluid in it: a `FlowSimulation`
/// that a `JetInflow` drives, and a `ScalarTransport` with the same diffusivity as the viscosity.
/// The concentration stays in [0, 1], and what starts as exactly 0 stays so until the jet or
/// diffusion gets there.
class JetSimulation
{
public:
  /// Starts as a jet of constant width through the whole box, without any nozzle fluid outside the
  /// nozzle.
  /// @param size N, even and at least 8
  JetSimulation(
    std::uint64_t seed, int size, const JetParameters& jet, double viscosity, ThreadPool& pool);

  /// Throws Error when the flow has become infinite.
  void AdvanceTo(double time);

  const FlowSimulation& Flow() const { return this->Motion; }
  /// `[z][y][x]`, x fastest, the mean over each cell. The nozzle reaches from z = 0 to the plane
  /// `Inflow().NozzlePlanes()`.
  const std::vector<float>& Concentration() const { return this->Scalar.Values(); }
  const JetInflow& Inflow() const { return this->Jet; }

  /// Nozzle fluid (concentration times volume) that the nozzle has let in so far, less what left
  /// through the top: the change of the total since the start.
  double NetInflow() const { return this->Gain; }

private:
  void FillNozzle();

  JetInflow Jet;
  FlowSimulation Motion;
  ScalarTransport Scalar;
  ScalarTransport::FaceVelocity Velocity; ///< at the present time
  double Gain = 0.0;
};

} // namespace banyan

#endif
