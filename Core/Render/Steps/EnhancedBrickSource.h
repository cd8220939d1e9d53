// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Steps_EnhancedBrickSource_h
#define banyan_Render_Steps_EnhancedBrickSource_h

#include "Render/Bricks/BrickSource.h"
#include "Render/Steps/TemporalEnhancement.h"

#include <array>
#include <memory>

namespace banyan
{

/// A step of a series with its motion brought out (see TemporalEnhancement), brick by brick as they
/// are drawn: what cannot be seen is neither read nor computed, and coarser levels are those of the
/// enhanced field. Values are computed in double precision and rounded to float32 (float64 where
/// the step's own are). Ranges and masks are bounds.
class EnhancedBrickSource : public BrickSource
{
public:
  /// @param previous, next the same bricks of other steps; null where there are none. `now` must
  /// not be null.
  EnhancedBrickSource(const TemporalEnhancement& how, std::unique_ptr<BrickSource> previous,
    std::unique_ptr<BrickSource> now, std::unique_ptr<BrickSource> next);

  glm::ivec3 Bricks() const override { return this->Now->Bricks(); }
  Box CellsOf(std::int64_t brick) const override { return this->Now->CellsOf(brick); }
  int BrickLevel(std::int64_t brick) const override { return this->Now->BrickLevel(brick); }
  int CoarsestBrickLevel() const override { return this->Now->CoarsestBrickLevel(); }
  bool IsGrid() const override { return this->Now->IsGrid(); }
  glm::ivec3 CellEdges() const override { return this->Now->CellEdges(); }
  std::vector<std::int64_t> RanksFrontToBack(const Viewpoint& view) const override
  {
    return this->Now->RanksFrontToBack(view);
  }

  ValueRange RangeOf(std::int64_t brick) const override;
  ValueMask MaskOf(std::int64_t brick) const override;
  MaskRange MasksAreOver() const override { return this->Over; }
  /// Where the bricks of all steps are of one value.
  std::optional<UniformValue> UniformValueOf(std::int64_t brick) const override;
  /// Of the contents of all steps.
  std::optional<Hash128> ContentOf(std::int64_t brick) const override;
  std::size_t LoadBytes(std::int64_t brick) const override;
  BrickView Load(std::int64_t brick) override;

  /// The step before, this one and the one after; null where there is none.
  std::array<const BrickSource*, 3> Steps() const
  {
    return { { this->Previous, this->Now, this->Next } };
  }

protected:
  std::unique_ptr<BrickSource> MakeLevel(int level, const Box& domain) override;

private:
  /// A coarser level, whose steps belong to those of `finest`.
  EnhancedBrickSource(
    const TemporalEnhancement& how, BrickSource* previous, BrickSource* now, BrickSource* next);
  void FindMaskRange();

  TemporalEnhancement How;
  std::unique_ptr<BrickSource> Owned[3];
  BrickSource* Previous;
  BrickSource* Now;
  BrickSource* Next;
  MaskRange Over;
};

} // namespace banyan

#endif
