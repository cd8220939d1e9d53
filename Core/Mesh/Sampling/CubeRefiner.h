// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Sampling_CubeRefiner_h
#define banyan_Mesh_Sampling_CubeRefiner_h

#include "Base/Interruption.h"
#include "Base/Morton.h"
#include "Mesh/Sampling/PlaceInCell.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace banyan
{

class ThreadPool;

/// How closely a mesh of general hexahedra is sampled.
struct MeshSampling
{
  /// Largest CubeDeviation: a part of the spread of the values around. 0 where general hexahedra
  /// are not to be sampled at all.
  double Tolerance = 1.0 / 4;
  /// A soft limit: when there are more, cubes stay as they are, and say so.
  std::int64_t MostCubes = std::int64_t{ 1 } << 20;

  /// Called now and then, by the thread that asked for the cubes, with the part of the work that is
  /// done: from 0 to 1, never less than before, and an estimate, as nobody knows how many cubes a
  /// mesh will take. When it returns false the work ends with Interruption. May be empty; what it
  /// is does not count when samplings are compared.
  std::function<bool(double)> Watch = {};

  /// Cubes are never smaller than this part of the thinnest cell that they touch, as a power of
  /// two.
  static constexpr int FinestPart = 3;
  /// At the border of the mesh they are not larger than this part of it.
  static constexpr int BorderPart = 2;

  bool operator==(const MeshSampling& other) const
  {
    return this->Tolerance == other.Tolerance && this->MostCubes == other.MostCubes;
  }
};

/// Cubes of an octree whose corners a mesh is sampled at.
struct SampledCubes
{
  struct Cube
  {
    MortonKey Key = 0; ///< of its first corner, on the lattice of the shapes
    int Level = 0;
    std::uint32_t First = 0; ///< of its cells, in Cells
    std::uint32_t Count = 0;
  };
  std::vector<Cube> Cubes;
  std::vector<std::uint32_t> Cells; ///< those whose boxes touch each cube, in ascending order
  double Deviation = 0.0;           ///< the largest one of all cubes
  std::int64_t Above = 0;           ///< cubes with more than the tolerance
  std::int64_t Denied = 0; ///< those of them, and at the border, that MostCubes kept coarse
};

/// Halves cubes from one around the whole mesh on: as long as they are larger than the thinnest
/// cell that they touch, and then as long as their deviation is above the tolerance, or the border
/// of the mesh goes through them. Cubes with their middle in the mesh stay. The result is the same
/// for any number of threads. Throws Interruption when Watch says so, and Error when as many cubes
/// as the thinnest cells ask for would be more than eight times MostCubes.
SampledCubes RefineCubes(const CellShapes& shapes, const MeshSampling& sampling, ThreadPool& pool);

} // namespace banyan

#endif
