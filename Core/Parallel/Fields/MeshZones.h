// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_MeshZones_h
#define banyan_Parallel_Fields_MeshZones_h

#include "Parallel/Balance/FrameBalancer.h"
#include "Render/Bricks/BrickSource.h"

namespace banyan
{

/// Says what zones of a mesh begin with, and how they are moved. Planes stand between cubes of its
/// octree, so that a zone is made of whole subtrees, where elements fill equal volumes on both
/// sides; for the samples that rays take go with the volume, whatever elements it is cut into. All
/// ranks have all of a mesh, so nothing is moved but the planes.
/// @param source the mesh's bricks, all of them
/// @param domain in cells of the source
FrameBalancer::Field MeshZones(const BrickSource& source, const Box& domain, int ranks);

/// Returns the parts of the balancer's zones, which begin at 0, that lie in the domain; empty boxes
/// where nothing does.
std::vector<Box> ZonesInside(std::vector<Box> zones, const Box& domain);

} // namespace banyan

#endif
