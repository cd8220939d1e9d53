// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Octree/NodalField.h"

#include "Base/ThreadPool.h"
#include "Mesh/Octree/TakenComponent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace banyan
{

bool FitsFloat(ScalarType type)
{
  return SizeOf(type) <= 2 || type == ScalarType::Float32;
}

namespace
{

/// Points that hang on larger cells come first: see ElementOctree::Hanging.
template <class Out>
void Constrain(const ElementOctree& tree, Out* values)
{
  for (const TwinNode& twin : tree.Twins())
  {
    values[twin.Node] = values[twin.First];
  }
  for (const HangingNode& hanging : tree.Hanging())
  {
    std::int64_t nodes[8];
    double corners[8];
    tree.NodesOfLeaf(hanging.Leaf, nodes);
    for (int corner = 0; corner < 8; ++corner)
    {
      corners[corner] = double{ values[nodes[corner]] };
    }
    values[hanging.Node] =
      static_cast<Out>(NodalField::Interpolate(corners, glm::dvec3(hanging.Part)));
  }
}

} // namespace

NodalField::NodalField(
  std::shared_ptr<const ElementOctree> tree, const NodeArray& array, ThreadPool& pool)
  : Octree(std::move(tree))
{
  RequireComponent(array);
  if (FitsFloat(array.Type))
  {
    this->Floats = this->Taken<float>(array, pool);
  }
  else
  {
    this->Doubles = this->Taken<double>(array, pool);
  }
}

NodalField::NodalField(std::shared_ptr<const ElementOctree> tree, const NodeArray& values,
  const std::shared_ptr<const void>& owner)
  : Octree(std::move(tree))
{
  RequireComponent(values);
  const auto count = static_cast<std::size_t>(this->Octree->Mesh().PointCount);
  if (values.Type == ScalarType::Float32)
  {
    this->Floats = { static_cast<const float*>(values.Values), count, owner };
  }
  else
  {
    this->Doubles = { static_cast<const double*>(values.Values), count, owner };
  }
}

void NodalField::MakeContinuous(const ElementOctree& tree, void* values, ScalarType type)
{
  type == ScalarType::Float32 ? Constrain(tree, static_cast<float*>(values))
                              : Constrain(tree, static_cast<double*>(values));
}

NodalField::NodalField(std::shared_ptr<const ElementOctree> coarser, const NodalField& finer,
  const HeldArray<std::uint32_t>& nodeOfPoint)
  : Octree(std::move(coarser))
{
  const auto take = [&](const auto& from, auto& to)
  {
    std::vector<std::decay_t<decltype(from[0])>> values;
    values.reserve(nodeOfPoint.size());
    for (const std::uint32_t node : nodeOfPoint)
    {
      values.push_back(from[node]);
    }
    Constrain(*this->Octree, values.data());
    to = std::move(values);
  };
  finer.Floats.empty() ? take(finer.Doubles, this->Doubles) : take(finer.Floats, this->Floats);
}

template <class Out>
std::vector<Out> NodalField::Taken(const NodeArray& array, ThreadPool& pool) const
{
  const std::int64_t count = this->Octree->Mesh().PointCount;
  std::vector<Out> values(static_cast<std::size_t>(count));
  Dispatch(array.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const T* const from = static_cast<const T*>(array.Values);
      constexpr std::int64_t run = 1 << 16;
      pool.ParallelFor((count + run - 1) / run,
        [&](std::int64_t part)
        {
          const std::int64_t end = std::min(count, (part + 1) * run);
          for (std::int64_t node = part * run; node < end; ++node)
          {
            values[static_cast<std::size_t>(node)] =
              static_cast<Out>(TakenComponent(from + node * array.Components, array));
          }
        });
    });
  Constrain(*this->Octree, values.data());
  return values;
}

void NodalField::CornersOf(std::int64_t leaf, double (&values)[8]) const
{
  std::int64_t nodes[8];
  this->Octree->NodesOfLeaf(leaf, nodes);
  for (int corner = 0; corner < 8; ++corner)
  {
    values[corner] = this->AtNode(nodes[corner]);
  }
}

double NodalField::Interpolate(const double (&corners)[8], const glm::dvec3& part)
{
  // Weights of 0 and 1 give corners as they are; a corner without weight must not spoil it with
  // NaN.
  double edges[4];
  for (int i = 0; i < 4; ++i)
  {
    const double a = corners[2 * i];
    const double b = corners[2 * i + 1];
    edges[i] = part.x == 0.0 ? a : part.x == 1.0 ? b : a + part.x * (b - a);
  }
  double rows[2];
  for (int i = 0; i < 2; ++i)
  {
    const double a = edges[2 * i];
    const double b = edges[2 * i + 1];
    rows[i] = part.y == 0.0 ? a : part.y == 1.0 ? b : a + part.y * (b - a);
  }
  return part.z == 0.0 ? rows[0] : part.z == 1.0 ? rows[1] : rows[0] + part.z * (rows[1] - rows[0]);
}

double NodalField::AtPoint(const glm::ivec3& point) const
{
  for (int octant = 0; octant < 8; ++octant)
  {
    const std::int64_t leaf =
      this->Octree->LeafAt(point - glm::ivec3(octant & 1, octant >> 1 & 1, octant >> 2));
    if (leaf >= 0)
    {
      double corners[8];
      this->CornersOf(leaf, corners);
      const glm::dvec3 in(point - this->Octree->CornerOfLeaf(leaf));
      return Interpolate(corners, in / double(1 << this->Octree->LevelOfLeaf(leaf)));
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

} // namespace banyan
