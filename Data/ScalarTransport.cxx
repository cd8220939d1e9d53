// SPDX-License-Identifier: BSD-3-Clause
#include "ScalarTransport.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <algorithm>
#include <cmath>

namespace banyan
{

namespace
{

/// Two steps of Euler's method keep the bounds as long as twice the share of a cell that flows in
/// during one, and what diffuses in, stay below 1; some room is left for rounding.
constexpr double LargestShare = 0.9;

/// Smaller values become zero. Diffusion would otherwise fill the box with numbers of no meaning,
/// the smallest of which processors handle very slowly.
constexpr float Nothing = 1e-20f;

/// Half the limited difference: from a cell's mean to its value at the face towards `after`.
inline float HalfSlope(float before, float here, float after)
{
  const float a = here - before, b = after - here;
  const float product = a * b;
  return product > 0.0f ? product / (a + b) : 0.0f;
}

/// What flows upwards through a face per area and time, times dt / h.
/// @param c two cells below and two above the face
inline float Flux(float c0, float c1, float c2, float c3, float shift, float spread)
{
  const float below = c1 + HalfSlope(c0, c1, c2);
  const float above = c2 - HalfSlope(c1, c2, c3);
  return std::max(shift, 0.0f) * below + std::min(shift, 0.0f) * above - spread * (c2 - c1);
}

/// Adds to a row of N cells what flows in through its faces along one axis.
/// @param rows the five rows from two cells below to two above
/// @param lower, upper velocities through the faces below and above
void AddFluxes(int size, const std::array<const float*, 5>& rows, const float* lower,
  const float* upper, float factor, float spread, float* sum)
{
  const float *a = rows[0], *b = rows[1], *c = rows[2], *d = rows[3], *e = rows[4];
  for (int x = 0; x < size; ++x)
  {
    sum[x] += Flux(a[x], b[x], c[x], d[x], factor * lower[x], spread) -
              Flux(b[x], c[x], d[x], e[x], factor * upper[x], spread);
  }
}

} // namespace

ScalarTransport::ScalarTransport(int size, double cell, double diffusivity, ThreadPool& pool)
  : N(size)
  , Cell(cell)
  , Diffusivity(diffusivity)
  , Pool(pool)
{
  if (size < 4)
  {
    throw Error("The transport of a scalar needs at least 4 cells per axis.");
  }
  this->Scalar.assign(static_cast<std::size_t>(size) * size * size, 0.0f);
  this->Between = this->Scalar;
}

double ScalarTransport::LargestInflow(const FaceVelocity& velocity) const
{
  const std::size_t n = this->N;
  std::vector<float> largest(n, 0.0f);
  this->Pool.ParallelFor(this->N,
    [&](std::int64_t z)
    {
      const std::size_t zUp = (z + 1) % n;
      for (std::size_t y = 0; y < n; ++y)
      {
        const std::size_t row = (z * n + y) * n, yUp = (z * n + (y + 1) % n) * n;
        for (std::size_t x = 0; x < n; ++x)
        {
          const float inflow =
            std::max(velocity[0][row + x], 0.0f) - std::min(velocity[0][row + (x + 1) % n], 0.0f) +
            std::max(velocity[1][row + x], 0.0f) - std::min(velocity[1][yUp + x], 0.0f) +
            std::max(velocity[2][row + x], 0.0f) -
            std::min(velocity[2][(zUp * n + y) * n + x], 0.0f);
          largest[z] = std::max(largest[z], inflow);
        }
      }
    });
  return *std::max_element(largest.begin(), largest.end());
}

void ScalarTransport::Stage(const std::vector<float>& from, const FaceVelocity& velocity,
  double seconds, float share, std::vector<float>& result)
{
  const int n = this->N;
  const float factor = static_cast<float>(seconds / this->Cell);
  const float spread = static_cast<float>(this->Diffusivity * seconds / (this->Cell * this->Cell));
  const auto rowStart = [n](int y, int z)
  { return (static_cast<std::size_t>((z + n) % n) * n + (y + n) % n) * n; };
  this->Pool.ParallelFor(n,
    [&](std::int64_t plane)
    {
      const int z = static_cast<int>(plane);
      std::vector<float> sum(n), wrapped(n + 4), faces(n + 1);
      for (int y = 0; y < n; ++y)
      {
        const std::size_t row = rowStart(y, z);
        std::fill(sum.begin(), sum.end(), 0.0f);
        const float* here = from.data() + row;
        // Along x the row is its own neighbour, two cells to each side.
        std::copy_n(here, n, wrapped.begin() + 2);
        std::copy_n(here + n - 2, 2, wrapped.begin());
        std::copy_n(here, 2, wrapped.begin() + n + 2);
        std::copy_n(velocity[0].data() + row, n, faces.begin());
        faces[n] = faces[0];
        const float* w = wrapped.data();
        AddFluxes(n, { w, w + 1, w + 2, w + 3, w + 4 }, faces.data(), faces.data() + 1, factor,
          spread, sum.data());
        std::array<const float*, 5> rows;
        for (int i = 0; i < 5; ++i)
        {
          rows[i] = from.data() + rowStart(y + i - 2, z);
        }
        AddFluxes(n, rows, velocity[1].data() + row, velocity[1].data() + rowStart(y + 1, z),
          factor, spread, sum.data());
        for (int i = 0; i < 5; ++i)
        {
          rows[i] = from.data() + rowStart(y, z + i - 2);
        }
        AddFluxes(n, rows, velocity[2].data() + row, velocity[2].data() + rowStart(y, z + 1),
          factor, spread, sum.data());
        for (int x = 0; x < n; ++x)
        {
          const float old = this->Scalar[row + x];
          const float value = old + share * (here[x] + sum[x] - old);
          result[row + x] = std::abs(value) < Nothing ? 0.0f : value;
        }
      }
    });
}

ScalarTransport::FaceVelocity ScalarTransport::Mix(
  const FaceVelocity& from, const FaceVelocity& to, float share) const
{
  FaceVelocity mixed;
  const std::size_t slice = static_cast<std::size_t>(this->N) * this->N;
  for (int c = 0; c < 3; ++c)
  {
    mixed[c].resize(slice * this->N);
    this->Pool.ParallelFor(this->N,
      [&](std::int64_t z)
      {
        for (std::size_t i = z * slice; i < (z + 1) * slice; ++i)
        {
          mixed[c][i] = from[c][i] + share * (to[c][i] - from[c][i]);
        }
      });
  }
  return mixed;
}

void ScalarTransport::Advance(const FaceVelocity& from, const FaceVelocity& to, double seconds)
{
  const double inflow = std::max(this->LargestInflow(from), this->LargestInflow(to));
  const double share = (2.0 * inflow + 6.0 * this->Diffusivity / this->Cell) * seconds / this->Cell;
  const int steps = std::max(1, static_cast<int>(std::ceil(share / LargestShare)));
  FaceVelocity velocity = from;
  for (int step = 0; step < steps; ++step)
  {
    this->Stage(this->Scalar, velocity, seconds / steps, 1.0f, this->Between);
    velocity = this->Mix(from, to, (step + 1.0f) / steps);
    // Heun: the mean of the old state and of two Euler steps. Each cell of the result depends on
    // the old state in the same cell only, so it may take its place.
    this->Stage(this->Between, velocity, seconds / steps, 0.5f, this->Scalar);
  }
}

} // namespace banyan
