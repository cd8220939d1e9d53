// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Balance_LoadBalancer_h
#define banyan_Parallel_Balance_LoadBalancer_h

#include "Parallel/Balance/PlaneTrials.h"
#include "Parallel/Balance/RankSpeeds.h"
#include "Parallel/Balance/Rebalance.h"
#include "Parallel/Balance/ScreenCuts.h"

#include <optional>
#include <vector>

namespace banyan
{

/// An edge of blocks that are few enough to be looked at in each frame: a power of two, at least 8.
int BlockEdgeFor(const glm::ivec3& positions);

/// Moves the planes of a zone tree from frame to frame, to where measured costs balance. Depends on
/// what it is told and on nothing else, so that all ranks that are told the same have the same
/// tree.
///
/// @par Cost model
/// A block of cells is expected to cost what is seen of it in the next frame, times its density:
/// the work per what was seen in the last frame that saw it. Blocks that were never seen have the
/// density of all blocks together.
///
/// @par When planes move
/// Planes go to where the expected costs on their sides are as the speeds of the ranks there
/// (RankSpeeds), when the expected imbalance falls by LeastGain. While the view is the same,
/// PlaneTrials goes by what was measured of other trees. Where zones may turn, axes are chosen anew
/// when frames are expected to be faster by TurnGain: zones side by side on the screen do less, in
/// all, than zones behind each other. Such a tree is what it begins with, too.
///
/// @par How much may move
/// At most MostBytes: all planes then go the same part of their way. Turning moves what it must.
class LoadBalancer
{
public:
  struct Options
  {
    glm::ivec3 Positions{ 0 }; ///< that zones may be cut at: cells
    int Ranks = 1;
    /// Zones to begin with; without nodes, zones of equal numbers of bricks.
    ZoneTree Start;
    int BrickPositions = 16; ///< per brick and axis
    int PlaneStep = 1;       ///< planes that are moved stand at multiples of it
    int BlockEdge = 8;       ///< positions per block of the costs
    double BytesPerPosition = 4.0;
    /// Axes are chosen anew when frames are expected to be faster by this factor.
    double TurnGain = 1.15;
  };

  /// Throws Error when there are no ranks, no positions per block or brick, or zones to begin with
  /// of another grid or number of ranks.
  explicit LoadBalancer(const Options& options);

  const Options& GetOptions() const { return this->Settings; }
  const ZoneTree& Tree() const { return this->Zones; }

  /// Before a frame: moves planes.
  /// @param view what is seen of each block (Options::BlockEdge), in any unit that stays the same
  /// @param cuts from where the camera is; null where axes must stay as they are, because bricks
  /// travel
  void BeginFrame(const BrickCosts& view, const ScreenCuts* cuts = nullptr);

  /// The next frame draws other values, of another step say: it takes other work than the last one
  /// even where the view is the same.
  void ValuesChanged() { this->Trials.Forget(); }

  /// Instead of the zones that the last BeginFrame came to: for the frame that was begun.
  void SetTree(const ZoneTree& tree) { this->Zones = tree; }

  /// After it. Nothing is learned from a frame without seconds.
  /// @param ranks what each one took
  /// @param work of each block, of all ranks together, in the unit of RankWork::Work
  void FrameTook(const std::vector<RankWork>& ranks, const BrickCosts& work);

  /// Bytes that may change ranks before a frame, where so many are drawn.
  static double MostBytes(double drawn);

  /// That the last BeginFrame moved.
  double BytesMoved() const { return this->Moved; }
  /// Returns the largest over the mean seconds that are expected of the frame that was begun last.
  double ExpectedImbalance() const { return this->Expected; }

private:
  void MovePlanes(const BrickCosts& view, const ScreenCuts* cuts);
  ZoneTree NextTree(const BrickCosts& costs, const CostSums& bytes) const;
  std::optional<ZoneTree> TurnedTreeFor(
    const CostSums& costs, const ScreenCuts& cuts, const ZoneTree& moved) const;
  BrickCosts ExpectedCosts(const BrickCosts& view) const;
  BrickCosts DrawnBytes(BrickCosts costs) const;
  void LearnDensities(const BrickCosts& work);

  Options Settings;
  ZoneTree Zones;
  double Moved = 0.0;
  double Expected = 1.0;

  std::vector<double> View;       ///< of the last frame, by blocks
  std::optional<ScreenCuts> Cuts; ///< of the last frame, where it had any
  std::vector<double> Density;    ///< of blocks: work over view; -1 where it was never seen
  double MeanDensity = -1.0;      ///< of the last frame; -1 before any
  RankSpeeds Speeds;
  PlaneTrials Trials;          ///< of the view of the last frames
  int TurnCooldown = 0;        ///< frames until axes may be chosen anew
  bool ViewWasResting = false; ///< whether the last frame had the view of the one before
};

} // namespace banyan

#endif
