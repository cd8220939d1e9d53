// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Balance_PlaneTrials_h
#define banyan_Parallel_Balance_PlaneTrials_h

#include "Parallel/Balance/ZoneTree.h"

#include <functional>
#include <optional>
#include <vector>

namespace banyan
{

/// The trees that were drawn of one view. A zone behind another draws what that one would have
/// hidden, so a plane that moves changes what it was moved for. Planes therefore need not get
/// better by moving to where they are expected to balance:
/// - after each tree that was no better, planes go half as far from the best one;
/// - when that moves none any more and ranks differ by more than GoodEnough, they go all the way
///   from the last tree, MostTrials times in all;
/// - in the end the best tree stays.
class PlaneTrials
{
public:
  /// The next frame is one of another view.
  void Forget()
  {
    this->Best.reset();
    this->Failures = 0;
  }

  /// After a frame of the view.
  /// @param work of the ranks
  /// @param speeds of the ranks, in work per second; positive
  void Measured(
    const ZoneTree& tree, const std::vector<double>& work, const std::vector<double>& speeds);

  /// Whether each tree was better than the one before.
  bool GetBetter() const { return this->Failures == 0; }

  /// The tree for the next frame.
  /// @param now of the last frame
  /// @param balanced where planes of a tree are expected to balance; the tree itself where that
  /// gains nothing
  /// @param step planes stand at multiples of it
  ZoneTree Next(const ZoneTree& now, const std::vector<double>& speeds, int step,
    const std::function<ZoneTree(const ZoneTree&)>& balanced) const;

private:
  struct Trial
  {
    ZoneTree Tree;
    std::vector<double> Work;
  };
  std::optional<Trial> Best; ///< the quickest one of the view
  int Failures = 0;          ///< trees of the view that were no better than it
};

} // namespace banyan

#endif
