// SPDX-License-Identifier: BSD-3-Clause
// The differences of ElasticWaveSimulation, where its time is spent: rows of cells in loops that
// compilers turn into vector instructions.
#include "ElasticWaveSimulation.h"

namespace banyan
{

namespace
{

// Weights of the fourth-order difference of values half a cell and one and a half cells away.
constexpr float Near = 9.0f / 8.0f, Far = -1.0f / 24.0f;

/// Difference between f[0] and f[s].
inline float Ahead(const float* f, std::ptrdiff_t s)
{
  return Near * (f[s] - f[0]) + Far * (f[2 * s] - f[-s]);
}

/// Difference between f[-s] and f[0].
inline float Behind(const float* f, std::ptrdiff_t s)
{
  return Near * (f[0] - f[-s]) + Far * (f[s] - f[-2 * s]);
}

} // namespace

void ElasticWaveSimulation::AdvanceVelocity(int z)
{
  const std::ptrdiff_t sy = this->Stride[1], sz = this->Stride[2];
  const int count = this->LastSide - this->First + 1;
  const float* side = this->Damping[0].data() + (this->First + this->Low);
  // The vertical component above the last plane would lie outside the ground.
  const int vertical = this->Grid.FreeSurface && z == this->LastTop ? 0 : count;
  for (int y = this->First; y <= this->LastSide; ++y)
  {
    const std::size_t p = this->Index(this->First, y, z);
    const float* xx = this->Stress[0].data() + p;
    const float* yy = this->Stress[1].data() + p;
    const float* zz = this->Stress[2].data() + p;
    const float* xy = this->Stress[3].data() + p;
    const float* xz = this->Stress[4].data() + p;
    const float* yz = this->Stress[5].data() + p;
    const float* light[3];
    float* v[3];
    for (int c = 0; c < 3; ++c)
    {
      light[c] = this->Lightness[c].data() + p;
      v[c] = this->V[c].data() + p;
    }
    const float damp = this->Damping[0][y + this->Low] * this->Damping[1][z + this->Low];
    float* __restrict vx = v[0];
    for (int x = 0; x < count; ++x)
    {
      const float force = Ahead(xx + x, 1) + Behind(xy + x, sy) + Behind(xz + x, sz);
      vx[x] = damp * side[x] * (vx[x] + light[0][x] * force);
    }
    float* __restrict vy = v[1];
    for (int x = 0; x < count; ++x)
    {
      const float force = Behind(xy + x, 1) + Ahead(yy + x, sy) + Behind(yz + x, sz);
      vy[x] = damp * side[x] * (vy[x] + light[1][x] * force);
    }
    float* __restrict vz = v[2];
    for (int x = 0; x < vertical; ++x)
    {
      const float force = Behind(xz + x, 1) + Behind(yz + x, sy) + Ahead(zz + x, sz);
      vz[x] = damp * side[x] * (vz[x] + light[2][x] * force);
    }
  }
}

void ElasticWaveSimulation::AdvanceNormalStress(int z)
{
  const std::ptrdiff_t sy = this->Stride[1], sz = this->Stride[2];
  const int count = this->LastSide - this->First + 1;
  const float* side = this->Damping[0].data() + (this->First + this->Low);
  // Near the surface there is nothing above for a difference of fourth order.
  const bool shallow = this->Grid.FreeSurface && z >= this->LastTop - 1;
  const float near = shallow ? 1.0f : Near, far = shallow ? 0.0f : Far;
  for (int y = this->First; y <= this->LastSide; ++y)
  {
    const std::size_t p = this->Index(this->First, y, z);
    const float* vx = this->V[0].data() + p;
    const float* vy = this->V[1].data() + p;
    const float* vz = this->V[2].data() + p;
    const float* lambda = this->Lambda.data() + p;
    const float* modulus = this->Modulus.data() + p;
    float* __restrict xx = this->Stress[0].data() + p;
    float* __restrict yy = this->Stress[1].data() + p;
    float* __restrict zz = this->Stress[2].data() + p;
    const float damp = this->Damping[0][y + this->Low] * this->Damping[1][z + this->Low];
    for (int x = 0; x < count; ++x)
    {
      const float ex = Behind(vx + x, 1);
      const float ey = Behind(vy + x, sy);
      const float ez = near * (vz[x] - vz[x - sz]) + far * (vz[x + sz] - vz[x - 2 * sz]);
      const float d = damp * side[x];
      xx[x] = d * (xx[x] + modulus[x] * ex + lambda[x] * (ey + ez));
      yy[x] = d * (yy[x] + modulus[x] * ey + lambda[x] * (ex + ez));
      zz[x] = d * (zz[x] + modulus[x] * ez + lambda[x] * (ex + ey));
    }
  }
}

void ElasticWaveSimulation::AdvanceShearStress(int z)
{
  const std::ptrdiff_t sy = this->Stride[1], sz = this->Stride[2];
  const int count = this->LastSide - this->First + 1;
  const float* side = this->Damping[0].data() + (this->First + this->Low);
  // As above; and the shear stresses above the last plane lie outside the ground.
  const bool shallow = this->Grid.FreeSurface && z >= this->LastTop - 1;
  const int vertical = this->Grid.FreeSurface && z == this->LastTop ? 0 : count;
  const float near = shallow ? 1.0f : Near, far = shallow ? 0.0f : Far;
  for (int y = this->First; y <= this->LastSide; ++y)
  {
    const std::size_t p = this->Index(this->First, y, z);
    const float* vx = this->V[0].data() + p;
    const float* vy = this->V[1].data() + p;
    const float* vz = this->V[2].data() + p;
    const float* mxy = this->Shear[0].data() + p;
    const float* mxz = this->Shear[1].data() + p;
    const float* myz = this->Shear[2].data() + p;
    const float damp = this->Damping[0][y + this->Low] * this->Damping[1][z + this->Low];
    float* __restrict xy = this->Stress[3].data() + p;
    for (int x = 0; x < count; ++x)
    {
      xy[x] = damp * side[x] * (xy[x] + mxy[x] * (Ahead(vx + x, sy) + Ahead(vy + x, 1)));
    }
    float* __restrict xz = this->Stress[4].data() + p;
    for (int x = 0; x < vertical; ++x)
    {
      const float up = near * (vx[x + sz] - vx[x]) + far * (vx[x + 2 * sz] - vx[x - sz]);
      xz[x] = damp * side[x] * (xz[x] + mxz[x] * (up + Ahead(vz + x, 1)));
    }
    float* __restrict yz = this->Stress[5].data() + p;
    for (int x = 0; x < vertical; ++x)
    {
      const float up = near * (vy[x + sz] - vy[x]) + far * (vy[x + 2 * sz] - vy[x - sz]);
      yz[x] = damp * side[x] * (yz[x] + myz[x] * (up + Ahead(vz + x, sy)));
    }
  }
}

void ElasticWaveSimulation::ExtendVelocity()
{
  // No vertical stress at the surface: the vertical component above follows from the strain.
  const std::ptrdiff_t sy = this->Stride[1], sz = this->Stride[2];
  for (int y = this->First; y <= this->LastSide; ++y)
  {
    for (int x = this->First; x <= this->LastSide; ++x)
    {
      const std::size_t p = this->Index(x, y, this->LastTop);
      const float strain = Behind(&this->V[0][p], 1) + Behind(&this->V[1][p], sy);
      this->V[2][p] = this->V[2][p - sz] - this->Lambda[p] / this->Modulus[p] * strain;
    }
  }
}

void ElasticWaveSimulation::MirrorStress()
{
  // Tractions that are odd about the surface vanish on it (Levander).
  const std::ptrdiff_t sz = this->Stride[2];
  const std::size_t start = this->Index(-this->Low, -this->Low, this->LastTop);
  for (std::size_t p = start; p < start + sz; ++p)
  {
    this->Stress[2][p] = 0.0f;
    this->Stress[2][p + sz] = -this->Stress[2][p - sz];
    this->Stress[2][p + 2 * sz] = -this->Stress[2][p - 2 * sz];
    for (int c = 4; c < 6; ++c)
    {
      this->Stress[c][p] = -this->Stress[c][p - sz];
      this->Stress[c][p + sz] = -this->Stress[c][p - 2 * sz];
    }
  }
}

} // namespace banyan
