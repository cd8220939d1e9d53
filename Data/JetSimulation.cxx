// SPDX-License-Identifier: BSD-3-Clause
#include "JetSimulation.h"

#include "Base/ThreadPool.h"

namespace banyan
{

namespace
{

constexpr double BoxEdge = 6.283185307179586;

FlowParameters ParametersFor(double viscosity, const FlowForcing& forcing)
{
  FlowParameters parameters;
  parameters.Viscosity = static_cast<float>(viscosity);
  parameters.Buoyancy = 0.0f;
  parameters.Courant = 0.8f;
  parameters.WithTemperature = false;
  parameters.Forcing = &forcing;
  return parameters;
}

} // namespace

JetSimulation::JetSimulation(
  std::uint64_t seed, int size, const JetParameters& jet, double viscosity, ThreadPool& pool)
  : Jet(seed, size, jet)
  , Motion(size, ParametersFor(viscosity, this->Jet), pool)
  , Scalar(size, BoxEdge / size, viscosity, pool)
{
  const auto none = [](float, float, float) { return 0.0f; };
  this->Motion.SetState(
    { none, none, [this](float x, float y, float) { return this->Jet.MeanSpeed(x, y); } }, none);
  this->Velocity = this->Motion.FaceVelocity();
  this->FillNozzle();
  this->Gain = 0.0;
}

void JetSimulation::FillNozzle()
{
  const int size = this->Motion.Size();
  const double cell = BoxEdge / size;
  double change = 0.0;
  std::size_t i = 0;
  for (int z = 0; z < this->Jet.NozzlePlanes(); ++z)
  {
    for (int y = 0; y < size; ++y)
    {
      for (int x = 0; x < size; ++x, ++i)
      {
        const float set =
          this->Jet.Concentration(static_cast<float>(x * cell), static_cast<float>(y * cell));
        change += static_cast<double>(set) - this->Scalar.Values()[i];
        this->Scalar.Values()[i] = set;
      }
    }
  }
  this->Gain += change * cell * cell * cell;
}

void JetSimulation::AdvanceTo(double time)
{
  // What is left after the last step is rounding, not time.
  while (time - this->Motion.Time() > 1e-9)
  {
    const double seconds = this->Motion.Step(time - this->Motion.Time());
    auto velocity = this->Motion.FaceVelocity();
    this->Scalar.Advance(this->Velocity, velocity, seconds);
    this->Velocity = std::move(velocity);
    this->FillNozzle();
  }
}

} // namespace banyan
