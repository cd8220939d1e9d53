// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Sampling_OneNumberPerPlace_h
#define banyan_Mesh_Sampling_OneNumberPerPlace_h

#include "Mesh/Octree/HexMesh.h"

namespace banyan
{

class ThreadPool;

/// The same mesh, with cells that share the points that they have in common: of points with the
/// same coordinates the lowest number counts, and its value. Pieces of several ranks, and cells
/// with points of their own, are one mesh then, and their field has no jumps where it had none.
///
/// Handed back as it is where no points coincide; otherwise with a copy of the cells (int32 where
/// that holds all numbers). Takes 24 bytes per point meanwhile.
/// Throws Error when a cell refers to a point that is not there.
HexMesh OneNumberPerPlace(const HexMesh& mesh, ThreadPool& pool);

} // namespace banyan

#endif
