// SPDX-License-Identifier: BSD-3-Clause
#include "BoxPoisson.h"

#include "Base/ThreadPool.h"

#include <fftw3.h>

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace banyan
{

namespace
{

constexpr double Pi = 3.141592653589793;

/// Eigenvalue of the second difference with closed ends; zero or negative.
double Eigenvalue(int k, int size)
{
  return 2.0 * std::cos(Pi * k / size) - 2.0;
}

} // namespace

struct BoxPoisson::Plans
{
  fftwf_plan Forward = nullptr;
  fftwf_plan Backward = nullptr;
};

BoxPoisson::BoxPoisson(int size)
  : Self(new Plans)
  , N(size)
  , Pivots(static_cast<std::size_t>(size) * size * size)
{
  const std::size_t plane = static_cast<std::size_t>(size) * size;
  // Slices of a vector are aligned differently; the plans must not count on any alignment, or the
  // bits might depend on where the memory lies.
  const unsigned flags = FFTW_ESTIMATE | FFTW_UNALIGNED;
  float* pattern = this->Pivots.data();
  this->Self->Forward =
    fftwf_plan_r2r_2d(size, size, pattern, pattern, FFTW_REDFT10, FFTW_REDFT10, flags);
  this->Self->Backward =
    fftwf_plan_r2r_2d(size, size, pattern, pattern, FFTW_REDFT01, FFTW_REDFT01, flags);

  for (int y = 0; y < size; ++y)
  {
    for (int x = 0; x < size; ++x)
    {
      const double across = Eigenvalue(x, size) + Eigenvalue(y, size);
      double last = 0.0;
      for (int z = 0; z < size; ++z)
      {
        const int neighbours = (z > 0) + (z + 1 < size);
        double pivot = across - neighbours - last;
        // The last pivot of the constant mode is exactly zero: p is 0 there, the free constant.
        const bool constant = x == 0 && y == 0 && z + 1 == size;
        last = constant ? 0.0 : 1.0 / pivot;
        this->Pivots[z * plane + static_cast<std::size_t>(y) * size + x] = static_cast<float>(last);
      }
    }
  }
}

BoxPoisson::~BoxPoisson()
{
  fftwf_destroy_plan(this->Self->Forward);
  fftwf_destroy_plan(this->Self->Backward);
}

void BoxPoisson::Solve(std::vector<float>& values, ThreadPool& pool) const
{
  const std::size_t plane = static_cast<std::size_t>(this->N) * this->N;
  pool.ParallelFor(this->N, [&](std::int64_t z)
    { fftwf_execute_r2r(this->Self->Forward, &values[z * plane], &values[z * plane]); });
  pool.ParallelFor(
    this->N, [&](std::int64_t y) { this->SolveColumns(values.data(), static_cast<int>(y)); });
  pool.ParallelFor(this->N, [&](std::int64_t z)
    { fftwf_execute_r2r(this->Self->Backward, &values[z * plane], &values[z * plane]); });
}

void BoxPoisson::SolveColumns(float* values, int y) const
{
  const int n = this->N;
  const std::size_t plane = static_cast<std::size_t>(n) * n;
  // FFTW's pair of transforms multiplies by 2N in each direction.
  const float scale = 1.0f / (4.0f * static_cast<float>(plane));
  float* row = values + static_cast<std::size_t>(y) * n;
  const float* pivots = this->Pivots.data() + static_cast<std::size_t>(y) * n;
  if (y == 0)
  {
    // The mean of everything, which no p makes, would all end up in the last plane.
    double sum = 0.0;
    for (int z = 0; z < n; ++z)
    {
      sum += row[z * plane];
    }
    for (int z = 0; z < n; ++z)
    {
      row[z * plane] -= static_cast<float>(sum / n);
    }
  }
  for (int x = 0; x < n; ++x)
  {
    row[x] *= scale * pivots[x];
  }
  for (int z = 1; z < n; ++z)
  {
    float* here = row + z * plane;
    const float* below = here - plane;
    const float* pivot = pivots + z * plane;
    for (int x = 0; x < n; ++x)
    {
      here[x] = (scale * here[x] - below[x]) * pivot[x];
    }
  }
  for (int z = n - 2; z >= 0; --z)
  {
    float* here = row + z * plane;
    const float* above = here + plane;
    const float* pivot = pivots + z * plane;
    for (int x = 0; x < n; ++x)
    {
      here[x] -= pivot[x] * above[x];
    }
  }
}

} // namespace banyan
