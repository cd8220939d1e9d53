// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Cells/CellTile.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Render/Cells/CellKernels.cxx"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include <hwy/cache_control.h>

#include "Render/Cells/CellPackets-inl.h"
#include "Render/Cells/FacePackets-inl.h"
#include "Render/Cells/LatticeRows-inl.h"
#include "Render/Cells/RunBlender-inl.h"
#include "Render/Cells/SlabBlender-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// What a cell has in its corners.
struct CellCorners
{
  glm::dvec3 At[8]; ///< in index space
  float Values[8] = {};
  float Gradients[3][8] = {}; ///< where they are wanted
};

/// Sets the places of a patch: its centre, and its corners against the clock.
/// @param order of the face's corners, set to those of the cell
void PlacePatch(const CellSetup& setup, const CellFace& face, const CellCorners& corners,
  BorderPatch& patch, int (&order)[4])
{
  glm::dvec3 middle;
  for (int axis = 0; axis < 3; ++axis)
  {
    patch.Middle[axis] = setup.Middle[axis];
    middle[axis] = setup.Middle[axis] / (1 << FractionBits);
  }
  const int count = CornersOf(setup.Shape);
  glm::dvec3 inner(0.0);
  for (int i = 0; i < count; ++i)
  {
    inner += (corners.At[i] - middle) / static_cast<double>(count);
  }
  glm::dvec3 around[4];
  glm::dvec3 centre(0.0);
  for (int i = 0; i < face.Count; ++i)
  {
    around[i] = corners.At[face.Corners[static_cast<std::size_t>(i)]] - middle;
    centre += around[i] / static_cast<double>(face.Count);
  }
  const glm::dvec3 normal = face.Count == 4
                              ? glm::cross(around[2] - around[0], around[3] - around[1])
                              : glm::cross(around[1] - around[0], around[2] - around[0]);
  const bool turned = glm::dot(normal, centre - inner) < 0.0;
  for (int i = 0; i < face.Count; ++i)
  {
    const int from = turned ? face.Count - 1 - i : i;
    order[i] = face.Corners[static_cast<std::size_t>(from)];
    for (int axis = 0; axis < 3; ++axis)
    {
      patch.Corners[i][axis] = static_cast<float>(around[from][axis]);
    }
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    patch.Centre[axis] = static_cast<float>(centre[axis]);
  }
}

/// A face of a cell at the border.
BorderPatch PatchOf(const CellSetup& setup, int number, const CellCorners& corners, bool shaded)
{
  BorderPatch patch;
  const CellFace& face = FacesOf(setup.Shape).Faces[static_cast<std::size_t>(number)];
  patch.Count = face.Count;
  int order[4] = {};
  PlacePatch(setup, face, corners, patch, order);
  const auto part = 1.0f / static_cast<float>(face.Count);
  for (int i = 0; i < face.Count; ++i)
  {
    patch.Values[i] = corners.Values[order[i]];
    patch.CentreValue += patch.Values[i] * part;
    for (int axis = 0; axis < 3 && shaded; ++axis)
    {
      patch.Gradients[i][axis] = corners.Gradients[axis][order[i]];
      patch.CentreGradient[axis] += patch.Gradients[i][axis] * part;
    }
  }
  return patch;
}

/// Packets of the tile that a placed cell may touch.
PixelRect PacketsOf(const SlabJob& job, const PlacedCell& placed)
{
  const PixelRect here = placed.PixelsIn(job.PictureSize, job.Rays.Rect);
  return here.Empty() ? here : job.Rays.PacketsUnder(here);
}

/// The cells of a slab. Caches are asked for the numbers of their points first, and then for the
/// points, while those before are drawn.
class CellsAhead
{
public:
  explicit CellsAhead(const SlabJob& job)
    : Job(job)
    , Mesh(job.Field.Cells->Mesh)
  {
    for (std::size_t i = 0; i < Points; ++i)
    {
      this->AskForPoints(i);
    }
  }

  /// @param i one after the other from 0 on
  const MeshCell& Take(std::size_t i)
  {
    if (i + Items < this->Job.Count)
    {
      hwy::Prefetch(this->Job.Placed + this->Job.Items[i + Items]);
    }
    if (i + Places < this->Job.Count)
    {
      this->Mesh.PrefetchPlace(this->NumberOf(i + Places));
    }
    if (i + Numbers < this->Job.Count)
    {
      this->Mesh.PrefetchCell(this->NumberOf(i + Numbers));
    }
    this->Current = this->Cells[i % Points];
    this->AskForPoints(i + Points);
    return this->Current;
  }

private:
  static constexpr std::size_t Points = 8;
  static constexpr std::size_t Numbers = 20;
  static constexpr std::size_t Places = 34;
  static constexpr std::size_t Items = 48;

  std::int64_t NumberOf(std::size_t i) const
  {
    return this->Job.Field.Cells->Order[this->Job.Placed[this->Job.Items[i]].Place];
  }

  void AskForPoints(std::size_t i)
  {
    if (i >= this->Job.Count)
    {
      return;
    }
    MeshCell& cell = this->Cells[i % Points];
    cell = this->Mesh.Cell(this->NumberOf(i));
    for (int corner = 0; corner < CornersOf(cell.Shape); ++corner)
    {
      const std::int64_t point = cell.Points[static_cast<std::size_t>(corner)];
      this->Mesh.PrefetchPoint(point);
      if (!this->Job.Field.OfCells)
      {
        hwy::Prefetch(this->Job.Field.Values.data() + point);
      }
    }
  }

