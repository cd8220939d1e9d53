// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_BenchMesh_h
#define banyan_Benchmarks_BenchMesh_h

#include "Mesh/Octree/HexMesh.h"

#include <cstdint>
#include <string>
#include <vector>

namespace banyan
{
class ThreadPool;
}

namespace banyan::bench
{

/// A mesh of hexahedra in memory with a value at each point. Lengths are edges of the smallest
/// cell, and the first corner is the origin.
struct BenchMesh
{
  std::vector<float> Points;     ///< x, y, z of each
  std::vector<std::int64_t> Ids; ///< `[cell][8]`, in the order of `Voxels`
  std::vector<float> Values;     ///< one per point
  bool Voxels = false;           ///< corners as VTK_VOXEL has them; otherwise as VTK_HEXAHEDRON

  std::size_t Cells() const { return this->Ids.size() / 8; }
  std::size_t PointCount() const { return this->Points.size() / 3; }
  /// Refers to this mesh.
  HexMesh Input() const;
};

/// The standard field on n^3 cells of one size.
BenchMesh UniformMesh(int n, ThreadPool& pool);

/// The standard field on an octree that is fine where the field is steep.
/// @param n finest cells across, a power of two
BenchMesh GradedMesh(int n, ThreadPool& pool);

/// The magnitude of the ground's velocity in an earthquake (Data/NorthridgeModel.h).
/// @param cells about so many
/// @param seconds after the fault began to break
BenchMesh EarthquakeMeshAt(double cells, double seconds, ThreadPool& pool);

/// The standard field on the mesh of an earthquake, over its longest side: the cells alone, which
/// no simulation has to be waited for.
/// @param cells about so many
BenchMesh GroundMesh(double cells, ThreadPool& pool);

/// The magnitude of the array "velocity" in the first block of a file of Exodus, as
/// `banyan-generate --series earthquake` writes it. Throws Error when the mesh is no octree, or
/// the program was built without VTK.
/// @param seconds the step with the nearest time counts
BenchMesh ExodusMeshAt(const std::string& file, double seconds, ThreadPool& pool);

/// Puts the cells into another order.
void Shuffle(BenchMesh& mesh);

} // namespace banyan::bench

#endif
