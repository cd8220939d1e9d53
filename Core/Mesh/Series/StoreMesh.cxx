// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Mesh/Series/MeshPlaces.h"

#include <cstring>
#include <map>

namespace banyan
{
namespace
{

constexpr std::uint8_t Hexahedron = 12;

void CopyGrid(const HexMesh& cells, const std::uint8_t* cellTypes, StoredMesh& mesh)
{
  const auto count = static_cast<std::size_t>(cells.CellCount);
  mesh.PointType = cells.PointType;
  mesh.Points.resize(static_cast<std::size_t>(cells.PointCount) * 3 * SizeOf(cells.PointType));
  std::memcpy(mesh.Points.data(), cells.Points, mesh.Points.size());
  DispatchMesh(
    cells, [&](const auto*, const auto* ids) { mesh.Connectivity.assign(ids, ids + 8 * count); });
  mesh.CellTypes.assign(count, Hexahedron);
  if (cellTypes != nullptr)
  {
    mesh.CellTypes.assign(cellTypes, cellTypes + count);
  }
}

/// Leaves, which cells they are, and in what order those have their corners.
void CopyLeaves(const ElementOctree& tree, StoredMesh& mesh)
{
  const auto count = static_cast<std::size_t>(tree.LeafCount());
  mesh.Leaves.Keys.resize(count);
  mesh.Leaves.Levels.resize(count);
  mesh.CellOfLeaf.resize(count);
  mesh.OrderOfLeaf.resize(count);
  std::map<CornerOrder, std::uint16_t> orders;
  for (std::size_t leaf = 0; leaf < count; ++leaf)
  {
    const auto number = static_cast<std::int64_t>(leaf);
    mesh.Leaves.Keys[leaf] = tree.KeyOfLeaf(number);
    mesh.Leaves.Levels[leaf] = static_cast<std::uint8_t>(tree.LevelOfLeaf(number));
    const std::int64_t cell = tree.CellOfLeaf(number);
    mesh.CellOfLeaf[leaf] = static_cast<std::uint32_t>(cell);
    std::int64_t nodes[8];
    tree.NodesOfLeaf(number, nodes);
    CornerOrder order{};
    for (std::size_t corner = 0; corner < 8; ++corner)
    {
      std::uint8_t at = 0;
      while (at < 7 && mesh.Connectivity[8 * static_cast<std::size_t>(cell) + at] != nodes[corner])
      {
        ++at;
      }
      order[corner] = at;
    }
    const auto found = orders.emplace(order, static_cast<std::uint16_t>(orders.size()));
    if (found.second)
    {
      mesh.Orders.push_back(order);
    }
    mesh.OrderOfLeaf[leaf] = found.first->second;
  }
}

/// Numbers the points, and counts those that coincide with another one or belong to no cell.
std::int64_t NumberNodes(const MeshPlaces& places, std::int64_t samples, StoredMesh& mesh)
{
  const auto points = static_cast<std::size_t>(mesh.PointCount());
  std::vector<std::uint32_t> placeOfPoint(points, MeshAtlas::NoSample);
  std::vector<char> taken(static_cast<std::size_t>(samples));
  std::int64_t listed = 0;
  mesh.PointOfNode.clear();
  mesh.PointOfNode.reserve(points);
  for (std::size_t leaf = 0; leaf < mesh.Leaves.Keys.size(); ++leaf)
  {
    for (std::size_t corner = 0; corner < 8; ++corner)
    {
      const std::int64_t point = mesh.PointAt(leaf, corner);
      std::uint32_t& known = placeOfPoint[static_cast<std::size_t>(point)];
      const std::uint32_t place = places.PlaceOf(leaf, corner);
      if (known == MeshAtlas::NoSample)
      {
        known = place;
        mesh.PointOfNode.push_back(static_cast<std::uint32_t>(point));
        listed += taken[place];
        taken[place] = 1;
      }
      else if (known != place)
      {
        throw Error("Point " + std::to_string(point) + " is a corner of cells at two places");
      }
    }
  }
  return listed + mesh.PointCount() - static_cast<std::int64_t>(mesh.PointOfNode.size());
}

} // namespace

std::shared_ptr<const StoredMesh> StoreMesh(
  const ElementOctree& tree, const std::uint8_t* cellTypes)
{
  const HexMesh& cells = tree.Mesh();
  if (cells.PointCount > MeshAtlas::MostSamples)
  {
    throw Error("The mesh has too many points for one series");
  }
  auto mesh = std::make_shared<StoredMesh>();
  CopyGrid(cells, cellTypes, *mesh);
  CopyLeaves(tree, *mesh);
  mesh->Origin = tree.Origin();
  mesh->Edge = tree.Edge();
  const MeshAtlas boxes = MeshAtlas::Pack(mesh->Leaves);
  const MeshPlaces places(mesh->Leaves, boxes);
  mesh->Atlas = boxes.WithList(NumberNodes(places, boxes.SampleCount(), *mesh));
  LayOut(places, *mesh);
  return mesh;
}

} // namespace banyan
