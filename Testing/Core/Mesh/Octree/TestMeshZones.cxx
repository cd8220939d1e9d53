// SPDX-License-Identifier: BSD-3-Clause
// Zones of meshes, from frame to frame.
#include "Mesh/Octree/TinyMeshes.h"

#include "Mesh/Octree/HexBrickSource.h"
#include "Parallel/Fields/MeshZones.h"
#include "Parallel/Frame/DistributedFrame.h"
#include "Render/Analytic.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;
using meshes::Cube;

const glm::ivec3 Size(64, 32, 32);

struct Made
{
  meshes::OwnMesh<double, std::int64_t> Mesh;
  std::vector<float> Values;
  std::shared_ptr<const HexBricks> Bricks;

  explicit Made(const std::vector<Cube>& cubes)
    : Mesh(meshes::Make(cubes, glm::dvec3(0.0), glm::dvec3(1.0), 3))
    , Values(Mesh.Sampled<float>(
        [](const glm::dvec3& p) { return scenes::Standard(p / glm::dvec3(Size)); }))
    , Bricks(std::make_shared<const HexBricks>(meshes::Find(Mesh.Mesh()), 8))
  {
  }

  HexBrickSource Source(ThreadPool& pool) const
  {
    NodeArray array;
    array.Values = this->Values.data();
    return HexBrickSource(this->Bricks, array, pool);
  }
};

std::vector<Cube> Rough()
{
  return meshes::Wild({ 2, 1, 1 }, 5, 4);
}

/// The lower half along x, without what is near to the origin: the domain begins later.
std::vector<Cube> Part()
{
  std::vector<Cube> cubes;
  for (const Cube& cube : Rough())
  {
    if (cube.Corner.x >= 16 && cube.Corner.z >= 8)
    {
      cubes.push_back(cube);
    }
  }
  return cubes;
}

std::int64_t CellsOf(const std::vector<Box>& zones)
{
  std::int64_t cells = 0;
  for (const Box& zone : zones)
  {
    cells += zone.Count();
  }
  return cells;
}

TEST(MeshZones, BeginAsWholeSubtreesOfEqualVolume)
{
  ThreadPool pool(1);
  for (const auto& cubes : { Rough(), Part() })
  {
    const Made made(cubes);
    const HexBrickSource source = made.Source(pool);
    const Box domain = made.Bricks->Tree().Domain();
    for (const int ranks : { 1, 2, 3, 4, 40 })
    {
      const FrameBalancer::Field field = MeshZones(source, domain, ranks);
      const std::vector<Box> zones = ZonesInside(field.Start.Zones(), domain);
      ASSERT_EQ(zones.size(), static_cast<std::size_t>(ranks));
      EXPECT_EQ(CellsOf(zones), domain.Count());
      for (const Box& zone : zones)
      {
        for (int axis = 0; axis < 3; ++axis)
        {
          EXPECT_TRUE(zone.Lo[axis] % 16 == 0 || zone.Empty() || zone.Lo[axis] == domain.Lo[axis]);
          EXPECT_TRUE(zone.Hi[axis] % 16 == 0 || zone.Hi[axis] == domain.Hi[axis]);
        }
      }
    }
    // 64 x 32 x 32 in halves.
    if (domain.Lo == glm::ivec3(0))
    {
      EXPECT_EQ(MeshZones(source, domain, 2).Start.Zones().front().Hi, glm::ivec3(32));
    }
  }
}

/// Draws frames with the eye near one end; returns the imbalance of the work in the first and the
/// last one.
std::pair<double, double> DrawFrames(
  const Made& made, LoadBalancing mode, int ranks, const FloatImage& expected)
{
  std::vector<double> imbalances;
  RunOnSimulatedRanks(ranks,
    [&](Communicator& communicator)
    {
      ThreadPool pool(1);
      HexBrickSource source = made.Source(pool);
      RayScene scene = scenes::Scene(Size + 1, { 90, 70 });
      scene.DomainCells = made.Bricks->Tree().Domain();
      scene.IndexToWorld = made.Bricks->Tree().LatticeToWorld();
      scene.Viewport = { { 45, 0 }, { 90, 70 } };
      FrameBalancer balancer;
      balancer.Start(
        mode, MeshZones(source, scene.DomainCells, communicator.Size()), communicator.Size());
      for (int frame = 0; frame < 8; ++frame)
      {
        balancer.BeginFrame(scene, source);
        const std::vector<Box> zones = ZonesInside(balancer.Zones(), scene.DomainCells);
        FrameStatistics statistics;
        const FloatImage picture = DrawDistributed(
          communicator, scene, { &source, zones, std::uint64_t{ 1 } << 24, pool }, statistics);
        const double mine = scene.Work ? WorkOf(scene.Work->Total()) : 0.0;
        std::vector<double> all(static_cast<std::size_t>(communicator.Size()));
        communicator.AllGather(&mine, sizeof(mine), all.data());
        if (scene.Work)
        {
          scene.Work->DrawSeconds = mine; // ranks are threads here; all are equally quick
        }
        balancer.EndFrame(communicator);
        EXPECT_EQ(balancer.BytesMoved(), 0.0);
        if (communicator.Rank() == 0)
        {
          EXPECT_LT(MaxDifference(picture, expected), 1e-5) << frame;
          imbalances.push_back(ImbalanceOf(all));
        }
      }
    });
  return { imbalances.front(), imbalances.back() };
}

TEST(MeshZones, FollowWhatFramesTakeAndChangeNoPicture)
{
  const Made made(Rough());
  ThreadPool pool(1);
  HexBrickSource source = made.Source(pool);
  RayScene scene = scenes::Scene(Size + 1, { 90, 70 });
  scene.Viewport = { { 45, 0 }, { 90, 70 } };
  const auto alone = MakeSelfCommunicator();
  FrameStatistics statistics;
  const FloatImage drawn = DrawDistributed(
    *alone, scene, { &source, { scene.DomainCells }, std::uint64_t{ 1 } << 24, pool }, statistics);
  for (const int ranks : { 2, 3 })
  {
    DrawFrames(made, LoadBalancing::Off, ranks, drawn);
    const auto measured = DrawFrames(made, LoadBalancing::MeasuredCost, ranks, drawn);
    EXPECT_GT(measured.first, 1.3) << ranks;
    // Planes stand at multiples of 8 of 64 cells.
    EXPECT_LT(measured.second, measured.first - 0.2) << ranks;
  }
}

} // namespace
