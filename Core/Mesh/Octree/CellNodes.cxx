// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Octree/CellNodes.h"

#include "Base/ThreadPool.h"
#include "Mesh/Octree/TakenComponent.h"

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

constexpr std::int64_t Run = 1 << 14; ///< leaves or points that a thread takes at once

std::size_t Index(std::int64_t i)
{
  return static_cast<std::size_t>(i);
}

template <class Function>
void InRuns(std::int64_t count, ThreadPool& pool, const Function& function)
{
  pool.ParallelFor((count + Run - 1) / Run,
    [&](std::int64_t part)
    {
      for (std::int64_t i = part * Run; i < std::min(count, (part + 1) * Run); ++i)
      {
        function(i);
      }
    });
}

std::vector<double> Scalars(const NodeArray& array, std::int64_t count, ThreadPool& pool)
{
  std::vector<double> values(Index(count));
  Dispatch(array.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const T* const from = static_cast<const T*>(array.Values);
      InRuns(count, pool,
        [&](std::int64_t i)
        { values[Index(i)] = TakenComponent(from + i * array.Components, array); });
    });
  return values;
}

/// The point that counts at the place of each; empty where all points have places of their own.
std::vector<std::int64_t> FirstAtPlace(const ElementOctree& tree)
{
  std::vector<std::int64_t> first;
  if (!tree.Twins().empty())
  {
    first.resize(Index(tree.Mesh().PointCount));
    for (std::size_t i = 0; i < first.size(); ++i)
    {
      first[i] = static_cast<std::int64_t>(i);
    }
    for (const TwinNode& twin : tree.Twins())
    {
      first[Index(twin.Node)] = twin.First;
    }
  }
  return first;
}

struct Sum
{
  double Weighted = 0.0;
  double Weight = 0.0;
};

} // namespace

CellNodes::CellNodes(
  const ElementOctree& tree, const NodeArray& values, ValuesOn where, ThreadPool& pool)
{
  RequireComponent(values);
  const bool onCells = where == ValuesOn::Cells;
  const std::int64_t points = tree.Mesh().PointCount;
  const std::vector<double> given = Scalars(values, onCells ? tree.Mesh().CellCount : points, pool);
  const std::vector<std::int64_t> first = FirstAtPlace(tree);
  std::vector<Sum> sums(Index(points));
  // At most one cell has a place as its corner of this number: no two threads add to one sum, and
  // the order of additions is always the same.
  for (int corner = 0; corner < 8; ++corner)
  {
    InRuns(tree.LeafCount(), pool,
      [&](std::int64_t leaf)
      {
        std::int64_t nodes[8];
        tree.NodesOfLeaf(leaf, nodes);
        const std::int64_t node = nodes[corner];
        const double value = given[Index(onCells ? tree.CellOfLeaf(leaf) : node)];
        Sum& sum = sums[Index(first.empty() ? node : first[Index(node)])];
        const double weight = std::ldexp(1.0, -tree.LevelOfLeaf(leaf));
        sum.Weighted += weight * value;
        sum.Weight += weight;
      });
  }
  const auto store = [&](auto& nodes)
  {
    nodes.resize(Index(points));
    InRuns(points, pool,
      [&](std::int64_t node)
      {
        const Sum& sum = sums[Index(node)];
        using Out = typename std::decay_t<decltype(nodes)>::value_type;
        nodes[Index(node)] =
          sum.Weight > 0.0 ? static_cast<Out>(sum.Weighted / sum.Weight) : Out{ 0 };
      });
  };
  if (FitsFloat(values.Type))
  {
    store(this->Floats);
  }
  else
  {
    store(this->Doubles);
  }
}

NodeArray CellNodes::Nodes() const
{
  NodeArray nodes;
  if (this->Floats.empty())
  {
    nodes.Values = this->Doubles.data();
    nodes.Type = ScalarType::Float64;
  }
  else
  {
    nodes.Values = this->Floats.data();
    nodes.Type = ScalarType::Float32;
  }
  return nodes;
}

} // namespace banyan
