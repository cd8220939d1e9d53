// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_LoadBalancer_h
#define banyan_Parallel_LoadBalancer_h

#include "Parallel/Rebalance.h"
#include "Parallel/ScreenCuts.h"
#include "Parallel/TreeSearch.h"

#include <array>
#include <optional>
#include <vector>

namespace banyan
{

/// What one rank took for a frame.
struct RankWork
{
  double Seconds = 0; ///< in which it cast rays
  double Work = 0;    ///< that it did in them: the same on a slow rank as on a quick one
};

/// An edge of blocks that are few enough to be looked at in each frame: a power of two, at least 8.
int BlockEdgeFor(const glm::ivec3& positions);

/// Moves the planes of a zone tree from frame to frame. Depends on what it is told and on nothing
/// else, so that all ranks that are told the same have the same tree.
///
/// *Measured cost* expects costs of blocks in three ways, and goes by the one that has lately been
/// right about the ranks' work:
/// - work in proportion to what is seen (ViewCosts), as of the last two frames that saw a block;
///   blocks that were never seen are expected to cost what others do for as much,
/// - the work of the last two frames,
/// - the average of many frames.
/// Where zones may turn, axes are chosen anew when that is expected to save much work: zones side
/// by side on the screen do less, in all, than zones behind each other. Such a tree is what it
/// begins with, too. Speeds of ranks are smoothed. Where moving planes was a mistake, again and
/// again, it waits ever longer between moves.
class LoadBalancer
{
public:
  struct Options
  {
    LoadBalancing Mode = LoadBalancing::Off;
    glm::ivec3 Positions{ 0 }; ///< that zones may be cut at: cells
    int Ranks = 1;
    /// Zones to begin with; without nodes, zones of equal numbers of bricks.
    ZoneTree Start;
    int SlicePositions = 16; ///< thickness of a slice of bricks
    /// Where planes that are moved by measured cost may stand: at multiples of it.
    int PlaneStep = 1;
    int BlockEdge = 8; ///< positions per block of the costs
    double BytesPerPosition = 4.0;
    /// That may change ranks before a frame: so many, or half of what is drawn if that is more.
    double MostBytes = 32.0 * 1048576.0;
    /// Axes are chosen anew when frames are expected to be faster by this factor.
    double TurnGain = 1.15;
    /// Whether planes of a view that rests are searched for by what was measured.
    bool Searches = true;
  };

  /// Throws Error when there are no ranks, no positions per block or brick, or zones to begin with
  /// of another grid or number of ranks.
  explicit LoadBalancer(const Options& options);

  const Options& Given() const { return this->Settings; }
  const ZoneTree& Tree() const { return this->Zones; }

  /// Before a frame: moves planes.
  /// @param view what is seen of each block (Options::BlockEdge), in any unit that stays the same
  /// @param cuts from where the camera is; null where axes must stay as they are, because bricks
  /// travel: what turning moves has no limit but what is drawn
  void BeginFrame(const BrickCosts& view, const ScreenCuts* cuts = nullptr);

  /// The next frame draws other values, of another step say. What was learned of costs is still the
  /// best guess, but a view that rests is not the same view any more.
  void ValuesChanged() { this->Search.Forget(); }

  /// Instead of the zones that the last BeginFrame came to: for the frame that was begun.
  void SetTree(const ZoneTree& tree) { this->Zones = tree; }

  /// After it.
  /// @param ranks what each one took
  /// @param work of each block, of all ranks together, in the unit of RankWork::Work
  void FrameTook(const std::vector<RankWork>& ranks, const BrickCosts& work);

  /// That the last BeginFrame moved.
  double BytesMoved() const { return this->Moved; }
  /// Of the frame that was begun last: largest over mean seconds.
  double ExpectedImbalance() const { return this->Expected; }

private:
  enum Expectation
  {
    FromView,
    FromLast,
    FromMany,
    Expectations
  };

  void MoveSlices();
  void MoveToBalance(const BrickCosts& view, const ScreenCuts* cuts);
  bool SearchPlanes(const BrickCosts& bytes, double mostBytes);
  void Turn(
    const BrickCosts& costs, const BrickCosts& bytes, const ScreenCuts& cuts, Rebalanced& next);
  std::vector<double> ExpectedFromView(const BrickCosts& view) const;
  BrickCosts DrawnBytes(const std::vector<double>& costs) const;
  BrickCosts CostsOf(const std::vector<double>& values) const;
  std::vector<double> Speeds() const;
  void LearnWork(const BrickCosts& work);
  void LearnSpeeds(const std::vector<RankWork>& ranks, const BrickCosts& work);
  void LearnErrors(const BrickCosts& work);
  void LearnMistakes(const BrickCosts& work);

  Options Settings;
  ZoneTree Zones;
  double Moved = 0.0;
  double Expected = 1.0;

  std::int64_t Frames = 0;      ///< that took something
  std::vector<RankWork> Last;   ///< of the last frame
  std::vector<double> LastWork; ///< by blocks, as all that follows
  std::vector<double> OlderWork;
  std::vector<double> LongWork;
  std::vector<double> View;       ///< of the last frame
  std::optional<ScreenCuts> Cuts; ///< of the last frame, where it had any
  std::vector<double> Ratio;      ///< work over view when a block was last seen; -1: never
  std::vector<double> OlderRatio; ///< and the time before

  std::array<std::vector<double>, Expectations> Costs; ///< of the frame that was begun
  std::array<double, Expectations> Errors{ { 0.0, 0.0, 0.0 } };

  struct Pace
  {
    double SecondsPerWork = 1.0; ///< in units of the ranks' median
    int Frames = 0;              ///< that the average is over
    double Outlier = 0.0;        ///< of the last frame, if it was one
    int Outliers = 0;            ///< frames one after the other that were, in the same direction
    double Share = 1.0;          ///< work of the zone by blocks over that by bricks
  };
  std::vector<Pace> Paces;

  ZoneTree Before;  ///< the last BeginFrame
  int Mistakes = 0; ///< how often moving planes made it worse, lately
  int Wait = 0;     ///< frames until planes may move again
  int Rest = 0;     ///< frames until axes may be chosen anew
  bool Moving = false;
  bool SameViewBefore = false; ///< whether the last frame had the view of the one before

  TreeSearch Search; ///< of the view of the last frames
};

} // namespace banyan

#endif
