// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Cells_DrawnMesh_h
#define banyan_Testing_Core_Cells_DrawnMesh_h

#include "Cells/CellMeshes.h"
#include "Render/Cells/CellField.h"
#include "Render/Cells/CellReference.h"
#include "Render/Levels/RayCaster.h"
#include "Render/Scenes.h"

#include <memory>
#include <vector>

namespace cellmeshes
{

/// Smooth in colour and opacity: opaque enough that hiding counts.
glm::dvec4 Dense(double value);

/// How a mesh is shown. The sample distance and the unit of opacity are in edges of the lattice.
struct ShownAs
{
  glm::ivec2 Picture{ 48, 48 };
  bool Ends = true;
  bool Parallel = false;
  double Distance = 1.4; ///< of the eye, in diagonals
  double Step = 0.8;
  glm::dmat4 Actor{ 1.0 }; ///< takes points of the mesh to the world
  double Zoom = 1.0;       ///< of the picture, around its middle
  double Edge = 0.0;       ///< of the lattice; 0 chooses it
  bool OfCells = false;    ///< the mesh's values are those of cells
};

/// A mesh with all that a picture of it takes, drawn with Dense. Scene and Field may be changed.
struct DrawnMesh
{
  explicit DrawnMesh(OwnedCellMesh mesh, const ShownAs& as = {});

  /// The picture, finished.
  /// @param statistics is added to; null for none
  banyan::FloatImage Draw(int threads = 1, banyan::RayStatistics* statistics = nullptr) const;
  /// The slow reference for it.
  banyan::FloatImage Reference(const scenes::Function& function = Dense) const;
  /// The samples of all rays.
  std::vector<std::vector<banyan::ReferenceSample>> Samples() const;

  /// Replaces the lattice's cells by others, such as another order.
  void SetCells(const banyan::DrawnCells& cells);
  /// @param eye, centre in world space
  void LookFrom(const glm::dvec3& eye, const glm::dvec3& centre, const glm::dmat4& projection);
  glm::dvec3 Centre() const; ///< of the domain, in world space
  double Diagonal() const;   ///< of the domain, in world space
  /// Takes points of the mesh to index space.
  glm::dmat4 ToIndex() const;
  std::function<double(std::int64_t)> ValueOfPoint() const;

  std::shared_ptr<const OwnedCellMesh> Mesh;
  banyan::CellField Field;
  banyan::RayScene Scene;
  bool Ends = true;
};

/// How far pictures are apart, in all four numbers of a pixel.
struct Apart
{
  double Decibels = 0.0; ///< to the peak of 1
  double Worst = 0.0;    ///< of 255
};
Apart Between(const banyan::FloatImage& a, const banyan::FloatImage& b);

/// All cells in the order of a Morton key, whatever the order of cells and points in memory.
std::vector<std::uint32_t> GeometricOrder(const banyan::CellMesh& mesh);

/// A low opacity for all values, so that sums of lengths can be read from a picture: see LengthIn.
banyan::TransferFunction Tiny(const banyan::RayScene& scene);
/// The length that a pixel has met, in sample distances.
double LengthIn(const banyan::RayScene& scene, const glm::vec4& pixel);

} // namespace cellmeshes

#endif