  const SlabJob& Job;
  const CellMesh& Mesh;
  MeshCell Current;
  MeshCell Cells[Points];
};

/// @return false when nothing of the cell can be drawn
bool TakeCell(const SlabJob& job, const PlacedCell& placed, const MeshCell& cell,
  CellCorners& corners, CellSetup& setup)
{
  const DrawnCells& cells = *job.Field.Cells;
  const int count = CornersOf(cell.Shape);
  for (int i = 0; i < count; ++i)
  {
    corners.At[i] = cells.ToIndex(cells.Mesh.Point(cell.Points[static_cast<std::size_t>(i)]));
  }
  if (!setup.Set(cell.Shape, corners.At, placed.Border))
  {
    return false;
  }
  job.Field.CornerValues(cells.Order[placed.Place], cell, corners.Values);
  setup.Value.Set(cell.Shape, corners.Values);
  for (int axis = 0; axis < 3 && job.Shading; ++axis)
  {
    for (int i = 0; i < count; ++i)
    {
      const auto point = static_cast<std::size_t>(cell.Points[static_cast<std::size_t>(i)]);
      corners.Gradients[axis][i] = job.Field.Gradients[3 * point + static_cast<std::size_t>(axis)];
    }
    setup.Gradient[axis].Set(cell.Shape, corners.Gradients[axis]);
  }
  return true;
}

void DrawSlabHere(const SlabJob& job)
{
  CellPackets packets(job);
  FacePackets faces(job);
  CellSetup setup;
  CellCorners corners;
  CellsAhead ahead(job);
  for (std::size_t i = 0; i < job.Count; ++i)
  {
    const PlacedCell& placed = job.Placed[job.Items[i]];
    const MeshCell& cell = ahead.Take(i);
    const PixelRect under = PacketsOf(job, placed);
    if (under.Empty() || !TakeCell(job, placed, cell, corners, setup))
    {
      continue;
    }
    const auto rowOf = [&](double t)
    { return std::floor(t * job.PerDistance) - job.Rows.FirstNumber; };
    if (placed.Face == PlacedCell::Whole)
    {
      if (job.Owners)
      {
        packets.Own(placed.Place, job.Field.Cells->Alone[placed.Place]);
      }
      packets.Draw(setup, under, rowOf(placed.Near), rowOf(placed.Far));
    }
    else
    {
      // It may be no row of the tile, but is the same for all: what is rounded depends on it.
      const double row = rowOf(0.5 * (double{ placed.Near } + double{ placed.Far }));
      faces.Draw(PatchOf(setup, placed.Face, corners, job.Shading != nullptr), under, row);
    }
  }
}

void DrawLatticeSlabHere(const SlabJob& job, const LatticeJob& lattice)
{
  DrawSlabHere(job);
  LatticeRows(job, lattice).Fill();
}

void BlendSlabHere(
  SampleSlab& slab, const TileRows& rows, int firstRow, const SlabBlend& blend, RayTile& rays)
{
  if (!blend.Projection)
  {
    SlabBlender<Composited>(slab, rows, firstRow, blend, rays).Blend();
  }
  else if (blend.Projection->Averages())
  {
    SlabBlender<Projected<Sums>>(slab, rows, firstRow, blend, rays).Blend();
  }
  else
  {
    SlabBlender<Projected<Ranks>>(slab, rows, firstRow, blend, rays).Blend();
  }
}

void BlendSlabInRunsHere(SampleSlab& slab, const TileRows& rows, int firstRow,
  const SlabBlend& blend, RayTile& rays, const SlabOwners& owners, RunCollector& collector)
{
  if (!blend.Projection)
  {
    RunBlender<Composited>(slab, rows, firstRow, blend, rays, owners, collector).Blend();
  }
  else if (blend.Projection->Averages())
  {
    RunBlender<Projected<Sums>>(slab, rows, firstRow, blend, rays, owners, collector).Blend();
  }
  else
  {
    RunBlender<Projected<Ranks>>(slab, rows, firstRow, blend, rays, owners, collector).Blend();
  }
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace banyan
{

HWY_EXPORT(DrawSlabHere);
HWY_EXPORT(DrawLatticeSlabHere);
HWY_EXPORT(BlendSlabHere);
HWY_EXPORT(BlendSlabInRunsHere);

void DrawSlab(const SlabJob& job)
{
  HWY_DYNAMIC_DISPATCH(DrawSlabHere)(job);
}

void DrawLatticeSlab(const SlabJob& job, const LatticeJob& lattice)
{
  HWY_DYNAMIC_DISPATCH(DrawLatticeSlabHere)(job, lattice);
}

void BlendSlab(
  SampleSlab& slab, const TileRows& rows, int firstRow, const SlabBlend& blend, RayTile& rays)
{
  HWY_DYNAMIC_DISPATCH(BlendSlabHere)(slab, rows, firstRow, blend, rays);
}

void BlendSlabInRuns(SampleSlab& slab, const TileRows& rows, int firstRow, const SlabBlend& blend,
  RayTile& rays, const SlabOwners& owners, RunCollector& collector)
{
  HWY_DYNAMIC_DISPATCH(BlendSlabInRunsHere)
  (slab, rows, firstRow, blend, rays, owners, collector);
}

} // namespace banyan
#endif
