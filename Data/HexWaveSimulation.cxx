// SPDX-License-Identifier: BSD-3-Clause
// The time steps of HexWaveSimulation; HexWaveSetup.cxx prepares them.
#include "HexWaveSimulation.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace banyan
{

namespace
{

constexpr std::int64_t Batch = 4096;

} // namespace

double MomentPoint::Share(double seconds) const
{
  const double halfRootPi = 0.886226925452758;
  return this->HalfDuration * halfRootPi *
         (1.0 + std::erf((seconds - this->Delay) / this->HalfDuration));
}

/// Calls body(first, end, batch) for ranges of [0, count), in any order and in parallel.
template <typename Body>
void HexWaveSimulation::ForBatches(std::size_t count, const Body& body) const
{
  const auto all = static_cast<std::int64_t>(count);
  this->Pool.ParallelFor((all + Batch - 1) / Batch,
    [&](std::int64_t batch) { body(batch * Batch, std::min(all, (batch + 1) * Batch), batch); });
}

void HexWaveSimulation::AdvanceTo(double seconds)
{
  const auto target = static_cast<std::int64_t>(std::llround(seconds / this->TimeStep));
  while (this->Steps < target)
  {
    this->Step();
  }
  std::vector<char> finite(this->V.size() / Batch + 1, 1);
  this->ForBatches(this->V.size(),
    [&](std::int64_t first, std::int64_t end, std::int64_t batch)
    {
      finite[batch] = std::all_of(
        this->V.begin() + first, this->V.begin() + end, [](float v) { return std::isfinite(v); });
    });
  if (std::count(finite.begin(), finite.end(), 0) > 0)
  {
    throw Error("The waves became infinite: the source is too strong for single precision.");
  }
}

void HexWaveSimulation::Step()
{
  this->Forces->Apply(this->U.data(), this->F.data());
  this->AddSources();
  this->AddHangingForces();
  const std::size_t nodes = this->Mass.size();
  std::vector<double> absorbed(nodes / Batch + 1, 0.0);
  this->ForBatches(nodes, [&](std::int64_t, std::int64_t, std::int64_t batch)
    { absorbed[batch] = this->MoveNodes(batch); });
  this->Absorbed += std::accumulate(absorbed.begin(), absorbed.end(), 0.0);
  this->InterpolateHanging();
  // The work of the second half of the step.
  double power = 0.0;
  for (const NodeForce& force : this->NodeForces)
  {
    const double share = this->Sources[force.Source].Share(this->Time());
    for (int c = 0; c < 3; ++c)
    {
      power += share * force.Force[c] * this->V[3 * std::size_t(force.Node) + c];
    }
  }
  this->Work += 0.5 * power * this->TimeStep;
  ++this->Steps;
}

void HexWaveSimulation::AddSources()
{
  double power = 0.0;
  std::size_t last = this->Sources.size();
  double share = 0.0;
  for (const NodeForce& force : this->NodeForces)
  {
    if (force.Source != last)
    {
      last = force.Source;
      share = this->Sources[last].Share(this->Time());
    }
    for (int c = 0; c < 3; ++c)
    {
      const std::size_t place = 3 * std::size_t(force.Node) + c;
      this->F[place] += static_cast<float>(share * force.Force[c]);
      power += share * force.Force[c] * this->V[place];
    }
  }
  this->Work += 0.5 * power * this->TimeStep;
}

void HexWaveSimulation::AddHangingForces()
{
  this->ForBatches(this->Masters.size(),
    [this](std::int64_t first, std::int64_t end, std::int64_t)
    {
      for (std::int64_t i = first; i < end; ++i)
      {
        float sum[3] = {};
        for (std::uint32_t k = this->MasterStart[i]; k < this->MasterStart[i + 1]; ++k)
        {
          const float* force = &this->F[3 * std::size_t(this->HangingOfMaster[k])];
          for (int c = 0; c < 3; ++c)
          {
            sum[c] += force[c];
          }
        }
        float* force = &this->F[3 * std::size_t(this->Masters[i])];
        for (int c = 0; c < 3; ++c)
        {
          force[c] += 0.25f * sum[c];
        }
      }
    });
}

double HexWaveSimulation::MoveNodes(std::int64_t batch)
{
  const std::size_t first = static_cast<std::size_t>(batch * Batch);
  const std::size_t end = std::min<std::size_t>(this->Mass.size(), first + Batch);
  const auto before = [](const OpenNode& a, std::size_t node) { return a.Node < node; };
  double absorbed = 0.0;
  for (auto open = std::lower_bound(this->OpenNodes.begin(), this->OpenNodes.end(), first, before);
       open != this->OpenNodes.end() && open->Node < end; ++open)
  {
    // (1 + loss) after = (1 - loss) before + Push force
    for (int c = 0; c < 3; ++c)
    {
      const std::size_t place = 3 * std::size_t(open->Node) + c;
      const float loss = open->Loss[c], speed = this->V[place];
      this->F[place] /= 1.0f + loss;
      this->V[place] *= (1.0f - loss) / (1.0f + loss);
      const double mean = 0.5 * (speed + this->V[place] + this->Push[open->Node] * this->F[place]);
      absorbed += 2.0 * loss * this->Mass[open->Node] * mean * mean;
    }
  }
  const float step = static_cast<float>(this->TimeStep);
  float* u = &this->U[3 * first];
  float* v = &this->V[3 * first];
  const float* f = &this->F[3 * first];
  for (std::size_t node = first; node < end; ++node, u += 3, v += 3, f += 3)
  {
    const float keep = this->Keep[node], push = this->Push[node];
    for (int c = 0; c < 3; ++c)
    {
      v[c] = keep * v[c] + push * f[c];
      u[c] += step * v[c];
    }
  }
  return absorbed;
}

void HexWaveSimulation::InterpolateHanging()
{
  this->ForBatches(this->Hanging.size(),
    [this](std::int64_t first, std::int64_t end, std::int64_t)
    {
      for (std::int64_t i = first; i < end; ++i)
      {
        const MeshHangingNode& hanging = this->Hanging[i];
        for (float* values : { this->U.data(), this->V.data() })
        {
          const float* a = values + 3 * std::size_t(hanging.Masters[0]);
          const float* b = values + 3 * std::size_t(hanging.Masters[1]);
          const float* d = values + 3 * std::size_t(hanging.Masters[2]);
          const float* e = values + 3 * std::size_t(hanging.Masters[3]);
          for (int c = 0; c < 3; ++c)
          {
            values[3 * std::size_t(hanging.Node) + c] = 0.25f * ((a[c] + b[c]) + (d[c] + e[c]));
          }
        }
      }
    });
}

HexWaveEnergy HexWaveSimulation::Energy()
{
  this->Forces->Apply(this->U.data(), this->F.data());
  const std::size_t nodes = this->Mass.size();
  std::vector<double> kinetic(nodes / Batch + 1, 0.0), strain(nodes / Batch + 1, 0.0);
  this->ForBatches(nodes,
    [&](std::int64_t first, std::int64_t end, std::int64_t batch)
    {
      for (std::int64_t i = 3 * first; i < 3 * end; ++i)
      {
        const double v = this->V[i];
        kinetic[batch] += 0.5 * this->Mass[i / 3] * v * v;
        // Present forces along the displacement one step before.
        strain[batch] -= 0.5 * (this->U[i] - this->TimeStep * v) * this->F[i];
      }
    });
  return { this->Work, std::accumulate(kinetic.begin(), kinetic.end(), 0.0),
    std::accumulate(strain.begin(), strain.end(), 0.0), this->Absorbed };
}

} // namespace banyan
