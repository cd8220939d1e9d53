// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_TreeSearch_h
#define banyan_Parallel_TreeSearch_h

#include "Parallel/BrickCosts.h"
#include "Parallel/ZoneTree.h"

#include <optional>
#include <vector>

namespace banyan
{

/// Searches planes for a view that rests by what was measured of other planes, for what a plane
/// does is not known before it has moved: zones behind others draw what these would have hidden,
/// and inside a block of the costs the work may all be at one side.
///
/// Unknowns are the ratios of the costs that a model of the work expects on the two sides of each
/// plane. What was measured of a few trees tells how the true ratios follow them (Broyden's
/// method); where that comes to no new tree, single planes go one step. The best tree that was
/// measured is kept in the end.
///
/// It begins where the trees of somebody else get no better any more.
///
/// Frames must be repeatable for that: the search begins when a tree that was drawn twice has taken
/// the same twice, and stops, for ever more frames, when it did not.
/// @par Source: C. G. Broyden, "A class of methods for solving nonlinear simultaneous equations",
/// 1965, method 1
class TreeSearch
{
public:
  /// The view is another one: what was measured so far says nothing about it.
  void Forget();

  /// After a frame.
  /// @param work of the ranks, in the order of the leaves
  void Measured(const ZoneTree& tree, const std::vector<double>& work);

  /// The tree for the next frame of the same view, the best one when the search is over. None where
  /// nothing can be learned, or where somebody else should begin.
  /// @param model work of blocks, of the last frames
  /// @param speeds of the ranks, in work per second; positive
  /// @param step planes stand at multiples of it
  std::optional<ZoneTree> Next(
    const BrickCosts& model, const std::vector<double>& speeds, int step);

private:
  struct Trial
  {
    ZoneTree Tree;
    std::vector<double> Work;
    std::vector<double> Model; ///< what the model expects of it
  };

  /// Logarithms of what is below the planes of a tree over what is above, each over what the ranks
  /// there can do. By number of the node; 0 for leaves.
  using Ratios = std::vector<double>;
  static Ratios RatiosOf(
    const ZoneTree& tree, const std::vector<double>& work, const std::vector<double>& speeds);

  const Trial* Find(const ZoneTree& tree) const;
  bool IsNew(const ZoneTree& tree) const;
  std::size_t Best(const std::vector<double>& speeds) const;
  bool GotBetter(std::size_t best, const std::vector<double>& speeds) const;
  Ratios NewtonStep(std::size_t from, const std::vector<double>& speeds) const;
  std::optional<ZoneTree> NewtonTree(std::size_t from, const std::vector<double>& speeds, int step);
  std::optional<ZoneTree> PlanesAt(const ZoneTree& from, const Ratios& ratios,
    const CostSums& model, const std::vector<double>& speeds, int step) const;
  std::optional<ZoneTree> AllPlanesAStep(
    const Trial& from, const std::vector<double>& speeds, int step) const;
  bool SpeedsAreOthers(const std::vector<double>& speeds);
  std::optional<ZoneTree> KeepOn();
  std::optional<ZoneTree> OnePlaneAway(
    const Trial& from, const std::vector<double>& speeds, int step) const;

  std::vector<Trial> Trials;       ///< of the view, in the order of the frames
  BrickCosts Model;                ///< of the frame of the best tree, or of an earlier one
  bool Repeats = false;            ///< whether what was drawn twice took the same
  int Doubts = 0;                  ///< how often it did not, lately
  int Wait = 0;                    ///< frames until it is tried again
  double BestSoFar = 0.0;          ///< imbalance; 0 before the search
  bool LastWasNew = false;         ///< the tree of the last frame
  bool Begun = false;              ///< whether somebody else's trees got no better any more
  int Failures = 0;                ///< trials since it was found
  std::optional<std::size_t> Kept; ///< the trial that the search ended with
  int KeptFrames = 0;              ///< since then
  std::vector<double> UsualSpeeds; ///< of the ranks, on average over the frames of the view
  int SpeedFrames = 0;
};

} // namespace banyan

#endif
