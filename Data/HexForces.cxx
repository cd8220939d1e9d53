// SPDX-License-Identifier: BSD-3-Clause
#include "HexForces.h"

#include "HexElementForce-inl.h"
#include "OctreeMesh.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <algorithm>
#include <cstring>

namespace banyan
{

namespace
{

// Four numbers of one instruction: compilers for any processor know these.
typedef float Four __attribute__((vector_size(16)));

Four Load(const float* p)
{
  Four v;
  std::memcpy(&v, p, sizeof v);
  return v;
}

void Store(float* p, const Four& v)
{
  std::memcpy(p, &v, sizeof v);
}

/// Rows become columns.
void Transpose(Four& a, Four& b, Four& c, Four& d)
{
  const Four ab = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const Four cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const Four abHigh = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Four cdHigh = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  a = __builtin_shufflevector(ab, cd, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
  c = __builtin_shufflevector(abHigh, cdHigh, 0, 1, 4, 5);
  d = __builtin_shufflevector(abHigh, cdHigh, 2, 3, 6, 7);
}

} // namespace

HexForces::HexForces(const OctreeMesh& mesh, const std::vector<float>& lambda,
  const std::vector<float>& mu, ThreadPool& pool)
  : Pool(pool)
  , Scratch(pool.Width())
{
  this->FindBlockNodes(mesh);
  this->FindShared(mesh.NodeCount());
  this->FillGroups(mesh, lambda, mu);
}

void HexForces::FindBlockNodes(const OctreeMesh& mesh)
{
  const std::size_t cells = mesh.CellCount();
  std::vector<std::uint32_t> nodes;
  std::size_t groups = 0;
  for (std::size_t first = 0; first < cells; first += BlockCells)
  {
    const std::size_t count = std::min(BlockCells, cells - first);
    nodes.clear();
    for (std::size_t cell = first; cell < first + count; ++cell)
    {
      const auto& corners = mesh.Corners(cell);
      nodes.insert(nodes.end(), corners.begin(), corners.end());
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    Block block{};
    block.FirstGroup = groups;
    block.Groups = (count + Lanes - 1) / Lanes;
    block.FirstNode = this->BlockNodes.size();
    block.Nodes = static_cast<std::uint32_t>(nodes.size());
    groups += block.Groups;
    this->BlockNodes.insert(this->BlockNodes.end(), nodes.begin(), nodes.end());
    this->Blocks.push_back(block);
  }
  this->BlockNodes.shrink_to_fit();
}

void HexForces::FindShared(std::size_t nodes)
{
  std::vector<std::uint32_t> uses(nodes, 0);
  for (const std::uint32_t node : this->BlockNodes)
  {
    ++uses[node];
  }
  std::size_t shared = 0;
  for (Block& block : this->Blocks)
  {
    const auto first = this->BlockNodes.begin() + static_cast<std::ptrdiff_t>(block.FirstNode);
    const auto others = std::stable_partition(
      first, first + block.Nodes, [&](std::uint32_t node) { return uses[node] == 1; });
    block.Own = static_cast<std::uint32_t>(others - first);
    block.FirstShared = shared;
    shared += block.Nodes - block.Own;
  }
  if (shared > UINT32_MAX)
  {
    throw Error("The mesh has too many nodes between its blocks: more than 2^32 - 1.");
  }
  this->SharedForces.resize(3 * shared);
  this->SharedPlaces.resize(shared);
  this->SharedStart.push_back(0);
  // From here on the place among the shared nodes.
  for (std::size_t node = 0; node < nodes; ++node)
  {
    if (uses[node] > 1)
    {
      this->SharedStart.push_back(this->SharedStart.back() + uses[node]);
      this->SharedNodes.push_back(static_cast<std::uint32_t>(node));
      uses[node] = static_cast<std::uint32_t>(this->SharedNodes.size() - 1);
    }
  }
  std::vector<std::size_t> next(this->SharedStart.begin(), this->SharedStart.end() - 1);
  for (const Block& block : this->Blocks)
  {
    for (std::uint32_t i = block.Own; i < block.Nodes; ++i)
    {
      const std::uint32_t node = uses[this->BlockNodes[block.FirstNode + i]];
      this->SharedPlaces[next[node]++] =
        static_cast<std::uint32_t>(block.FirstShared + i - block.Own);
    }
  }
}

void HexForces::FillGroups(
  const OctreeMesh& mesh, const std::vector<float>& lambda, const std::vector<float>& mu)
{
  const std::size_t cells = mesh.CellCount();
  this->Groups.resize(this->Blocks.back().FirstGroup + this->Blocks.back().Groups);
  this->Pool.ParallelFor(static_cast<std::int64_t>(this->Blocks.size()),
    [&](std::int64_t which)
    {
      const Block& block = this->Blocks[which];
      const auto first = this->BlockNodes.begin() + static_cast<std::ptrdiff_t>(block.FirstNode);
      const auto place = [&](std::uint32_t node)
      {
        // Both parts are sorted.
        auto found = std::lower_bound(first, first + block.Own, node);
        if (found == first + block.Own || *found != node)
        {
          found = std::lower_bound(first + block.Own, first + block.Nodes, node);
        }
        return static_cast<std::uint16_t>(found - first);
      };
      for (std::size_t i = 0; i < block.Groups * Lanes; ++i)
      {
        Group& group = this->Groups[block.FirstGroup + i / Lanes];
        const std::size_t cell = which * BlockCells + i, lane = i % Lanes;
        const bool exists = cell < std::min(cells, (which + 1) * BlockCells);
        const float scale =
          exists ? static_cast<float>(-mesh.EdgeOfLevel(mesh.Cell(cell).Level) / 16.0) : 0.0f;
        group.Lambda[lane] = exists ? scale * lambda[cell] : 0.0f;
        group.Mu[lane] = exists ? scale * mu[cell] : 0.0f;
        for (int corner = 0; corner < 8; ++corner)
        {
          group.Corners[corner][lane] = exists ? place(mesh.Corners(cell)[corner]) : 0;
        }
      }
    });
}

void HexForces::Apply(const float* displacement, float* force)
{
  this->Pool.ParallelFor(static_cast<std::int64_t>(this->Blocks.size()),
    [&](std::int64_t block, int worker)
    { this->ApplyBlock(this->Blocks[block], displacement, force, worker); });

  constexpr std::int64_t Batch = 4096;
  const auto count = static_cast<std::int64_t>(this->SharedNodes.size());
  this->Pool.ParallelFor((count + Batch - 1) / Batch,
    [&](std::int64_t batch)
    {
      for (std::int64_t i = batch * Batch; i < std::min(count, (batch + 1) * Batch); ++i)
      {
        float sum[3] = {};
        for (std::size_t k = this->SharedStart[i]; k < this->SharedStart[i + 1]; ++k)
        {
          const float* part = &this->SharedForces[3 * std::size_t(this->SharedPlaces[k])];
          for (int c = 0; c < 3; ++c)
          {
            sum[c] += part[c];
          }
        }
        std::memcpy(force + 3 * std::size_t(this->SharedNodes[i]), sum, sizeof sum);
      }
    });
}

void HexForces::ApplyBlock(const Block& block, const float* displacement, float* force, int worker)
{
  // Nodes take four numbers here, so that they are read and written at once.
  std::vector<float>& scratch = this->Scratch[worker];
  scratch.assign(8 * std::size_t(block.Nodes), 0.0f);
  float* u = scratch.data();
  float* f = u + 4 * std::size_t(block.Nodes);
  const std::uint32_t* nodes = &this->BlockNodes[block.FirstNode];
  for (std::uint32_t i = 0; i < block.Nodes; ++i)
  {
    std::memcpy(u + 4 * i, displacement + 3 * std::size_t(nodes[i]), 3 * sizeof(float));
  }
  for (std::size_t g = block.FirstGroup; g < block.FirstGroup + block.Groups; ++g)
  {
    const Group& group = this->Groups[g];
    Four a[3][8];
    for (int corner = 0; corner < 8; ++corner)
    {
      const auto& at = group.Corners[corner];
      Four none = Load(u + 4 * at[3]);
      a[0][corner] = Load(u + 4 * at[0]);
      a[1][corner] = Load(u + 4 * at[1]);
      a[2][corner] = Load(u + 4 * at[2]);
      Transpose(a[0][corner], a[1][corner], a[2][corner], none);
    }
    HexElementForce(a, Load(group.Lambda.data()), Load(group.Mu.data()));
    for (int corner = 0; corner < 8; ++corner)
    {
      const auto& at = group.Corners[corner];
      Four row[4] = { a[0][corner], a[1][corner], a[2][corner], Four{} };
      Transpose(row[0], row[1], row[2], row[3]);
      for (int lane = 0; lane < 4; ++lane)
      {
        // One after the other: cells of a group share corners.
        Store(f + 4 * at[lane], Load(f + 4 * at[lane]) + row[lane]);
      }
    }
  }
  for (std::uint32_t i = 0; i < block.Own; ++i)
  {
    std::memcpy(force + 3 * std::size_t(nodes[i]), f + 4 * i, 3 * sizeof(float));
  }
  for (std::uint32_t i = block.Own; i < block.Nodes; ++i)
  {
    std::memcpy(
      &this->SharedForces[3 * (block.FirstShared + i - block.Own)], f + 4 * i, 3 * sizeof(float));
  }
}

} // namespace banyan
