// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Cells_MeshLattice_h
#define banyan_Render_Cells_MeshLattice_h

#include "Render/Cells/LatticeSampler.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace banyan
{

class ThreadPool;

/// A mesh's field on a regular lattice: a coarser level of the mesh. Where the mesh ends its border
/// faces say, as for cells, so that ends are as exact. Samples need not look for a cell.
class MeshLattice
{
public:
  /// What the lowest bits of a value say of the lattice's cell whose low corner it is.
  static constexpr std::uint32_t AtBorder = 0; ///< a face of the border may go through
  static constexpr std::uint32_t Inside = 1;   ///< all of it is in the mesh
  static constexpr std::uint32_t Outside = 2;
  static constexpr std::uint32_t CellBits = 3;
  /// Whether the place itself is in the mesh.
  static constexpr std::uint32_t PlaceBit = 4;

  /// @param edge from place to place, in edges of the index space: a power of two
  /// @param finer one of the same field, whose values are taken; null for none. Of the field its
  /// border counts alone then
  MeshLattice(const CellField& field, double edge, const MeshLattice* finer, ThreadPool& pool);
  /// @param cells at the border of the mesh, others or not
  /// @param values of the places, as SampleField gives them
  MeshLattice(const DrawnCells& cells, double edge, std::vector<float> values, ThreadPool& pool);
  /// The places that it would have: the same for a mesh, a piece of it, and its border.
  static PlacesInRows PlacesFor(const DrawnCells& cells, double edge);

  /// Adds gradients.
  /// @param field with gradients
  /// @param finer one with gradients; null for none
  void AddGradients(const CellField& field, const MeshLattice* finer, ThreadPool& pool);
  /// Adds them for one axis.
  /// @param slopes of the places, as SampleField gives them for SlopeOf
  void AddSlopes(std::size_t axis, std::vector<float> slopes, ThreadPool& pool);
  /// A field's gradient along an axis as a field.
  /// @param field with gradients
  static CellField SlopeOf(const CellField& field, std::size_t axis);

  const PlacesInRows& Places() const { return this->At; }
  /// Floats with bits as above. Outside of the mesh NaN, but for corners of cells at the border,
  /// where values go on.
  const float* Values() const { return this->Numbers.data(); }
  const float* Gradients(int axis) const { return this->Slopes[axis].data(); }
  bool HasGradients() const { return !this->Slopes[0].empty(); }
  std::size_t Bytes() const;

private:
  void Finish(const DrawnCells& cells, ThreadPool& pool);
  void TakeFrom(const MeshLattice& finer, const std::vector<float>& from,
    std::vector<float>& values, ThreadPool& pool) const;
  void FindBorderCells(const DrawnCells& cells, std::vector<std::uint8_t>& border) const;
  std::vector<std::size_t> PlacesWithout(const std::vector<std::uint8_t>& border) const;
  float ValueBeside(const std::vector<float>& values, const glm::ivec3& at) const;
  void Widen(std::vector<float>& values, ThreadPool& pool) const;

  PlacesInRows At;
  std::vector<float> Numbers;
  std::vector<float> Slopes[3];
  std::vector<std::size_t> Without; ///< places at the border that are outside of the mesh
};

} // namespace banyan

#endif
