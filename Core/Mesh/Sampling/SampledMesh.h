// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Sampling_SampledMesh_h
#define banyan_Mesh_Sampling_SampledMesh_h

#include "Mesh/Octree/HexMesh.h"
#include "Mesh/Octree/NodalField.h"
#include "Mesh/Sampling/CubeRefiner.h"

#include <glm/vec3.hpp>

#include <memory>
#include <string>
#include <vector>

namespace banyan
{

class ThreadPool;

/// A mesh of general hexahedra (curved, warped, with topography) as one of axis-aligned boxes that
/// are the leaves of an octree: what ElementOctree and the ray caster draw. Values at its points
/// are those of the mesh's own trilinear field there; found once per mesh, so that new values touch
/// values only.
///
/// How exact: see CubeDeviation for the field, between the points of boxes. The border of the mesh
/// becomes one of boxes of at most a quarter of the thinnest cell there: boxes with their middle in
/// the mesh are drawn. Where cells overlap the first one counts.
/// @par Source: nothing of the paper on earthquakes, whose meshes are octrees
class SampledMesh
{
public:
  /// Throws Error: see CellShapes and RefineCubes (and Interruption, which is one); and when no box
  /// is left.
  static std::shared_ptr<SampledMesh> Of(
    const HexMesh& mesh, const MeshSampling& sampling, ThreadPool& pool);

  /// Its points are float64. Copies keep the arrays alive.
  const HexMesh& Boxes() const { return this->BoxMesh; }
  /// Lets the arrays of Boxes() go: sampling values does not need them.
  void DropBoxes();

  /// Facts about the sampling, for statistics.
  double Deviation() const { return this->LargestDeviation; }
  std::int64_t AboveTolerance() const { return this->BoxesAbove; }
  /// Boxes that are larger than they should be, for there would be more than MostCubes.
  std::int64_t KeptCoarse() const { return this->Coarse; }
  std::int64_t TangledCells() const { return this->Tangled; }
  std::int64_t FirstTangledCell() const { return this->FirstTangled; }

  /// Bytes that it takes, without those of Boxes().
  std::size_t Bytes() const
  {
    return this->Places.size() * sizeof(Place) +
           this->NodesOfCells.size() * sizeof(this->NodesOfCells[0]);
  }

  /// Values at the points of the boxes: one component, or the length of all (taken at the nodes of
  /// the mesh, as NodalField does).
  /// @param array at the points of the mesh
  /// @return float32, or float64 for types that float32 cannot hold
  struct Values
  {
    std::vector<float> Floats;
    std::vector<double> Doubles;
    /// With one component; refers to these vectors.
    NodeArray Array() const;
  };
  Values Sample(const NodeArray& array, ThreadPool& pool) const;

private:
  struct Place
  {
    std::uint32_t Nodes = 0; ///< which eight of NodesOfCells
    glm::vec3 Part{ 0.0f };
  };

  SampledMesh() = default;
  void MakeBoxes(const CellShapes& shapes, const SampledCubes& cubes, ThreadPool& pool);
  void PlacePoints(const CellShapes& shapes, const SampledCubes& cubes,
    const std::vector<std::uint32_t>& cubeOfPoint, ThreadPool& pool);
  template <class In, class Out>
  void SampleInto(
    const In* values, const NodeArray& array, std::vector<Out>& out, ThreadPool& pool) const;

  HexMesh BoxMesh;
  std::shared_ptr<std::vector<glm::dvec3>> Points;
  std::vector<Place> Places;                             ///< of points
  std::vector<std::array<std::int64_t, 8>> NodesOfCells; ///< in the order of TrilinearCell
  double LargestDeviation = 0.0;
  std::int64_t BoxesAbove = 0;
  std::int64_t Coarse = 0;
  std::int64_t Tangled = 0;
  std::int64_t FirstTangled = -1;
};

} // namespace banyan

#endif
