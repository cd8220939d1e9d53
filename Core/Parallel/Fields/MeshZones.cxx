// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/MeshZones.h"

namespace banyan
{
namespace
{

/// Edges of the cubes of the octree that planes stand between, in finest cells: powers of two.
constexpr int FirstCubeEdge = 16;
constexpr int CubeLevel = 3; ///< when they move

} // namespace

FrameBalancer::Field MeshZones(const BrickSource& source, const Box& domain, int ranks)
{
  FrameBalancer::Field field;
  field.Cells = domain.Hi;
  field.BrickCells = FirstCubeEdge;
  field.CoarsestLevel = CubeLevel;
  field.BytesPerCell = 0.0;
  BrickCosts filled(field.Cells, BlockEdgeFor(field.Cells));
  const std::int64_t count = Box{ glm::ivec3(0), source.Bricks() }.Count();
  for (std::int64_t brick = 0; brick < count; ++brick)
  {
    const Box own = source.CellsOf(brick);
    const int size = 1 << source.BrickLevel(brick);
    const Box cells{ own.Lo * size, own.Hi * size };
    filled.Add(cells, static_cast<double>(cells.Count()));
  }
  const glm::ivec3 cubes = (field.Cells + FirstCubeEdge - 1) / FirstCubeEdge;
  field.Start.Tree =
    RebalanceMeasuredCost(Refined(EqualZoneTree(cubes, ranks), FirstCubeEdge, field.Cells), filled,
      std::vector<double>(static_cast<std::size_t>(ranks), 1.0), 0.0, FirstCubeEdge);
  return field;
}

std::vector<Box> ZonesInside(std::vector<Box> zones, const Box& domain)
{
  for (Box& zone : zones)
  {
    zone = Intersection(zone, domain);
    zone = zone.Empty() ? Box{} : zone;
  }
  return zones;
}

} // namespace banyan
