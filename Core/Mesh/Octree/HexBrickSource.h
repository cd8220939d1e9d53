// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Octree_HexBrickSource_h
#define banyan_Mesh_Octree_HexBrickSource_h

#include "Mesh/Octree/HexBrickSummary.h"
#include "Mesh/Octree/HexBricks.h"
#include "Mesh/Octree/NodalField.h"
#include "Render/Bricks/BrickSource.h"

#include <atomic>
#include <memory>
#include <vector>

namespace banyan
{

class ThreadPool;

/// Bricks of a hexahedral mesh that never was encoded, each on the lattice of its own smallest
/// element: sampling loses nothing, since a trilinear interpolant between samples is that of the
/// element. Bricks meet without a crack, since the field is continuous (see NodalField).
///
/// Index space is the lattice of the mesh's octree: DomainCells are its Domain(), and IndexToWorld
/// its LatticeToWorld().
class HexBrickSource : public BrickSource
{
public:
  /// New values of the same mesh need a new source on the same bricks, and nothing else.
  HexBrickSource(
    std::shared_ptr<const HexBricks> bricks, const NodeArray& values, ThreadPool& pool);

  /// The same of values that are a field already, and of a summary of them in its bricks.
  HexBrickSource(
    std::shared_ptr<const HexBricks> bricks, NodalField values, HexBrickSummary summary);

  glm::ivec3 Bricks() const override;
  Box CellsOf(std::int64_t brick) const override { return this->Brick(brick).Cells; }
  int BrickLevel(std::int64_t brick) const override { return this->Brick(brick).Level; }
  int CoarsestBrickLevel() const override { return this->Cut->CoarsestLevel(); }
  bool IsGrid() const override { return false; }
  std::vector<std::int64_t> RanksFrontToBack(const Viewpoint& view) const override
  {
    return this->Cut->RanksFrontToBack(view);
  }
  ValueRange RangeOf(std::int64_t brick) const override
  {
    return this->Summary.Ranges[Index(brick)];
  }
  ValueMask MaskOf(std::int64_t brick) const override { return this->Summary.Masks[Index(brick)]; }
  MaskRange MasksAreOver() const override { return this->Summary.Over; }
  /// Of the elements of the brick, too.
  std::optional<Hash128> ContentOf(std::int64_t brick) const override
  {
    return this->Summary.Contents[Index(brick)];
  }
  std::optional<UniformValue> UniformValueOf(std::int64_t brick) const override;
  std::size_t LoadBytes(std::int64_t brick) const override;
  BrickView Load(std::int64_t brick) override;
  BrickView LoadAround(std::int64_t brick, Box& samples) override;

  /// Positions are those of the finest elements at all levels: zones cut elements where they like.
  glm::ivec3 CellEdges() const override { return glm::ivec3(1); }

  const NodalField& Field() const { return this->Values; }
  /// Bytes of the values of coarser meshes that pictures have asked for so far.
  std::size_t LevelBytes() const { return this->BytesOfLevels; }

protected:
  /// Returns the bricks of a coarser mesh (HexBricks::AtLevel). The level uses the pool of the
  /// process, because the pool of this source may be gone.
  std::unique_ptr<BrickSource> MakeLevel(int level, const Box& domain) override;

private:
  HexBrickSource(std::shared_ptr<const HexBricks> bricks, NodalField values, ThreadPool& pool);

  static std::size_t Index(std::int64_t i) { return static_cast<std::size_t>(i); }
  const HexBrick& Brick(std::int64_t i) const { return this->Cut->List()[Index(i)]; }

  template <class Out>
  void FillLeaf(const HexBrick& brick, std::int64_t leaf, const double (&corners)[8],
    const Box& samples, Out* out) const;
  template <class Out>
  void FillAround(const HexBrick& brick, const Box& samples, Out* out) const;
  BrickView Sampled(const HexBrick& brick, const Box& samples) const;

  std::shared_ptr<const HexBricks> Cut;
  NodalField Values;
  HexBrickSummary Summary;
  std::atomic<std::size_t> BytesOfLevels{ 0 };
};

} // namespace banyan

#endif
