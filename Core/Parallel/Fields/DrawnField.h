// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_DrawnField_h
#define banyan_Parallel_Fields_DrawnField_h

#include "Base/Hash.h"
#include "Parallel/Communicate/Communicator.h"
#include "Parallel/Fields/MeshBytes.h"
#include "Render/Bricks/BrickSource.h"
#include "Render/Sampling/SamplingPlan.h"
#include "Render/Scene/RayScene.h"
#include "Series/Grid/Grid.h"
#include "Series/Quantize/ValueRange.h"

#include <glm/mat4x4.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace banyan
{

class CellSource;

/// Where a field lies.
struct FieldPlace
{
  Box Cells; ///< empty: nowhere
  glm::dmat4 IndexToPhysical{ 1.0 };
  /// (xmin, xmax, ymin, ymax, zmin, zmax) in physical space.
  std::array<double, 6> Bounds{ { 1, -1, 1, -1, 1, -1 } };
  double CellSize = 1.0; ///< length of the shortest edge of a cell in physical space
};

/// Where the cells between some samples of a grid lie; the first of them gets index 0.
/// @param samples extent indices, half-open
FieldPlace PlaceOfSamples(const Grid& grid, const Box& samples);

/// One field of scalars as all ranks draw it together: bricks, and one zone of cells per rank. Its
/// kinds differ in where values are: in an encoded series that every rank can read (SeriesField),
/// on one rank (WholeField), in pieces on the ranks (PiecesField), on a mesh that every rank has
/// (MeshField), or on one that lies in pieces (CellsField). Each kind has a collective Take of its
/// own, which brings it the values of a step.
///
/// @par Order of calls in a frame, the same on all ranks:
///   1. BeginFrame    collective
///   2. BringLevels   collective; only where the frame may be drawn from coarser levels
///   3. ReadAhead     of one rank, when it has cast its rays
///   4. EndFrame      collective
class DrawnField
{
public:
  /// The coarsest level of a grid that pictures are drawn from: the first with at most 128 cells
  /// along each axis, and at least 3. The next finer one takes 64 MiB of floats at most, and errors
  /// are told from these two: whatever the size of the grid, there are levels that memory can hold.
  /// @param cells of the finest level
  static int CoarsestLevelOf(const glm::ivec3& cells);

  /// Bricks of other ranks, for the frame that was begun last.
  struct Movement
  {
    double Bytes = 0.0;             ///< from rank to rank, over all ranks
    std::uint64_t Hits = 0;         ///< bricks that were still here, over all ranks
    std::uint64_t Misses = 0;       ///< bricks that were not, over all ranks
    std::uint64_t BytesFetched = 0; ///< held by this rank
  };

  virtual ~DrawnField() = default;

  /// Collective: moves the zones, brings what they take, and lets the scene tell what drawing
  /// takes. Throws CollectiveError when one fails.
  virtual void BeginFrame(Communicator&, RayScene&) {}
  /// Collective, for frames that may be drawn from levels up to `coarsest`: makes those that are
  /// not there yet. Throws CollectiveError when one fails.
  virtual void BringLevels(Communicator&, const RayScene&, int /*coarsest*/) {}
  /// Begins to decode what the next frame is expected to need of the cells that this rank has drawn
  /// under the scene's viewport. Does not throw.
  virtual void ReadAhead(const RayScene&, const Box& /*cells*/) {}
  /// Collective.
  virtual void EndFrame(Communicator&) {}

  /// Drops the bricks. What another step of the same data can use stays.
  virtual void Clear() = 0;

  /// All bricks, as this rank has them; owned by the field. Null when there is nothing to draw.
  virtual BrickSource* Source() = 0;
  /// The caches of the series; those of the process where there is none.
  const std::shared_ptr<CacheContext>& Caches();
  /// Which step of a series of how many it is; between two steps it is no whole number.
  struct Place
  {
    double Step = 0.0;
    int Steps = 1;
    Hash128 Field; ///< of all that names the field but the step: series, array, enhancement
  };
  virtual Place InSeries() const { return {}; }
  /// All bricks of another step of the series, as this rank has them. Null where there are none.
  /// May throw Error, on one rank alone.
  virtual std::unique_ptr<BrickSource> SourceOfStep(int) { return nullptr; }
  /// One per rank; all but the first are empty where ranks have no zones.
  virtual const std::vector<Box>& Zones() const = 0;
  /// Of the values that this rank knows.
  virtual ValueRange RangeHere();

  /// The same as banyan::VisibleContent of all bricks, on all ranks. May throw Error, on one rank
  /// alone.
  virtual std::vector<Hash128> VisibleContent(const RayScene&) { return {}; }

  virtual Movement Moved() const { return {}; }
  /// Whether bricks come from an encoded series.
  virtual bool IsEncoded() const { return false; }
  /// This rank's piece of a mesh whose cells are dealt in any way: ranks have no zones then. Null
  /// where they have; the same on all ranks.
  virtual CellSource* PieceOfCells() const { return nullptr; }
  /// Whether each rank can draw any cell: the same on all ranks.
  virtual bool IsOnEachRank() const { return false; }
  /// Whether it is a mesh of hexahedra.
  virtual bool IsMesh() const { return false; }
  /// How long cells of its levels are.
  /// @param cells of the finest level
  LevelEdges Levels(const glm::ivec3& cells) const
  {
    return this->IsMesh()      ? LevelEdges::Finest()
           : this->IsEncoded() ? LevelEdges()
                               : LevelEdges::Following(cells);
  }
  /// Of a level that plans may use: SamplingWish::LeastCells.
  virtual int LeastCells() const { return SamplingWish().LeastCells; }
  /// Bytes read so far from a series by this process.
  virtual std::uint64_t BytesRead() const { return 0; }
  /// What a user should know of a mesh; empty if nothing. The same on all ranks.
  virtual std::string Note() const { return {}; }
  /// What this rank holds of a mesh: its octree, the cells that were gathered for it, and values.
  virtual MeshBytes Bytes() const { return {}; }
};

} // namespace banyan

#endif
