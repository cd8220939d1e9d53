#ifndef banyan_Render_BrickSource_h
#define banyan_Render_BrickSource_h

#include "Base/Box.h"
#include "Render/BrickView.h"
#include "Render/KeptBricks.h"
#include "Series/SeriesIndex.h"
#include "Series/ValueMask.h"

#include <cstddef>
#include <cstdint>
#include <memory>

namespace banyan
{

/// What the ray caster draws: a box of cells cut into bricks. Positions are samples of the whole
/// grid (index space, starting at 0); cell c lies between samples c and c + 1.
class BrickSource
{
public:
  virtual ~BrickSource() = default;

  /// Bricks are numbered x fastest over `Bricks()`; brick b owns the cells `CellsOf(b)`.
  virtual glm::ivec3 Bricks() const = 0;
  virtual Box CellsOf(std::int64_t brick) const = 0;

  /// Of the finite values anywhere in the brick; empty when there is none.
  virtual ValueRange RangeOf(std::int64_t brick) const = 0;
  virtual ValueMask MaskOf(std::int64_t brick) const = 0;
  virtual MaskRange MasksAreOver() const = 0;

  /// Memory that one loaded brick takes (0 when the values are in memory anyway).
  virtual std::size_t LoadBytes(std::int64_t brick) const = 0;

  /// Called from many threads. Throws Error when the brick cannot be read.
  virtual BrickView Load(std::int64_t brick) = 0;

  /// The same with one more layer of samples on each side, where the source has them. Unless a
  /// source knows better, it is put together from the bricks around.
  /// @param samples set to those that the view has; the view starts at samples.Lo
  virtual BrickView LoadAround(std::int64_t brick, Box& samples);

  /// What the ray caster keeps of this source from picture to picture. Values must not change while
  /// the source lives.
  KeptBricks& Kept() const { return *this->KeptOfSource; }

private:
  std::shared_ptr<KeptBricks> KeptOfSource = std::make_shared<KeptBricks>();
};

} // namespace banyan

#endif
