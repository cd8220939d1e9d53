#include "HexOctree/NodalField.h"

#include "Base/ThreadPool.h"
#include "HexOctree/TakenComponent.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{

bool FitsFloat(ScalarType type)
{
  return SizeOf(type) <= 2 || type == ScalarType::Float32;
}

NodalField::NodalField(
  std::shared_ptr<const ElementOctree> tree, const NodeArray& array, ThreadPool& pool)
  : Octree(std::move(tree))
{
  RequireComponent(array);
  if (FitsFloat(array.Type))
  {
    this->Take(array, this->Floats, pool);
    this->Constrain(this->Floats);
  }
  else
  {
    this->Take(array, this->Doubles, pool);
    this->Constrain(this->Doubles);
  }
}

NodalField::NodalField(std::shared_ptr<const ElementOctree> coarser, const NodalField& finer,
  const std::vector<std::uint32_t>& nodeOfPoint)
  : Octree(std::move(coarser))
{
  const auto take = [&](const auto& from, auto& to)
  {
    to.reserve(nodeOfPoint.size());
    for (const std::uint32_t node : nodeOfPoint)
    {
      to.push_back(from[node]);
    }
    this->Constrain(to);
  };
  finer.Floats.empty() ? take(finer.Doubles, this->Doubles) : take(finer.Floats, this->Floats);
}

template <class Out>
void NodalField::Take(const NodeArray& array, std::vector<Out>& values, ThreadPool& pool)
{
  const std::int64_t count = this->Octree->Mesh().PointCount;
  values.resize(static_cast<std::size_t>(count));
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
}

template <class Out>
void NodalField::Constrain(std::vector<Out>& values)
{
  for (const TwinNode& twin : this->Octree->Twins())
  {
    values[static_cast<std::size_t>(twin.Node)] = values[static_cast<std::size_t>(twin.First)];
  }
  for (const HangingNode& hanging : this->Octree->Hanging())
  {
    double corners[8];
    this->CornersOf(hanging.Leaf, corners);
    values[static_cast<std::size_t>(hanging.Node)] =
      static_cast<Out>(Interpolate(corners, glm::dvec3(hanging.Part)));
  }
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
