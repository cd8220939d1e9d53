// SPDX-License-Identifier: BSD-3-Clause
// What a FlowSimulation tells about its state.
#include "FlowSimulation.h"

#include "WaveNumbers.h"

#include "Base/ThreadPool.h"

#include <algorithm>
#include <cmath>

namespace banyan
{

namespace
{

constexpr double Pi = 3.141592653589793;

std::complex<float> TimesI(std::complex<float> c)
{
  return { -c.imag(), c.real() };
}

/// Without the padding of the rows.
std::vector<float> PlainValues(const PeriodicField& field, ThreadPool& pool)
{
  const std::size_t size = field.Size();
  std::vector<float> values(size * size * size);
  pool.ParallelFor(field.Size(),
    [&](std::int64_t z)
    {
      for (std::size_t row = z * size; row < (z + 1) * size; ++row)
      {
        std::copy_n(field.Values() + row * field.RowReals(), size, values.data() + row * size);
      }
    });
  return values;
}

} // namespace

std::array<std::vector<float>, 3> FlowSimulation::VectorField(const VectorMode& mode) const
{
  std::vector<PeriodicField> fields;
  for (int c = 0; c < 3; ++c)
  {
    fields.emplace_back(this->N);
  }
  this->Pool.ParallelFor(this->N,
    [&](std::int64_t z)
    {
      WaveNumbers{ this->N }.ForCarried(static_cast<int>(z),
        [&](std::size_t m, float kx, float ky, float kz)
        {
          const auto vector = mode({ kx, ky, kz },
            { this->State[0].Modes()[m], this->State[1].Modes()[m], this->State[2].Modes()[m] });
          for (int c = 0; c < 3; ++c)
          {
            fields[c].Modes()[m] = vector[c];
          }
        });
    });
  this->Transform.ToValues({ &fields[0], &fields[1], &fields[2] }, this->Pool);
  return { PlainValues(fields[0], this->Pool), PlainValues(fields[1], this->Pool),
    PlainValues(fields[2], this->Pool) };
}

std::vector<float> FlowSimulation::Temperature() const
{
  // The transform destroys the coefficients, so it gets a copy.
  PeriodicField field(this->N);
  std::copy_n(this->State[3].Modes(), field.ModeCount(), field.Modes());
  this->Transform.ToValues({ &field }, this->Pool);
  return PlainValues(field, this->Pool);
}

std::array<std::vector<float>, 3> FlowSimulation::Velocity() const
{
  return this->VectorField(
    [](const std::array<float, 3>&, const std::array<Complex, 3>& u) { return u; });
}

std::array<std::vector<float>, 3> FlowSimulation::Vorticity() const
{
  return this->VectorField(
    [](const std::array<float, 3>& k, const std::array<Complex, 3>& u)
    {
      return std::array<Complex, 3>{ TimesI(k[1] * u[2] - k[2] * u[1]),
        TimesI(k[2] * u[0] - k[0] * u[2]), TimesI(k[0] * u[1] - k[1] * u[0]) };
    });
}

std::array<std::vector<float>, 3> FlowSimulation::FaceVelocity() const
{
  // A mean over an interval of one cell multiplies a mode by sinc, a shift turns its phase. Carried
  // wave numbers are whole and below N / 3.
  std::vector<float> means;
  std::vector<Complex> shifts;
  for (int k = 0; k < this->N; ++k)
  {
    const double half = Pi * k / this->N;
    means.push_back(static_cast<float>(k == 0 ? 1.0 : std::sin(half) / half));
    shifts.push_back(Complex(std::polar(1.0, -half)));
  }
  return this->VectorField(
    [&](const std::array<float, 3>& k, const std::array<Complex, 3>& u)
    {
      const float mean[3] = { means[static_cast<int>(std::abs(k[0]))],
        means[static_cast<int>(std::abs(k[1]))], means[static_cast<int>(std::abs(k[2]))] };
      std::array<Complex, 3> faces;
      for (int c = 0; c < 3; ++c)
      {
        const Complex shift = shifts[static_cast<int>(std::abs(k[c]))];
        faces[c] =
          u[c] * (mean[(c + 1) % 3] * mean[(c + 2) % 3]) * (k[c] < 0.0f ? std::conj(shift) : shift);
      }
      return faces;
    });
}

double FlowSimulation::SumOfSquares(int power) const
{
  double sum = 0.0;
  for (int z = 0; z < this->N; ++z)
  {
    WaveNumbers{ this->N }.ForCarried(z,
      [&](std::size_t m, float kx, float ky, float kz)
      {
        // Modes with kx > 0 stand for themselves and for their conjugates.
        const double times = kx > 0.0f ? 1.0 : 0.5;
        const double weight = power == 0 ? 1.0 : kx * kx + ky * ky + kz * kz;
        for (int c = 0; c < 3; ++c)
        {
          sum += times * weight * std::norm(std::complex<double>(this->State[c].Modes()[m]));
        }
      });
  }
  return sum;
}

double FlowSimulation::KineticEnergy() const
{
  return this->SumOfSquares(0);
}

double FlowSimulation::Enstrophy() const
{
  // |curl u|^2 is k^2 |u|^2 for a field without divergence.
  return this->SumOfSquares(2);
}

double FlowSimulation::LargestDivergence() const
{
  double largest = 0.0;
  for (int z = 0; z < this->N; ++z)
  {
    WaveNumbers{ this->N }.ForCarried(z,
      [&](std::size_t m, float kx, float ky, float kz)
      {
        const Complex divergence = kx * this->State[0].Modes()[m] + ky * this->State[1].Modes()[m] +
                                   kz * this->State[2].Modes()[m];
        largest = std::max(largest, static_cast<double>(std::abs(divergence)));
      });
  }
  return largest;
}

} // namespace banyan
