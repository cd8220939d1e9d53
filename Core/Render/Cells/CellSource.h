// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Cells_CellSource_h
#define banyan_Render_Cells_CellSource_h

#include "Render/Bricks/BrickSource.h"
#include "Render/Cells/CellField.h"

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace banyan
{

class MeshLattice;
class SeenCells;
class ThreadPool;
class VisibleValues;

/// A mesh of cells as the ray caster's source. Its bricks are cubes of the index space that say
/// which values the cells in them have; they cannot be loaded, for CellCaster draws the cells.
class CellSource final : public BrickSource
{
public:
  CellSource(CellField field, ThreadPool& pool);

  const CellField& Cells() const { return this->Field; }
  /// The same, with gradients, which are made when they are first asked for.
  const CellField& WithGradients(ThreadPool& pool);
  /// Gradients of a piece of a mesh, which others' cells have a part in. Without effect where there
  /// are some.
  void GiveGradients(std::vector<float> gradients);

  /// Which cells the camera of a scene sees, and where. Those of the last scene are kept: probes of
  /// a frame, and the frame, share them. May be called from any thread.
  /// @param visible null where all values count
  std::shared_ptr<const SeenCells> SeenIn(
    const RayScene& scene, std::shared_ptr<const VisibleValues> visible, ThreadPool& pool);
  /// The same for faces at the border, of cells with any values.
  std::shared_ptr<const SeenCells> BordersIn(const RayScene& scene, ThreadPool& pool);
  /// Bytes of what is kept of the last scene.
  std::size_t SeenBytes() const;
  /// How often cells were looked at.
  int TimesSeen() const { return this->Looks; }

  glm::ivec3 Bricks() const override { return this->Counts; }
  Box CellsOf(std::int64_t brick) const override;
  ValueRange RangeOf(std::int64_t brick) const override
  {
    return this->Ranges[static_cast<std::size_t>(brick)];
  }
  ValueMask MaskOf(std::int64_t brick) const override;
  MaskRange MasksAreOver() const override { return this->Masks; }
  std::size_t LoadBytes(std::int64_t) const override { return 0; }
  /// Throws Error when `cells` are not all of the scene's.
  std::unique_ptr<PictureCaster> MakeCaster(
    const RayScene& scene, const Box& cells, ThreadPool& pool, RayStatistics& statistics) override;
  /// Throws Error: there are no samples on a grid.
  BrickView Load(std::int64_t brick) override;

  /// The lattice of a coarser level, made when it is first asked for. Of a piece of a mesh the
  /// finest one must have been given.
  /// @param shaded with gradients
  std::shared_ptr<const MeshLattice> LatticeOf(int level, bool shaded, ThreadPool& pool);
  /// Bytes of the lattices that pictures have asked for so far, and of the border that came with
  /// them.
  std::size_t LatticeBytes() const;
  /// From place to place of the lattice of a level, in edges of the index space: the same for a
  /// mesh and a piece of it.
  double EdgeOf(int level);

  // Of a piece of a mesh: what drawing from lattices takes of the whole mesh.
  bool HasLattice(bool shaded) const;
  /// @param border the cells at the border, with values; and gradients, if the lattice has them
  /// @param finest of level 1
  void GiveLattice(std::shared_ptr<const CellField> border, std::shared_ptr<MeshLattice> finest);
  /// The cells with all faces at the border of the whole mesh.
  /// @param shaded with gradients
  const CellField& WithBorder(bool shaded, ThreadPool& pool);

protected:
  /// Levels are lattices. The finest has places half as far apart as points of the mesh, unless
  /// these would be too many.
  std::unique_ptr<BrickSource> MakeLevel(int level, const Box& domain) override;

private:
  std::shared_ptr<const SeenCells> Seen(std::shared_ptr<const SeenCells>& last,
    const RayScene& scene, std::shared_ptr<const VisibleValues> visible, ThreadPool& pool);
  bool BoundsOf(std::uint32_t number, glm::dvec3& low, glm::dvec3& high, ValueRange& range) const;
  void FindRanges(ThreadPool& pool);

  CellField Field;
  std::once_flag GradientsMade;
  glm::ivec3 Size;   ///< of the index space
  int Edge = 1;      ///< of bricks
  glm::ivec3 Counts; ///< of bricks
  std::vector<ValueRange> Ranges;
  MaskRange Masks;
  mutable std::mutex SeenMutex;
  std::shared_ptr<const SeenCells> LastSeen;
  std::shared_ptr<const SeenCells> LastBorders;
  std::once_flag EdgeFound;
  double FinestLatticeEdge = 0.0;
  mutable std::mutex LatticesMutex;
  std::map<int, std::shared_ptr<const MeshLattice>> Lattices; ///< by level
  std::shared_ptr<const CellField> Border; ///< of the whole mesh, where this is a piece
  std::atomic<int> Looks{ 0 };
};

} // namespace banyan

#endif
