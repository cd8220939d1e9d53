// SPDX-License-Identifier: BSD-3-Clause
#include "FlowSimulation.h"

#include "WaveNumbers.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <algorithm>
#include <cmath>

namespace banyan
{

namespace
{

constexpr double TwoPi = 6.283185307179586;

std::complex<float> TimesI(std::complex<float> c)
{
  return { -c.imag(), c.real() };
}

/// Removes the part along (kx, ky, kz); nothing for the mean.
void RemoveGradient(std::array<std::complex<float>, 3>& v, float kx, float ky, float kz)
{
  const float squared = kx * kx + ky * ky + kz * kz;
  if (squared > 0.0f)
  {
    const std::complex<float> along = (kx * v[0] + ky * v[1] + kz * v[2]) / squared;
    v[0] -= kx * along;
    v[1] -= ky * along;
    v[2] -= kz * along;
  }
}

std::vector<PeriodicField> MakeFields(int count, int size)
{
  std::vector<PeriodicField> fields;
  for (int i = 0; i < count; ++i)
  {
    fields.emplace_back(size);
  }
  return fields;
}

std::vector<PeriodicField*> Pointers(std::vector<PeriodicField>& fields, int first, int count)
{
  std::vector<PeriodicField*> pointers;
  for (int i = first; i < first + count; ++i)
  {
    pointers.push_back(&fields[i]);
  }
  return pointers;
}

} // namespace

FlowSimulation::FlowSimulation(int size, const FlowParameters& parameters, ThreadPool& pool)
  : Parameters(parameters)
  , Pool(pool)
  , N(size)
  , Transform(size)
  , State(MakeFields(4, size))
  , Rate(MakeFields(4, size))
  , Scratch(MakeFields(7, size))
{
}

void FlowSimulation::SetState(const std::array<Scalar, 3>& velocity, const Scalar& temperature)
{
  const float cell = static_cast<float>(TwoPi / this->N);
  this->Pool.ParallelFor(this->N,
    [&](std::int64_t z)
    {
      for (int y = 0; y < this->N; ++y)
      {
        for (int x = 0; x < this->N; ++x)
        {
          const float px = x * cell, py = y * cell, pz = z * cell;
          for (int c = 0; c < 3; ++c)
          {
            this->State[c].Value(x, y, static_cast<int>(z)) = velocity[c](px, py, pz);
          }
          this->State[3].Value(x, y, static_cast<int>(z)) = temperature(px, py, pz);
        }
      }
    });
  this->Transform.ToModes(Pointers(this->State, 0, 4), this->Pool);
  this->Project();
}

void FlowSimulation::SetVelocitySpectrum(const Spectrum& spectrum)
{
  this->State = MakeFields(4, this->N);
  this->Pool.ParallelFor(this->N,
    [&](std::int64_t z)
    {
      WaveNumbers{ this->N }.ForCarried(static_cast<int>(z),
        [&](std::size_t m, float kx, float ky, float kz)
        {
          const auto u = spectrum(static_cast<int>(kx), static_cast<int>(ky), static_cast<int>(kz));
          for (int c = 0; c < 3; ++c)
          {
            this->State[c].Modes()[m] = u[c];
          }
        });
    });
  this->Project();
}

void FlowSimulation::Project()
{
  std::vector<PeriodicField> kept = MakeFields(4, this->N);
  this->Pool.ParallelFor(this->N,
    [&](std::int64_t z)
    {
      WaveNumbers{ this->N }.ForCarried(static_cast<int>(z),
        [&](std::size_t m, float kx, float ky, float kz)
        {
          std::array<Complex, 3> u = { this->State[0].Modes()[m], this->State[1].Modes()[m],
            this->State[2].Modes()[m] };
          RemoveGradient(u, kx, ky, kz);
          for (int c = 0; c < 3; ++c)
          {
            kept[c].Modes()[m] = u[c];
          }
          kept[3].Modes()[m] = this->State[3].Modes()[m];
        });
    });
  this->State = std::move(kept);
}

void FlowSimulation::AdvanceTo(double time)
{
  // What is left after the last step is rounding, not time.
  while (time - this->Now > 1e-9)
  {
    this->Step(time - this->Now);
  }
}

double FlowSimulation::Step(double timeLeft)
{
  // Williamson's coefficients; stage times are 0, 1/3 and 3/4 of the step.
  constexpr float weights[3] = { 0.0f, -5.0f / 9.0f, -153.0f / 128.0f };
  constexpr float shares[3] = { 1.0f / 3.0f, 15.0f / 16.0f, 8.0f / 15.0f };
  constexpr double durations[3] = { 1.0 / 3.0, 5.0 / 12.0, 1.0 / 4.0 };
  double step = 0.0;
  double time = this->Now;
  const bool heat = this->Parameters.WithTemperature;
  for (int stage = 0; stage < 3; ++stage)
  {
    this->CopyState();
    this->Transform.ToValues(Pointers(this->Scratch, 0, heat ? 7 : 6), this->Pool);
    if (stage == 0)
    {
      step = this->StableTimeStep(timeLeft);
    }
    this->FormProducts(time);
    this->Transform.ToModes(Pointers(this->Scratch, 0, heat ? 6 : 3), this->Pool);
    this->AddRates(weights[stage], static_cast<float>(step));
    this->AddAndDiffuse(shares[stage], durations[stage] * step);
    time += durations[stage] * step;
  }
  this->Now += step;
  ++this->Steps;
  return step;
}

void FlowSimulation::CopyState()
{
  const std::size_t slice = static_cast<std::size_t>(this->N) * this->State[0].RowModes();
  this->Pool.ParallelFor(this->N,
    [&](std::int64_t z)
    {
      for (PeriodicField& field : this->Scratch)
      {
        std::fill_n(field.Modes() + z * slice, slice, Complex());
      }
      WaveNumbers{ this->N }.ForCarried(static_cast<int>(z),
        [&](std::size_t m, float kx, float ky, float kz)
        {
          const Complex u = this->State[0].Modes()[m];
          const Complex v = this->State[1].Modes()[m];
          const Complex w = this->State[2].Modes()[m];
          this->Scratch[0].Modes()[m] = u;
          this->Scratch[1].Modes()[m] = v;
          this->Scratch[2].Modes()[m] = w;
          this->Scratch[3].Modes()[m] = TimesI(ky * w - kz * v);
          this->Scratch[4].Modes()[m] = TimesI(kz * u - kx * w);
          this->Scratch[5].Modes()[m] = TimesI(kx * v - ky * u);
          this->Scratch[6].Modes()[m] = this->State[3].Modes()[m];
        });
    });
}

double FlowSimulation::StableTimeStep(double timeLeft) const
{
  std::vector<float> fastest(this->N, 0.0f);
  this->Pool.ParallelFor(this->N,
    [&](std::int64_t z)
    {
      for (int y = 0; y < this->N; ++y)
      {
        for (int x = 0; x < this->N; ++x)
        {
          float speed = 0.0f;
          for (int c = 0; c < 3; ++c)
          {
            speed += std::abs(this->Scratch[c].Value(x, y, static_cast<int>(z)));
          }
          // Written so that NaN is kept, to be found below.
          fastest[z] = speed <= fastest[z] ? fastest[z] : speed;
        }
      }
    });
  float speed = 0.0f;
  for (const float slice : fastest)
  {
    if (!std::isfinite(slice))
    {
      throw Error("The flow became infinite: it needs more viscosity or a smaller Courant number.");
    }
    speed = std::max(speed, slice);
  }
  const double cell = TwoPi / this->N;
  const double stable = speed > 0.0f ? this->Parameters.Courant * cell / speed : timeLeft;
  return std::min({ stable, static_cast<double>(this->Parameters.LongestTimeStep), timeLeft });
}

std::vector<float> FlowSimulation::ForcingOnPlane(int z, double time) const
{
  const FlowForcing* forcing = this->Parameters.Forcing;
  if (forcing == nullptr || !forcing->ActsOnPlane(z))
  {
    return {};
  }
  const std::size_t count = static_cast<std::size_t>(this->N) * this->N;
  std::vector<float> accelerations(3 * count);
  for (int y = 0; y < this->N; ++y)
  {
    for (int x = 0; x < this->N; ++x)
    {
      const std::array<float, 3> velocity = { this->Scratch[0].Value(x, y, z),
        this->Scratch[1].Value(x, y, z), this->Scratch[2].Value(x, y, z) };
      const auto acceleration = forcing->Acceleration(x, y, z, time, velocity);
      for (int c = 0; c < 3; ++c)
      {
        accelerations[c * count + static_cast<std::size_t>(y) * this->N + x] = acceleration[c];
      }
    }
  }
  return accelerations;
}

void FlowSimulation::FormProducts(double time)
{
  const std::size_t row = this->State[0].RowReals();
  const std::size_t slice = static_cast<std::size_t>(this->N) * row;
  std::array<float*, 7> f;
  for (int i = 0; i < 7; ++i)
  {
    f[i] = this->Scratch[i].Values();
  }
  this->Pool.ParallelFor(this->N,
    [&](std::int64_t z)
    {
      const std::vector<float> forcing = this->ForcingOnPlane(static_cast<int>(z), time);
      for (std::size_t i = z * slice; i < (z + 1) * slice; ++i)
      {
        const float u = f[0][i], v = f[1][i], w = f[2][i];
        const float a = f[3][i], b = f[4][i], c = f[5][i];
        f[0][i] = v * c - w * b;
        f[1][i] = w * a - u * c;
        f[2][i] = u * b - v * a;
        if (this->Parameters.WithTemperature)
        {
          const float t = f[6][i];
          f[3][i] = u * t;
          f[4][i] = v * t;
          f[5][i] = w * t;
        }
      }
      for (std::size_t i = 0; i < forcing.size(); ++i)
      {
        const std::size_t line = i / this->N, c = line / this->N, y = line % this->N;
        f[c][z * slice + y * row + i % this->N] += forcing[i];
      }
    });
}

void FlowSimulation::AddRates(float weight, float timeStep)
{
  const float buoyancy = this->Parameters.Buoyancy;
  this->Pool.ParallelFor(this->N,
    [&](std::int64_t z)
    {
      WaveNumbers{ this->N }.ForCarried(static_cast<int>(z),
        [&](std::size_t m, float kx, float ky, float kz)
        {
          if (kx == 0.0f && ky == 0.0f && kz == 0.0f)
          {
            return; // nothing accelerates or heats the mean
          }
          std::array<Complex, 3> force = { this->Scratch[0].Modes()[m], this->Scratch[1].Modes()[m],
            this->Scratch[2].Modes()[m] + buoyancy * this->State[3].Modes()[m] };
          RemoveGradient(force, kx, ky, kz);
          const Complex heating =
            -TimesI(kx * this->Scratch[3].Modes()[m] + ky * this->Scratch[4].Modes()[m] +
                    kz * this->Scratch[5].Modes()[m]);
          for (int c = 0; c < (this->Parameters.WithTemperature ? 4 : 3); ++c)
          {
            Complex& rate = this->Rate[c].Modes()[m];
            rate = weight * rate + timeStep * (c < 3 ? force[c] : heating);
          }
        });
    });
}

void FlowSimulation::AddAndDiffuse(float share, double seconds)
{
  // exp(-viscosity k^2 t) is a product over the axes: one short table for each of both decays.
  std::vector<float> momentum(this->N / 2 + 1), heat(this->N / 2 + 1);
  for (std::size_t k = 0; k < momentum.size(); ++k)
  {
    const double squared = static_cast<double>(k * k);
    momentum[k] = static_cast<float>(std::exp(-this->Parameters.Viscosity * squared * seconds));
    heat[k] = static_cast<float>(std::exp(-this->Parameters.Diffusivity * squared * seconds));
  }
  const auto decay = [](const std::vector<float>& table, float kx, float ky, float kz)
  {
    return table[static_cast<int>(kx)] * table[static_cast<int>(std::abs(ky))] *
           table[static_cast<int>(std::abs(kz))];
  };
  this->Pool.ParallelFor(this->N,
    [&](std::int64_t z)
    {
      WaveNumbers{ this->N }.ForCarried(static_cast<int>(z),
        [&](std::size_t m, float kx, float ky, float kz)
        {
          const float decays[2] = { decay(momentum, kx, ky, kz), decay(heat, kx, ky, kz) };
          for (int c = 0; c < 4; ++c)
          {
            Complex& state = this->State[c].Modes()[m];
            Complex& rate = this->Rate[c].Modes()[m];
            state = (state + share * rate) * decays[c / 3];
            rate *= decays[c / 3];
          }
        });
    });
}

} // namespace banyan
