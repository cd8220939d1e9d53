// SPDX-License-Identifier: BSD-3-Clause
// What HexWaveSimulation works with: masses, losses, sources, and who hangs on whom.
#include "HexWaveSimulation.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <algorithm>
#include <cmath>

namespace banyan
{

namespace
{

/// Share of the largest time step that is surely stable.
constexpr double Courant = 0.95;

/// A solid resists compression: its bulk modulus is positive.
bool IsSolid(const ElasticMaterial& m)
{
  return m.Density > 0.0f && m.ShearSpeed > 0.0f &&
         3.0f * m.PressureSpeed * m.PressureSpeed > 4.0f * m.ShearSpeed * m.ShearSpeed &&
         std::isfinite(m.Density * m.PressureSpeed * m.PressureSpeed);
}

/// Lame's second and first moduli.
float Mu(const ElasticMaterial& m)
{
  return m.Density * m.ShearSpeed * m.ShearSpeed;
}
float Lambda(const ElasticMaterial& m)
{
  return m.Density * m.PressureSpeed * m.PressureSpeed - 2.0f * Mu(m);
}

std::vector<ElasticMaterial> MaterialsOf(
  const OctreeMesh& mesh, const HexWaveSimulation::Ground& ground, ThreadPool& pool)
{
  constexpr std::int64_t Batch = 4096;
  const auto cells = static_cast<std::int64_t>(mesh.CellCount());
  std::vector<ElasticMaterial> materials(mesh.CellCount());
  pool.ParallelFor((cells + Batch - 1) / Batch,
    [&](std::int64_t batch)
    {
      for (std::int64_t i = batch * Batch; i < std::min(cells, (batch + 1) * Batch); ++i)
      {
        const MeshOctant cell = mesh.Cell(i);
        auto middle = mesh.CornerPoint(cell);
        for (double& p : middle)
        {
          p += 0.5 * mesh.EdgeOfLevel(cell.Level);
        }
        materials[i] = ground(middle);
        if (!IsSolid(materials[i]))
        {
          throw Error("Elastic waves need a solid everywhere: density and speeds above zero, P "
                      "waves more than 1.16 times as fast as S waves.");
        }
      }
    });
  return materials;
}

/// The largest time step for which central differences are surely stable: no mode of a cell by
/// itself oscillates faster than the larger of its dilation and its shear (Irons and Treharne: the
/// whole mesh oscillates no faster than its fastest cell).
double StableStep(const OctreeMesh& mesh, const std::vector<ElasticMaterial>& materials)
{
  double fastest = 0.0;
  for (std::size_t i = 0; i < materials.size(); ++i)
  {
    const double h = mesh.EdgeOfLevel(mesh.Cell(i).Level);
    const double lambda = Lambda(materials[i]), mu = Mu(materials[i]);
    fastest =
      std::max(fastest, (12.0 * std::max(lambda, 0.0) + 8.0 * mu) / (materials[i].Density * h * h));
  }
  return 2.0 / std::sqrt(fastest);
}

} // namespace

HexWaveSimulation::HexWaveSimulation(const OctreeMesh& mesh, const Ground& ground,
  const std::vector<MomentPoint>& sources, const HexWaveLosses& losses, ThreadPool& pool)
  : Pool(pool)
  , Sources(sources)
  , Hanging(mesh.Hanging())
{
  const std::vector<ElasticMaterial> materials = MaterialsOf(mesh, ground, pool);
  this->TimeStep = Courant * StableStep(mesh, materials);
  this->FindMasters(mesh.NodeCount());
  this->SetMasses(mesh, materials);
  this->SetLosses(mesh, materials, losses);
  this->PlaceSources(mesh);
  {
    std::vector<float> lambda(materials.size()), mu(materials.size());
    std::transform(materials.begin(), materials.end(), lambda.begin(), Lambda);
    std::transform(materials.begin(), materials.end(), mu.begin(), Mu);
    this->Forces = std::make_unique<HexForces>(mesh, lambda, mu, pool);
  }
  for (auto* values : { &this->U, &this->V, &this->F })
  {
    values->assign(3 * mesh.NodeCount(), 0.0f);
  }
}

void HexWaveSimulation::FindMasters(std::size_t nodes)
{
  std::vector<std::uint32_t> uses(nodes, 0);
  for (const MeshHangingNode& hanging : this->Hanging)
  {
    for (const std::uint32_t master : hanging.Masters)
    {
      ++uses[master];
    }
  }
  this->MasterStart.push_back(0);
  for (std::size_t node = 0; node < nodes; ++node)
  {
    if (uses[node] > 0)
    {
      this->Masters.push_back(static_cast<std::uint32_t>(node));
      this->MasterStart.push_back(this->MasterStart.back() + uses[node]);
      uses[node] = this->MasterStart[this->Masters.size() - 1];
    }
  }
  this->HangingOfMaster.resize(this->MasterStart.back());
  for (const MeshHangingNode& hanging : this->Hanging)
  {
    for (const std::uint32_t master : hanging.Masters)
    {
      this->HangingOfMaster[uses[master]++] = hanging.Node;
    }
  }
}

template <typename Value>
void HexWaveSimulation::GiveToMasters(std::vector<Value>& values) const
{
  const auto add = [](auto& to, const auto& from, float share)
  {
    if constexpr (std::is_same_v<Value, float>)
    {
      to += share * from;
    }
    else
    {
      for (std::size_t c = 0; c < from.size(); ++c)
      {
        to[c] += share * from[c];
      }
    }
  };
  for (const MeshHangingNode& hanging : this->Hanging)
  {
    for (const std::uint32_t master : hanging.Masters)
    {
      add(values[master], values[hanging.Node], 0.25f);
    }
    values[hanging.Node] = Value{};
  }
}

void HexWaveSimulation::SetMasses(
  const OctreeMesh& mesh, const std::vector<ElasticMaterial>& materials)
{
  this->Mass.assign(mesh.NodeCount(), 0.0f);
  for (std::size_t i = 0; i < materials.size(); ++i)
  {
    const double h = mesh.EdgeOfLevel(mesh.Cell(i).Level);
    for (const std::uint32_t node : mesh.Corners(i))
    {
      this->Mass[node] += static_cast<float>(materials[i].Density * h * h * h / 8.0);
    }
  }
  this->GiveToMasters(this->Mass);
}

void HexWaveSimulation::SetLosses(const OctreeMesh& mesh,
  const std::vector<ElasticMaterial>& materials, const HexWaveLosses& losses)
{
  const std::size_t nodes = mesh.NodeCount();
  const float step = static_cast<float>(this->TimeStep);
  // Loss: half a time step times the rate at which speed is lost.
  std::vector<float> loss(nodes, 0.0f);
  if (losses.DecayRate)
  {
    for (std::size_t i = 0; i < materials.size(); ++i)
    {
      const double h = mesh.EdgeOfLevel(mesh.Cell(i).Level);
      const double mass = materials[i].Density * h * h * h / 8.0;
      for (const std::uint32_t node : mesh.Corners(i))
      {
        // Half a time step times twice the rate: half of the energy is strain, which does not
        // decay.
        loss[node] += static_cast<float>(this->TimeStep * losses.DecayRate(materials[i]) * mass);
      }
    }
    this->GiveToMasters(loss);
  }
  std::vector<std::array<float, 3>> drag(nodes);
  for (int side = 0; side < 6; ++side)
  {
    if (losses.OpenSides[side])
    {
      this->AddOpenSide(mesh, materials, side, drag);
    }
  }
  this->GiveToMasters(drag);
  this->Keep.assign(nodes, 1.0f);
  this->Push.assign(nodes, 0.0f);
  for (std::size_t node = 0; node < nodes; ++node)
  {
    const float mass = this->Mass[node];
    if (mass == 0.0f)
    {
      continue;
    }
    loss[node] /= mass;
    this->Push[node] = step / mass;
    if (std::any_of(drag[node].begin(), drag[node].end(), [](float d) { return d > 0.0f; }))
    {
      OpenNode open{ static_cast<std::uint32_t>(node), {} };
      for (int c = 0; c < 3; ++c)
      {
        open.Loss[c] = loss[node] + 0.5f * step * drag[node][c] / mass;
      }
      this->OpenNodes.push_back(open);
    }
    else
    {
      this->Keep[node] = (1.0f - loss[node]) / (1.0f + loss[node]);
      this->Push[node] = step / (mass * (1.0f + loss[node]));
    }
  }
}

void HexWaveSimulation::AddOpenSide(const OctreeMesh& mesh,
  const std::vector<ElasticMaterial>& materials, int side,
  std::vector<std::array<float, 3>>& drag) const
{
  const int axis = side / 2, up = side % 2;
  const OctreeMeshShape& shape = mesh.Shape();
  const std::uint32_t last = static_cast<std::uint32_t>(shape.Roots[axis]) << shape.MaxLevel;
  for (std::size_t i = 0; i < materials.size(); ++i)
  {
    const MeshOctant cell = mesh.Cell(i);
    const std::uint32_t high = cell.Corner[axis] + (1u << (shape.MaxLevel - cell.Level));
    if (up ? high != last : cell.Corner[axis] != 0)
    {
      continue;
    }
    // A plane wave that leaves pushes with density times speed times the speed of the ground.
    const double h = mesh.EdgeOfLevel(cell.Level);
    const double share = 0.25 * h * h * materials[i].Density;
    for (int corner = 0; corner < 8; ++corner)
    {
      for (int c = 0; c < 3 && (corner >> axis & 1) == up; ++c)
      {
        const float speed = c == axis ? materials[i].PressureSpeed : materials[i].ShearSpeed;
        drag[mesh.Corners(i)[corner]][c] += static_cast<float>(share * speed);
      }
    }
  }
}

void HexWaveSimulation::PlaceSources(const OctreeMesh& mesh)
{
  constexpr int component[3][3] = { { 0, 3, 4 }, { 3, 1, 5 }, { 4, 5, 2 } };
  for (std::size_t s = 0; s < this->Sources.size(); ++s)
  {
    // Forces whose work is that of the moment on the strain in the middle of the cell: elsewhere
    // the differences would be one-sided, and a shear crack would not radiate like one.
    const MomentPoint& source = this->Sources[s];
    const std::size_t cell = mesh.CellAt(source.Place);
    const double quarter = 0.25 / mesh.EdgeOfLevel(mesh.Cell(cell).Level);
    for (int node = 0; node < 8; ++node)
    {
      NodeForce force{ mesh.Corners(cell)[node], static_cast<std::uint32_t>(s), {} };
      for (int axis = 0; axis < 3; ++axis)
      {
        const double slope = node >> axis & 1 ? quarter : -quarter;
        for (int c = 0; c < 3; ++c)
        {
          force.Force[c] += static_cast<float>(source.Moment[component[c][axis]] * slope);
        }
      }
      this->NodeForces.push_back(force);
    }
  }
}

} // namespace banyan
