// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Steps_InterpolatedBrickSource_h
#define banyan_Render_Steps_InterpolatedBrickSource_h

#include "Render/Bricks/BrickSource.h"
#include "Series/Decode/BetweenSteps.h"

#include <memory>
#include <vector>

namespace banyan
{

/// Values between two steps (see BetweenSteps), brick by brick as they are drawn. A brick that is
/// the same at both steps is that brick: of that content, and no more is loaded. Of vectors and
/// colours the components are interpolated, and then joined. Ranges and masks are bounds. Hidden
/// points are those of either step.
class InterpolatedBrickSource : public BrickSource
{
public:
  /// The same field at both steps.
  struct Ends
  {
    std::unique_ptr<BrickSource> Earlier;
    std::unique_ptr<BrickSource> Later;
  };
  /// A component, and how its values are made.
  struct Part
  {
    Ends Steps;
    BetweenSteps How;
  };

  /// @param type of the array: float32 or float64
  /// @param parts the drawn component; or all components, which are joined
  /// @param joined the steps where all components are joined; null otherwise
  /// @param how SampleArray::Magnitude or Colours, where all components are joined
  InterpolatedBrickSource(ScalarType type, std::vector<Part> parts, Ends joined, int how);

  glm::ivec3 Bricks() const override { return this->Drawn.Earlier->Bricks(); }
  Box CellsOf(std::int64_t brick) const override { return this->Drawn.Earlier->CellsOf(brick); }

  ValueRange RangeOf(std::int64_t brick) const override;
  ValueMask MaskOf(std::int64_t brick) const override;
  MaskRange MasksAreOver() const override { return this->Drawn.Earlier->MasksAreOver(); }
  /// Not known where components are joined.
  std::optional<UniformValue> UniformValueOf(std::int64_t brick) const override;
  std::optional<Hash128> ContentOf(std::int64_t brick) const override;
  bool HasColours() const override { return this->Drawn.Earlier->HasColours(); }
  glm::ivec3 CellEdges() const override { return this->Drawn.Earlier->CellEdges(); }
  std::size_t LoadBytes(std::int64_t brick) const override;
  BrickView Load(std::int64_t brick) override;

  /// All that it is made of.
  std::vector<const BrickSource*> Sources() const;

protected:
  std::unique_ptr<BrickSource> MakeLevel(int level, const Box& domain) override;

private:
  struct View
  {
    BrickSource* Earlier = nullptr;
    BrickSource* Later = nullptr;
  };

  InterpolatedBrickSource() = default; ///< a coarser level, whose sources belong to the finest one
  bool IsSame(std::int64_t brick) const;
  BrickView LoadPart(std::int64_t brick, std::size_t part) const;

  ScalarType Type = ScalarType::Float32;
  std::vector<Ends> Owned;
  View Drawn;                    ///< what is drawn where both steps are the same
  std::vector<View> Parts;       ///< Drawn alone, or all components
  std::vector<BetweenSteps> How; ///< of Parts
  bool Joins = false;
  int JoinedHow = 0; ///< if Joins
};

} // namespace banyan

#endif
