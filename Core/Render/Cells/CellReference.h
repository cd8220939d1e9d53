// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Cells_CellReference_h
#define banyan_Render_Cells_CellReference_h

#include "Cells/CellMesh.h"
#include "Render/Scene/FloatImage.h"
#include "Render/Scene/RayScene.h"

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

namespace banyan
{

/// One sample of a ray through a mesh of cells.
struct ReferenceSample
{
  std::int64_t Cell = -1; ///< the owner, or -1
  /// Where there is no owner, the mean of those at the crossings; NaN where there are none either.
  double Value = std::numeric_limits<double>::quiet_NaN();
  double Length = 0.0;  ///< of its interval, in sample distances
  double Covered = 0.0; ///< how much of it is in the mesh, in sample distances
};

/// What a picture of a mesh of cells is, in double precision: one ray after the other, every sample
/// through all cells, no tables, no early end. What faster code is held to.
///
/// Samples are those of RayLattice, at their fixed-point positions. One belongs to the last cell in
/// the order that holds it, within 2^-13 of places from -1 to 1 (see FindPlace), and 2^-20 beyond
/// border faces where there are ends; there, four triangles around the mean of its corners end a
/// cell in place of a quad. Cells are not drawn which the transfer function does not show, by the
/// range of their corners' values, or which have a value that is not finite: as if they were not
/// there.
///
/// With ends, a sample stands for that part of its interval that the mesh covers. Border faces,
/// which one cell alone has, are crossed by the ray: triangles as they are, quads as four triangles
/// around the mean of their corners. An interval [a, b) covers
///
///     inside * (b - a) + sum over crossings t of sign * ((b - t) - (t < middle ? b - a : 0))
///
/// cut to [0, b - a]; the sign is 1 where the ray enters the cell, -1 where it leaves. Where no
/// cell has the sample, the value is the mean of those at the crossings. Cells that are not drawn
/// have no crossings, but their neighbours have no border there.
class CellReference
{
public:
  /// Refers to the scene and the mesh, which must stay.
  /// @param order numbers of cells; of those that hold a sample the last one has it
  /// @param physicalToIndex takes points of the mesh to the index space of the scene; affine
  /// @param valueOfPoint by its number
  /// @param ends see above; otherwise samples with an owner stand for their whole intervals
  /// @param nearMiddle in sample distances: the nearest crossing, if it is as near to a sample,
  ///   counts as before or behind it as its owner says, where by its place the ray would be in the
  ///   mesh twice, or less than not at all, at an end of the interval. A cell holds samples
  ///   somewhat outside of itself, too: for these the formula alone would count an interval as
  ///   covered that is half covered. 0 is the formula alone
  CellReference(const RayScene& scene, const CellMesh& mesh,
    const std::vector<std::uint32_t>& order, const glm::dmat4& physicalToIndex,
    const std::function<double(std::int64_t)>& valueOfPoint, bool ends, double nearMiddle = 0.0);
  ~CellReference();
  CellReference(const CellReference&) = delete;
  CellReference& operator=(const CellReference&) = delete;

  /// The samples of a ray: the head where there is one, all whole ones, the tail where there is
  /// one.
  /// @param x, y pixel of the whole picture, inside the scene's viewport
  std::vector<ReferenceSample> SamplesOf(int x, int y) const;

  /// The whole viewport, composited.
  /// @param function colour, and opacity per UnitDistance of the scene's transfer function
  FloatImage Draw(const std::function<glm::dvec4(double)>& function) const;

private:
  class Parts;
  const RayScene& Scene;
  std::unique_ptr<const Parts> Inside;
};

/// CellReference::Draw.
FloatImage CellReferenceImage(const RayScene& scene, const CellMesh& mesh,
  const std::vector<std::uint32_t>& order, const glm::dmat4& physicalToIndex,
  const std::function<double(std::int64_t)>& valueOfPoint,
  const std::function<glm::dvec4(double)>& function, bool ends, double nearMiddle = 0.0);

/// CellReference::SamplesOf of all pixels of the viewport, `[y][x]`.
std::vector<std::vector<ReferenceSample>> CellReferenceSamples(const RayScene& scene,
  const CellMesh& mesh, const std::vector<std::uint32_t>& order, const glm::dmat4& physicalToIndex,
  const std::function<double(std::int64_t)>& valueOfPoint, bool ends, double nearMiddle = 0.0);

} // namespace banyan

#endif
