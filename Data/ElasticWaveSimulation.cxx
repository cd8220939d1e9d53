// SPDX-License-Identifier: BSD-3-Clause
#include "ElasticWaveSimulation.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace banyan
{

namespace
{

/// The axes of the three shear stresses.
constexpr int ShearAxes[3][2] = { { 0, 1 }, { 0, 2 }, { 1, 2 } };

void CheckMaterial(const ElasticMaterial& m)
{
  // A solid resists compression: its bulk modulus is positive.
  const bool solid =
    m.Density > 0.0f && m.ShearSpeed > 0.0f &&
    3.0f * m.PressureSpeed * m.PressureSpeed > 4.0f * m.ShearSpeed * m.ShearSpeed &&
    std::isfinite(m.Density * m.PressureSpeed * m.PressureSpeed);
  if (!solid)
  {
    throw Error(
      "Elastic waves need a solid everywhere: density and speeds above zero, P waves more "
      "than 1.16 times as fast as S waves.");
  }
}

} // namespace

ElasticWaveSimulation::ElasticWaveSimulation(
  const ElasticGrid& grid, const Ground& ground, const MomentSource& source, ThreadPool& pool)
  : Grid(grid)
  , Source(source)
  , Pool(pool)
  , Low(grid.DampedCells + GhostCells)
  , Row(static_cast<std::size_t>(grid.Size) + 2 * (grid.DampedCells + GhostCells))
  , First(-grid.DampedCells)
  , LastSide(grid.Size + grid.DampedCells - 1)
  , LastTop(grid.FreeSurface ? grid.Size - 1 : LastSide)
  , Stride{ 1, static_cast<std::ptrdiff_t>(Row), static_cast<std::ptrdiff_t>(Row * Row) }
{
  const std::size_t cells = this->Row * this->Row * (this->LastTop + 1 + GhostCells + this->Low);
  for (auto& v : this->V)
  {
    v.assign(cells, 0.0f);
  }
  for (auto& s : this->Stress)
  {
    s.assign(cells, 0.0f);
  }
  for (const int place : source.Cell)
  {
    if (place < 0 || place >= grid.Size)
    {
      throw Error("The source of elastic waves must lie in a cell of the grid.");
    }
  }
  this->SetMaterial(ground);
  this->SetDamping();
}

void ElasticWaveSimulation::SetMaterial(const Ground& ground)
{
  const int n = this->Grid.Size;
  const std::size_t cells = this->V[0].size();
  std::vector<float> density(cells), shear(cells);
  this->Lambda.resize(cells);
  this->Modulus.resize(cells);
  double fastest = 0.0;
  // The damped layers and the ghosts continue the outermost cells.
  for (int z = -this->Low; z <= this->LastTop + GhostCells; ++z)
  {
    for (int y = -this->Low; y < n + this->Low; ++y)
    {
      for (int x = -this->Low; x < n + this->Low; ++x)
      {
        const ElasticMaterial m =
          ground(std::clamp(x, 0, n - 1), std::clamp(y, 0, n - 1), std::clamp(z, 0, n - 1));
        CheckMaterial(m);
        const std::size_t p = this->Index(x, y, z);
        density[p] = m.Density;
        shear[p] = m.Density * m.ShearSpeed * m.ShearSpeed;
        this->Modulus[p] = m.Density * m.PressureSpeed * m.PressureSpeed;
        this->Lambda[p] = this->Modulus[p] - 2.0f * shear[p];
        fastest = std::max(fastest, static_cast<double>(m.PressureSpeed));
      }
    }
  }
  // Stable up to 6/7 / sqrt(3) cells per step for the fastest wave; nine tenths of that.
  this->TimeStep = 0.9 * (6.0 / 7.0) / std::sqrt(3.0) * this->Grid.CellMetres / fastest;
  this->Average(density, shear);
}

void ElasticWaveSimulation::Average(
  const std::vector<float>& density, const std::vector<float>& shear)
{
  const std::size_t cells = density.size();
  const float ratio = static_cast<float>(this->TimeStep / this->Grid.CellMetres);
  for (std::size_t p = 0; p < cells; ++p)
  {
    this->Lambda[p] *= ratio;
    this->Modulus[p] *= ratio;
  }
  const std::size_t inner = cells - this->Stride[0] - this->Stride[1] - this->Stride[2];
  for (int c = 0; c < 3; ++c)
  {
    this->Lightness[c].assign(cells, 0.0f);
    this->Shear[c].assign(cells, 0.0f);
    const std::size_t a = this->Stride[ShearAxes[c][0]], b = this->Stride[ShearAxes[c][1]];
    for (std::size_t p = 0; p < inner; ++p)
    {
      this->Lightness[c][p] = 2.0f * ratio / (density[p] + density[p + this->Stride[c]]);
      // Solids side by side share one shear stress: their compliances are averaged.
      this->Shear[c][p] =
        4.0f * ratio /
        (1.0f / shear[p] + 1.0f / shear[p + a] + 1.0f / shear[p + b] + 1.0f / shear[p + a + b]);
    }
  }
}

void ElasticWaveSimulation::SetDamping()
{
  const int n = this->Grid.Size;
  const auto factor = [&](int outside)
  {
    // Cerjan's factor: strong enough to absorb within the layers, smooth enough not to reflect.
    const double depth = 0.3 * std::max(outside, 0) / std::max(this->Grid.DampedCells, 1);
    return static_cast<float>(std::exp(-depth * depth));
  };
  for (int i = -this->Low; i < n + this->Low; ++i)
  {
    const bool surface = this->Grid.FreeSurface && i >= n;
    this->Damping[0].push_back(factor(std::max(-i, i - n + 1)));
    this->Damping[1].push_back(surface ? 1.0f : factor(std::max(-i, i - n + 1)));
  }
}

void ElasticWaveSimulation::ForPlanes(const std::function<void(int z)>& body) const
{
  this->Pool.ParallelFor(this->LastTop - this->First + 1,
    [&](std::int64_t i) { body(static_cast<int>(i) + this->First); });
}

void ElasticWaveSimulation::AdvanceTo(double seconds)
{
  const auto target = static_cast<std::int64_t>(std::llround(seconds / this->TimeStep));
  while (this->Steps < target)
  {
    this->Step();
  }
}

void ElasticWaveSimulation::Step()
{
  this->ForPlanes([&](int z) { this->AdvanceVelocity(z); });
  if (this->Grid.FreeSurface)
  {
    this->ExtendVelocity();
  }
  this->ForPlanes(
    [&](int z)
    {
      this->AdvanceNormalStress(z);
      this->AdvanceShearStress(z);
    });
  this->AddSource((static_cast<double>(this->Steps) + 0.5) * this->TimeStep);
  if (this->Grid.FreeSurface)
  {
    this->MirrorStress();
  }
  ++this->Steps;
}

void ElasticWaveSimulation::AddSource(double seconds)
{
  const double phase = (seconds - this->Source.Delay) / this->Source.HalfDuration;
  const double cell = this->Grid.CellMetres;
  const double rate = std::exp(-phase * phase) * this->TimeStep / (cell * cell * cell);
  const auto [x, y, z] = this->Source.Cell;
  const std::size_t p = this->Index(x, y, z);
  for (int c = 0; c < 3; ++c)
  {
    this->Stress[c][p] -= static_cast<float>(rate * this->Source.Moment[c]);
  }
  // Shear stresses live on edges: a quarter on each of the four around the cell.
  for (int c = 0; c < 3; ++c)
  {
    const std::ptrdiff_t a = this->Stride[ShearAxes[c][0]], b = this->Stride[ShearAxes[c][1]];
    const float quarter = static_cast<float>(0.25 * rate * this->Source.Moment[3 + c]);
    for (const std::ptrdiff_t away : { std::ptrdiff_t(0), a, b, a + b })
    {
      this->Stress[3 + c][p - away] -= quarter;
    }
  }
}

std::array<float, 3> ElasticWaveSimulation::Velocity(int x, int y, int z) const
{
  const std::size_t p = this->Index(x, y, z);
  std::array<float, 3> v;
  for (int c = 0; c < 3; ++c)
  {
    v[c] = 0.5f * (this->V[c][p] + this->V[c][p - this->Stride[c]]);
  }
  return v;
}

std::vector<float> ElasticWaveSimulation::Speed() const
{
  const int n = this->Grid.Size;
  std::vector<float> speed(static_cast<std::size_t>(n) * n * n);
  this->Pool.ParallelFor(n,
    [&](std::int64_t z)
    {
      float* value = &speed[z * n * n];
      bool finite = true;
      for (int y = 0; y < n; ++y)
      {
        for (int x = 0; x < n; ++x, ++value)
        {
          const auto v = this->Velocity(x, y, static_cast<int>(z));
          *value = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
          finite = finite && std::isfinite(*value);
        }
      }
      if (!finite)
      {
        throw Error("The waves became infinite: the source is too strong for single precision.");
      }
    });
  return speed;
}

double ElasticWaveSimulation::Energy() const
{
  std::vector<double> planes(this->LastTop - this->First + 1);
  this->ForPlanes(
    [&](int z)
    {
      // Half of the cells in a free surface lie outside the ground, and the vertical component
      // and its shear stresses altogether.
      const bool surface = this->Grid.FreeSurface && z == this->LastTop;
      double sum = 0.0;
      for (int y = this->First; y <= this->LastSide; ++y)
      {
        const std::size_t end = this->Index(this->LastSide, y, z);
        for (std::size_t p = this->Index(this->First, y, z); p <= end; ++p)
        {
          sum += this->EnergyDensity(p, !surface);
        }
      }
      planes[z - this->First] = surface ? 0.5 * sum : sum;
    });
  const double cell = this->Grid.CellMetres;
  return std::accumulate(planes.begin(), planes.end(), 0.0) * cell * cell * cell;
}

double ElasticWaveSimulation::EnergyDensity(std::size_t p, bool vertical) const
{
  const double ratio = this->TimeStep / this->Grid.CellMetres;
  double sum = 0.0, trace = 0.0, squares = 0.0;
  for (int c = 0; c < 3; ++c)
  {
    const double v = this->V[c][p], normal = this->Stress[c][p], shear = this->Stress[3 + c][p];
    sum += vertical || c != 2 ? v * v * ratio / this->Lightness[c][p] : 0.0;
    sum += vertical || c == 0 ? shear * shear * ratio / this->Shear[c][p] : 0.0;
    trace += normal;
    squares += normal * normal;
  }
  // Hooke's law the other way round: normal strains from normal stresses.
  const double lambda = this->Lambda[p] / ratio;
  const double twoMu = this->Modulus[p] / ratio - lambda;
  return 0.5 * (sum + (squares - lambda / (3.0 * lambda + twoMu) * trace * trace) / twoMu);
}

} // namespace banyan
