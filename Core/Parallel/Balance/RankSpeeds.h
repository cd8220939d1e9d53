// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Balance_RankSpeeds_h
#define banyan_Parallel_Balance_RankSpeeds_h

#include <vector>

namespace banyan
{

/// Holds what one rank took for a frame.
struct RankWork
{
  double Seconds = 0; ///< in which it cast rays
  double Work = 0;    ///< that it did in them: the same on a slow rank as on a quick one
};

/// How quick ranks are, from what frames took. A speed is an average over many frames, so that
/// noise of the clock moves no planes. A rank whose speed has changed much is believed after some
/// frames that say the same.
class RankSpeeds
{
public:
  explicit RankSpeeds(int ranks)
    : Ranks(static_cast<std::size_t>(ranks))
  {
  }

  /// After a frame. Ranks that did hardly anything keep their speed.
  /// @param zoneCosts costs of the zones by blocks, in the unit of the work. Planes cut blocks, so
  /// that they differ from the work
  /// @return whether the speed of a rank has changed much
  bool Learn(const std::vector<RankWork>& ranks, const std::vector<double>& zoneCosts);

  /// Work per second, in units of the median of the ranks; positive.
  std::vector<double> WorkPerSecond() const;
  /// Costs by blocks per second, in the same unit.
  std::vector<double> CostsPerSecond() const;

private:
  struct Speed
  {
    double SecondsPerWork = 1.0; ///< in units of the median of the ranks
    int Frames = 0;              ///< that the average is over
    double CostsPerWork = 1.0;   ///< of the zone in the last frame
    double ChangedSum = 0.0;     ///< of the last frames, which were all far from the average
    int ChangedFrames = 0;       ///< how many, on the same side of it
  };
  static bool Average(Speed& speed, double now);

  std::vector<Speed> Ranks;
};

} // namespace banyan

#endif
