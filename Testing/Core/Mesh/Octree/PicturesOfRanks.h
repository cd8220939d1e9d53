// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_HexOctree_PicturesOfRanks_h
#define banyan_Testing_Core_HexOctree_PicturesOfRanks_h

#include "Base/ThreadPool.h"
#include "Mesh/Octree/HexBrickSource.h"
#include "Parallel/Balance/Zones.h"
#include "Parallel/Communicate/Communicator.h"
#include "Parallel/Frame/DistributedFrame.h"

namespace meshes
{

/// The picture that several ranks draw of a mesh, each a zone of it.
/// @param made has Source(ThreadPool&)
/// @param parts what zones are made of: planes stand at multiples of 5 finest cells, anywhere, also
/// inside of large elements
template <class Made>
banyan::FloatImage DrawOnRanks(
  const Made& made, const banyan::RayScene& scene, const glm::ivec3& parts, int ranks)
{
  banyan::FloatImage image;
  banyan::RunOnSimulatedRanks(ranks,
    [&](banyan::Communicator& communicator)
    {
      banyan::ThreadPool pool(1);
      banyan::HexBrickSource source = made.Source(pool);
      std::vector<banyan::Box> zones;
      for (const banyan::Box& part : banyan::StaticZones(parts, communicator.Size()))
      {
        zones.push_back(banyan::CellsOfBricks(part, 5, scene.DomainCells.Hi));
      }
      banyan::FrameStatistics statistics;
      const banyan::FloatImage picture = banyan::DrawDistributed(
        communicator, scene, { &source, zones, std::uint64_t{ 1 } << 24, pool }, statistics);
      if (communicator.Rank() == 0)
      {
        image = picture;
      }
    });
  return image;
}

} // namespace meshes

#endif
