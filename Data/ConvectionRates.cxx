// SPDX-License-Identifier: BSD-3-Clause
// The right-hand sides of ConvectionSimulation, where its time is spent: rows of cells in loops
// that compilers turn into vector instructions.
#include "ConvectionSimulation.h"

#include <cmath>
#include <utility>

namespace banyan
{

namespace
{

/// Heat carried through the low face of a cell: `t` points at the temperature of the cell, `s` is
/// the distance to its neighbours. The face takes its temperature from the cell upwind, corrected
/// to third order where the profile is smooth, and limited so that no new extreme appears (Koren).
inline float HeatFlux(const float* t, std::ptrdiff_t s, float speed)
{
  const float lower = t[-2 * s], low = t[-s], high = t[0], higher = t[s];
  const bool up = speed > 0.0f;
  const float upwind = up ? low : high;
  const float a = upwind - (up ? lower : higher);
  const float b = (up ? high : low) - upwind;
  const float sizeA = std::abs(a), sizeB = std::abs(b);
  const float smooth = (sizeA + 2.0f * sizeB) * (1.0f / 6.0f);
  const float steep = sizeA < sizeB ? sizeA : sizeB;
  const float limited = std::copysign(steep < smooth ? steep : smooth, a);
  return speed * (upwind + (a * b > 0.0f ? limited : 0.0f));
}

/// A row of faces of one velocity component, and what acts on it.
struct MomentumRow
{
  const float* Component;               ///< the component itself
  std::array<const float*, 3> Velocity; ///< all three, at the same cell
  std::array<std::ptrdiff_t, 3> Stride;
  std::ptrdiff_t Along; ///< the component's own stride
  int Count;
  float Flow, Diffusion; ///< factors of the differences of fluxes and of the Laplacian
};

/// rate = weight * rate + (diffusion - div(u u)). A flux through a face of the shifted cell is the
/// product of two means of two neighbours.
void AddMomentumRow(const MomentumRow& row, float weight, float* __restrict rate)
{
  const std::ptrdiff_t along = row.Along;
  const std::ptrdiff_t sx = row.Stride[0], sy = row.Stride[1], sz = row.Stride[2];
  const float flow = row.Flow, diffusion = row.Diffusion;
  const float* __restrict a = row.Component;
  const float* __restrict u = row.Velocity[0];
  const float* __restrict v = row.Velocity[1];
  const float* __restrict w = row.Velocity[2];
  for (int i = 0; i < row.Count; ++i)
  {
    const float c = a[i];
    const float xl = (u[i] + u[i - along]) * (c + a[i - sx]);
    const float xh = (u[i + sx] + u[i + sx - along]) * (a[i + sx] + c);
    const float yl = (v[i] + v[i - along]) * (c + a[i - sy]);
    const float yh = (v[i + sy] + v[i + sy - along]) * (a[i + sy] + c);
    const float zl = (w[i] + w[i - along]) * (c + a[i - sz]);
    const float zh = (w[i + sz] + w[i + sz - along]) * (a[i + sz] + c);
    const float around =
      (a[i - sx] + a[i + sx]) + (a[i - sy] + a[i + sy]) + (a[i - sz] + a[i + sz]) - 6.0f * c;
    rate[i] = weight * rate[i] + (diffusion * around - flow * ((xh - xl) + (yh - yl) + (zh - zl)));
  }
}

} // namespace

void ConvectionSimulation::AddMomentumRates(int component, int z, float weight, float timeStep)
{
  if (component == 2 && z == 0)
  {
    return; // the wall
  }
  const int n = this->Size();
  const float cells = static_cast<float>(n);
  const int firstX = component == 0 ? 1 : 0;
  MomentumRow row;
  row.Stride = this->State.Strides();
  row.Along = row.Stride[component];
  row.Count = n - firstX;
  row.Flow = 0.25f * timeStep * cells;
  row.Diffusion = timeStep * static_cast<float>(this->Nu) * cells * cells;
  for (int y = component == 1 ? 1 : 0; y < n; ++y)
  {
    const std::size_t p = this->State.Index(firstX, y, z);
    for (int c = 0; c < 3; ++c)
    {
      row.Velocity[c] = this->State[c].data() + p;
    }
    row.Component = row.Velocity[component];
    float* __restrict rate = this->Rate[component].data() + p;
    AddMomentumRow(row, weight, rate);
    if (component == 2)
    {
      const float* t = this->State[3].data() + p;
      const float* below = t - row.Stride[2];
      for (int x = 0; x < row.Count; ++x)
      {
        rate[x] += 0.5f * timeStep * (t[x] + below[x]);
      }
    }
  }
}

void ConvectionSimulation::AddTemperatureRates(int z, float weight, float timeStep)
{
  const int n = this->Size();
  const float cells = static_cast<float>(n);
  const float diffusion = timeStep * static_cast<float>(this->Kappa) * cells * cells;
  const float flow = timeStep * cells;
  const std::ptrdiff_t sy = this->State.Strides()[1], sz = this->State.Strides()[2];
  // Fluxes in x and y are formed once for both cells that share a face. The first row's low
  // fluxes in y pass through the wall: they are zero.
  std::vector<float> fluxX(n + 1), lowY(n, 0.0f), highY(n);
  for (int y = 0; y < n; ++y)
  {
    const std::size_t p = this->State.Index(0, y, z);
    const float* t = this->State[3].data() + p;
    const float* u = this->State[0].data() + p;
    const float* v = this->State[1].data() + p;
    const float* w = this->State[2].data() + p;
    float* __restrict rate = this->Rate[3].data() + p;
    float* __restrict fx = fluxX.data();
    float* __restrict fy = highY.data();
    const float* __restrict gy = lowY.data();
    for (int x = 0; x <= n; ++x)
    {
      fx[x] = HeatFlux(t + x, 1, u[x]);
    }
    for (int x = 0; x < n; ++x)
    {
      fy[x] = HeatFlux(t + x + sy, sy, v[x + sy]);
    }
    for (int x = 0; x < n; ++x)
    {
      const float low = HeatFlux(t + x, sz, w[x]);
      const float high = HeatFlux(t + x + sz, sz, w[x + sz]);
      const float around =
        (t[x - 1] + t[x + 1]) + (t[x - sy] + t[x + sy]) + (t[x - sz] + t[x + sz]) - 6.0f * t[x];
      rate[x] = weight * rate[x] + (diffusion * around -
                                     flow * ((fx[x + 1] - fx[x]) + (fy[x] - gy[x]) + (high - low)));
    }
    std::swap(lowY, highY);
  }
}

} // namespace banyan
