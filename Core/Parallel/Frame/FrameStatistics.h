// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Frame_FrameStatistics_h
#define banyan_Parallel_Frame_FrameStatistics_h

#include <cstdint>

namespace banyan
{

class Communicator;

/// Says what one frame took. Numbers are summed over ranks; the seconds are the slowest rank's.
struct FrameStatistics
{
  double TotalSeconds = 0;
  double RenderSeconds = 0;    ///< until the last ray; with what was composited meanwhile
  double CompositeSeconds = 0; ///< after the last ray; with waiting, where compositing began before
  double ProbeSeconds = 0;     ///< before that, of a plan: finding distances and levels
  double StrideSeconds = 0;    ///< and pixels that need no rays
  int Probes = 0;              ///< small pictures that these took
  double Imbalance = 1;        ///< slowest rank's render seconds over the mean, >= 1
  std::int64_t SamplesTaken = 0;
  std::int64_t BricksDrawn = 0;
  std::int64_t BricksUniform = 0;
  std::int64_t BricksSkipped = 0;
  double ReusedFraction = 0.0;          ///< PutBackReused
  std::uint64_t BytesComposited = 0;    ///< sent between ranks to make one picture of N
  std::uint64_t MessagesComposited = 0; ///< in so many messages

  /// Adds what another picture took that was drawn after this one: the worse of what is no sum.
  void Add(const FrameStatistics& other);
};

/// Is told by a rank to the others about a frame. It has plain numbers: all are sent in one
/// message.
struct FrameReport
{
  double RenderSeconds;
  double CompositeSeconds;
  double TotalSeconds;
  double SamplesTaken;
  double BricksDrawn;
  double BricksUniform;
  double BricksSkipped;
  double ReusedFraction;
  double BytesComposited;
  double MessagesComposited;
};

/// Collective: makes statistics of the reports of all ranks.
/// @param root a rank that has pixels
void Publish(
  Communicator& communicator, const FrameReport& mine, int root, FrameStatistics& statistics);

} // namespace banyan

#endif
