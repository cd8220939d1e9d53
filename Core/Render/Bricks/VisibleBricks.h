// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_VisibleBricks_h
#define banyan_Render_Bricks_VisibleBricks_h

#include "Render/Bricks/BrickSource.h"
#include "Render/Bricks/SummaryTree.h"
#include "Render/Scene/RayScene.h"

#include <cstdint>
#include <vector>

namespace banyan
{

/// Which bricks have values that can be seen, wherever the camera is: through the transfer
/// function, or, where samples are not composited, at all. A brick too many is possible, one too
/// few is not.
class VisibleBricks
{
public:
  /// Both must stay.
  VisibleBricks(const RayScene& scene, const BrickSource& source);

  bool Contains(std::int64_t brick) const;
  /// Visible bins of the source's masks.
  ValueMask Bins() const { return this->VisibleBins; }

  /// Goes to all bricks that can be seen, whole boxes of them where it can, in no order: what takes
  /// time is what can be seen, and its surface.
  /// @param reach called as bool(const Box& cells, bool& all): whether anything in these cells
  /// counts. Where `all` is set everything does, and it is not asked again
  /// @param found called as void(const Box& bricks, const Box& cells), with positions of bricks
  /// that can be seen and count, and their cells: several, if they are those of a grid
  template <class Reach, class Found>
  void ForEach(Reach&& reach, Found&& found) const;

private:
  bool MayContain(const SummaryNode& node) const;
  bool ContainsAll(const SummaryNode& node) const;

  const BrickSource& Source;
  std::shared_ptr<const VisibleValues> Visible;
  ValueMask VisibleBins;
  bool Composited;
};

/// What can be seen of all bricks of a level together.
struct VisibleSigns
{
  std::int64_t Bricks = 0; ///< of which something can be seen
  ValueMask Bins = 0;      ///< that are there, and can be seen
};
VisibleSigns SignsOf(const RayScene& scene, const BrickSource& source);

/// Bricks of the finest level with cells in `cells` that CastRays may load for pictures of the
/// scene, for those of fewer pixels too (WithSize), and their probes: an upper bound.
/// @return numbers, rising
std::vector<std::int64_t> BricksToLoad(
  const RayScene& scene, const BrickSource& source, const Box& cells);

template <class Reach, class Found>
void VisibleBricks::ForEach(Reach&& reach, Found&& found) const
{
  const glm::ivec3 counts = this->Source.Bricks();
  const SummaryTree* const tree = this->Source.Summaries();
  struct Known
  {
    bool Counts = false; ///< all of it does
    bool Seen = false;   ///< all of it is
  };
  const auto visitBrick = [&](const glm::ivec3& at, Known known)
  {
    const Box bricks{ at, at + 1 };
    const std::int64_t brick = BrickSource::NumberOf(at, counts);
    const Box cells = tree ? tree->CellsOf(bricks) : this->Source.CellsOf(brick);
    if ((known.Counts || reach(cells, known.Counts)) && (known.Seen || this->Contains(brick)))
    {
      found(bricks, cells);
    }
  };
  if (!tree)
  {
    ForPositions({ glm::ivec3(0), counts }, [&](const glm::ivec3& at) { visitBrick(at, {}); });
    return;
  }
  tree->Descend(Viewpoint(), Known(),
    [&](const SummaryTree::Place& place, Known& known)
    {
      if ((!known.Counts && !reach(place.Cells, known.Counts)) ||
          (!known.Seen && place.Node && !this->MayContain(*place.Node)))
      {
        return false;
      }
      known.Seen = known.Seen || (place.Node && this->ContainsAll(*place.Node));
      if (known.Seen && known.Counts)
      {
        found(place.Bricks, place.Cells);
        return false;
      }
      if (place.Lowest || place.Height == 0)
      {
        ForPositions(place.Bricks, [&](const glm::ivec3& at) { visitBrick(at, known); });
        return false;
      }
      return true;
    });
}

} // namespace banyan

#endif
