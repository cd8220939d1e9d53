// SPDX-License-Identifier: BSD-3-Clause
#include "ConvectionSimulation.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <algorithm>
#include <cmath>

namespace banyan
{

ConvectionSimulation::ConvectionSimulation(
  int size, const ConvectionParameters& parameters, ThreadPool& pool)
  : Parameters(parameters)
  , Pool(pool)
  , State(size)
{
  if (parameters.Rayleigh > 0.0)
  {
    this->Nu = std::sqrt(parameters.Prandtl / parameters.Rayleigh);
    this->Kappa = 1.0 / std::sqrt(parameters.Prandtl * parameters.Rayleigh);
  }
  for (std::vector<float>& rate : this->Rate)
  {
    rate.assign(this->State[3].size(), 0.0f);
  }
}

void ConvectionSimulation::SetTemperature(const std::vector<float>& values)
{
  const int n = this->Size();
  if (values.size() != static_cast<std::size_t>(n) * n * n)
  {
    throw Error("The temperature needs one value for each cell of the box.",
      { {}, {}, values.size(), static_cast<std::uint64_t>(n) * n * n });
  }
  auto row = values.begin();
  for (int z = 0; z < n; ++z)
  {
    for (int y = 0; y < n; ++y, row += n)
    {
      std::copy(row, row + n, this->State[3].begin() + this->State.Index(0, y, z));
    }
  }
}

void ConvectionSimulation::AdvanceTo(double time)
{
  // What is left after the last step is rounding, not time.
  while (time - this->Now > 1e-12)
  {
    this->Step(time - this->Now);
  }
}

void ConvectionSimulation::Step(double timeLeft)
{
  constexpr float weights[3] = { 0.0f, -5.0f / 9.0f, -153.0f / 128.0f };
  constexpr float shares[3] = { 1.0f / 3.0f, 15.0f / 16.0f, 8.0f / 15.0f };
  const double step = std::min(this->StableTimeStep(), timeLeft);
  for (int stage = 0; stage < 3; ++stage)
  {
    this->State.FillGhosts(HotWall, ColdWall, this->Pool);
    this->AddRates(weights[stage], static_cast<float>(step));
    this->AddToState(shares[stage]);
    if (this->Parameters.Rayleigh > 0.0)
    {
      this->State.Project(this->Pool);
    }
  }
  this->Now += step;
  ++this->Steps;
}

double ConvectionSimulation::LargestSpeed() const
{
  const int n = this->Size();
  std::vector<float> fastest(n, 0.0f);
  this->Pool.ParallelFor(n,
    [&](std::int64_t z)
    {
      for (int y = 0; y < n; ++y)
      {
        const std::size_t start = this->State.Index(0, y, static_cast<int>(z));
        for (std::size_t p = start; p < start + n; ++p)
        {
          const float speed =
            std::abs(this->State[0][p]) + std::abs(this->State[1][p]) + std::abs(this->State[2][p]);
          // Written so that NaN is kept, to be found by the caller.
          fastest[z] = speed <= fastest[z] ? fastest[z] : speed;
        }
      }
    });
  float speed = 0.0f;
  for (const float slice : fastest)
  {
    speed = slice <= speed ? speed : slice;
  }
  return speed;
}

double ConvectionSimulation::StableTimeStep() const
{
  const double speed = this->LargestSpeed();
  if (!std::isfinite(speed))
  {
    throw Error("The flow became infinite: it needs a smaller Rayleigh or Courant number.");
  }
  // On the negative real axis the scheme is stable to 2.5. The fastest mode of diffusion decays at
  // 12 / cell^2 times the diffusivity, and where the limiter falls back to plain upwind
  // differences, the flow damps at 2 |u| / cell on top of it.
  const double cells = this->Size();
  const double decay = 12.0 * std::max(this->Nu, this->Kappa) * cells * cells + 2.0 * speed * cells;
  return this->Parameters.Courant * 2.5 / decay;
}

void ConvectionSimulation::AddRates(float weight, float timeStep)
{
  this->Pool.ParallelFor(this->Size(),
    [&](std::int64_t z)
    {
      for (int c = 0; c < 3 && this->Parameters.Rayleigh > 0.0; ++c)
      {
        this->AddMomentumRates(c, static_cast<int>(z), weight, timeStep);
      }
      this->AddTemperatureRates(static_cast<int>(z), weight, timeStep);
    });
}

void ConvectionSimulation::AddToState(float share)
{
  const std::size_t plane = this->State.PlaneCount();
  this->Pool.ParallelFor(this->Size(),
    [&](std::int64_t z)
    {
      const std::size_t start = (z + 2) * plane;
      for (int c = 0; c < 4; ++c)
      {
        float* __restrict state = this->State[c].data() + start;
        const float* __restrict rate = this->Rate[c].data() + start;
        // Rates of ghosts and of the walls' faces are never set: they stay zero.
        for (std::size_t p = 0; p < plane; ++p)
        {
          state[p] += share * rate[p];
        }
      }
    });
}

std::vector<float> ConvectionSimulation::Velocity() const
{
  const int n = this->Size();
  std::vector<float> values;
  values.reserve(3 * static_cast<std::size_t>(n) * n * n);
  for (int z = 0; z < n; ++z)
  {
    for (int y = 0; y < n; ++y)
    {
      for (int x = 0; x < n; ++x)
      {
        const std::size_t p = this->State.Index(x, y, z);
        for (int c = 0; c < 3; ++c)
        {
          values.push_back(
            0.5f * (this->State[c][p] + this->State[c][p + this->State.Strides()[c]]));
        }
      }
    }
  }
  return values;
}

double ConvectionSimulation::HeatThrough(int x, float wall) const
{
  double sum = 0.0;
  for (int z = 0; z < this->Size(); ++z)
  {
    for (int y = 0; y < this->Size(); ++y)
    {
      sum += static_cast<double>(this->State[3][this->State.Index(x, y, z)]) - wall;
    }
  }
  // The wall is half a cell away; a face has the area cell^2.
  return sum * 2.0 * this->Kappa / this->Size();
}

double ConvectionSimulation::HeatThroughHotWall() const
{
  return -this->HeatThrough(0, HotWall);
}

double ConvectionSimulation::HeatThroughColdWall() const
{
  return this->HeatThrough(this->Size() - 1, ColdWall);
}

double ConvectionSimulation::MeanTemperature() const
{
  double sum = 0.0;
  for (const float t : this->Temperature())
  {
    sum += t;
  }
  const double cells = this->Size();
  return sum / (cells * cells * cells);
}

} // namespace banyan
