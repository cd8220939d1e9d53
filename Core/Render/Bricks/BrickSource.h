// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_BrickSource_h
#define banyan_Render_Bricks_BrickSource_h

#include "Base/Box.h"
#include "Base/Hash.h"
#include "Render/Bricks/BrickView.h"
#include "Render/Bricks/HiddenCells.h"
#include "Render/Bricks/PackedBrickCache.h"
#include "Render/Scene/Viewpoint.h"
#include "Series/Format/SeriesIndex.h"
#include "Series/Grid/ValueMask.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace banyan
{

class PictureCaster;
class SummaryTree;
class ThreadPool;
struct RayScene;
struct RayStatistics;

/// One finite value, and the type that samples have.
struct UniformValue
{
  double Value = 0.0;
  ScalarType Type = ScalarType::Float64;
};

/// What the ray caster draws: a box of cells cut into bricks. Positions are samples of the whole
/// grid (index space, starting at 0); cell c lies between samples c and c + 1.
///
/// Bricks of one source may have cells of different sizes, as those of octree meshes do: brick b
/// counts in cells of its own, which are 2^BrickLevel(b) cells of the source long. They are drawn
/// in one picture, exactly.
class BrickSource
{
public:
  virtual ~BrickSource() = default;

  /// Bricks are numbered x fastest over `Bricks()`; brick b owns the cells `CellsOf(b)`, its own.
  virtual glm::ivec3 Bricks() const = 0;
  /// @param counts Bricks()
  static std::int64_t NumberOf(const glm::ivec3& position, const glm::ivec3& counts)
  {
    return position.x + counts.x * (position.y + std::int64_t{ counts.y } * position.z);
  }
  virtual Box CellsOf(std::int64_t brick) const = 0;

  /// How many times a brick's cells are twice as long as the source's: 0 unless a source has cells
  /// of several sizes.
  virtual int BrickLevel(std::int64_t) const { return 0; }
  /// The largest that there is, at most MostBrickLevels.
  virtual int CoarsestBrickLevel() const { return 0; }
  static constexpr int MostBrickLevels = 16;

  /// Whether bricks are cut by whole planes, so that a brick's place along an axis says which cells
  /// it has along it.
  virtual bool IsGrid() const { return true; }
  /// Ranges and masks of boxes of bricks, made when they are first asked for. Null unless IsGrid.
  /// May be called from any thread.
  const SummaryTree* Summaries() const;

  /// The place of each brick in visibility order; empty where IsGrid.
  /// @param view in index space
  virtual std::vector<std::int64_t> RanksFrontToBack(const Viewpoint&) const { return {}; }

  /// Of the finite values anywhere in the brick; empty when there is none.
  virtual ValueRange RangeOf(std::int64_t brick) const = 0;
  virtual ValueMask MaskOf(std::int64_t brick) const = 0;
  virtual MaskRange MasksAreOver() const = 0;
  /// Of a brick (a macro voxel) whose samples are all known to have one finite value; asked without
  /// loading it. Empty when they have not, or when it is not known.
  virtual std::optional<UniformValue> UniformValueOf(std::int64_t brick) const;

  /// A hash of all samples of a brick, as Load gives them: bricks of one place with equal ones are
  /// the same, in any source of the same grid. Nothing where it is not known without loading.
  virtual std::optional<Hash128> ContentOf(std::int64_t) const { return std::nullopt; }

  /// Finds out what bricks hold, where that takes a look at their samples: ContentOf knows it from
  /// then on. Without effect where it is known anyway, and where nobody can. One thread at a time.
  virtual void LookAt(const std::vector<std::int64_t>& /*bricks*/) {}

  /// Whether samples are colours (ColourNumber). Ranges and masks are those of what the opacity
  /// function is asked for.
  virtual bool HasColours() const { return false; }

  /// Of values that are whole multiples of a step, each rounded to float32, but for exceptions: the
  /// step. 0 where none is known.
  virtual double StepOfValues() const { return 0.0; }

  /// Memory that one loaded brick takes (0 when the values are in memory anyway).
  virtual std::size_t LoadBytes(std::int64_t brick) const = 0;

  /// What draws this level of a picture in place of bricks; null where bricks are drawn. Everything
  /// referred to must stay.
  /// @param cells samples elsewhere are left out
  /// @param statistics is added to
  virtual std::unique_ptr<PictureCaster> MakeCaster(
    const RayScene& scene, const Box& cells, ThreadPool& pool, RayStatistics& statistics);

  /// Called from many threads. Throws Error when the brick cannot be read.
  virtual BrickView Load(std::int64_t brick) = 0;

  /// The same with one more layer of samples on each side, where the source has them. Unless a
  /// source knows better, it is put together from the bricks around.
  /// @param samples set to those that the view has; the view starts at samples.Lo
  virtual BrickView LoadAround(std::int64_t brick, Box& samples);

  /// Bricks side by side as one view. Unless a source knows better, it is put together from them.
  /// @param bricks positions among Bricks()
  /// @param around with one more layer of samples, as LoadAround
  /// @param samples set to those that the view has; the view starts at samples.Lo
  virtual BrickView LoadTogether(const Box& bricks, bool around, Box& samples);

  /// 0 is the finest.
  int Level() const { return this->LevelNumber; }

  /// How long a cell is along each axis, in cells of the finest level: one of LevelEdges.
  /// Positions, and boxes of cells, are counted in such cells. 2^Level unless a source knows
  /// better.
  virtual glm::ivec3 CellEdges() const { return glm::ivec3(1 << this->LevelNumber); }

  /// The same field at a coarser level, in bricks of as many cells: a sample for each of its cells;
  /// where the last cell is not whole, one more sample repeats the last fine one (see BrickLayout).
  /// It stays with this source.
  /// @param level >= 0; 0 is this source, which must be of the finest level
  /// @param domain all fine cells of the whole grid
  /// @return null where there is none: pieces of a plain grid have no coarser levels
  /// May be called from any thread.
  BrickSource* AtLevel(int level, const Box& domain);

  /// Says which cells are not drawn, at this level and, as far as they are not told by themselves,
  /// at coarser ones that are asked for from now on. Before anything is drawn.
  /// @param hidden of the whole grid, at this source's level; null for none
  void Hide(std::shared_ptr<const HiddenCells> hidden);
  /// Null where nothing is hidden.
  const std::shared_ptr<const HiddenCells>& Hidden() const { return this->HiddenHere; }
  /// Whether no cell of a brick is drawn.
  bool AllHidden(std::int64_t brick) const
  {
    return this->HiddenHere && this->HiddenHere->All(this->CellsOf(brick));
  }
  /// Whether a brick is of one value all over, without hidden cells: it is not loaded where nothing
  /// is shaded.
  bool IsMacroVoxel(std::int64_t brick) const
  {
    return this->UniformValueOf(brick) &&
           !(this->HiddenHere && this->HiddenHere->Any(this->CellsOf(brick)));
  }

  /// What the ray caster keeps of this source and its levels from picture to picture. Values must
  /// not change while the source lives.
  PackedBrickCache& Kept() const { return *this->KeptOfSource; }
  /// Whose budget for drawing that shares: the process's, unless something else is said here,
  /// before anything is drawn.
  void ShareBudgetOf(const std::shared_ptr<CacheContext>& caches)
  {
    this->KeptOfSource = std::make_shared<PackedBrickCache>(caches);
  }
  /// Takes over what is kept of a source of the same grid, of another step, say: of bricks that
  /// this one has the same samples of. Before anything is hidden or drawn. Looks at bricks that the
  /// other one was asked about.
  /// @param other of the finest level, as this one; nothing is kept of it any more. Its values may
  /// be gone
  /// @param domain see AtLevel
  void TakeKept(BrickSource& other, const Box& domain);
  /// The number under which a brick of this level is kept.
  std::int64_t KeptNumber(std::int64_t brick) const
  {
    return brick + (static_cast<std::int64_t>(this->LevelNumber) << LevelShift);
  }

protected:
  /// A source of a coarser level; may refer to this one. Null where there is none.
  virtual std::unique_ptr<BrickSource> MakeLevel(int level, const Box& domain);

private:
  static constexpr int LevelShift = 48;

  std::shared_ptr<const HiddenCells> HiddenHere;
  std::shared_ptr<PackedBrickCache> KeptOfSource = std::make_shared<PackedBrickCache>();
  int LevelNumber = 0;
  std::map<int, std::unique_ptr<BrickSource>> Levels; ///< that were asked for
  std::mutex LevelsMutex;
  mutable std::shared_ptr<const SummaryTree> SummariesHere;
  mutable std::once_flag SummariesMade;
};

/// Cells of a level that begin in cells of the finest one: of disjoint boxes they are disjoint.
/// @param edges of cells of the level
Box CellsAtLevel(const Box& cells, const glm::ivec3& edges);

} // namespace banyan

#endif
