// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Levels_BrickLoader_h
#define banyan_Render_Levels_BrickLoader_h

#include "Render/Levels/BrickBatch.h"

namespace banyan
{

/// Loads bricks and packs them for drawing. Packed bricks are offered to the source's cache of
/// them, and so is what can be seen of each.
class BrickLoader
{
public:
  /// @param level must stay
  explicit BrickLoader(const LevelScene& level);

  /// Completes a brick of a batch; does nothing more for one that has an Entry. May be called from
  /// any thread, for different bricks at a time.
  /// Throws Error when the brick cannot be read, or is too large to be shaded.
  void Load(LoadedBrick& brick) const;

private:
  BrickVisibility LookAt(const PlannedBrick& brick, const PackedBrick& packed) const;
  PackedBrickCache::Pointer Pack(const PlannedBrick& brick) const;
  BrickView LoadLarge(const PlannedBrick& brick) const;
  double StepToPack(ScalarType type) const;

  const LevelScene& Level;
  BrickSource& Source;
  float GradientScale; ///< brings gradients near 1: their squares neither overflow nor vanish
};

} // namespace banyan

#endif
