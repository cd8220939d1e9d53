// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Readers_MeshStepAhead_h
#define banyan_Readers_MeshStepAhead_h

#include "Cache/BackgroundDecoder.h"
#include "Cache/PlayDirection.h"

#include <memory>

namespace banyan
{

class BrickCache;

/// Reads and decodes the next step of a series of meshes that plays, while this one is drawn: on
/// threads of low priority, within half of what the cache has for decoded bricks. Values that are
/// not ready in time are decoded when the step is read.
class MeshStepAhead
{
public:
  /// Is called before a step is read. Work under way stops, except for the brick that each thread
  /// is at.
  void Reading(const SeriesFile& series, int step);

  /// After it was read.
  /// @param bricks of it; those of the next step are wanted. Does not throw.
  void Read(
    const std::shared_ptr<const SeriesFile>& series, std::vector<FieldBricks> bricks) noexcept;

  void Stop();
  /// Returns when all is done: for tests.
  void Finish();

private:
  std::unique_ptr<BackgroundDecoder> Decoder; ///< null until a series plays
  const BrickCache* DecodesInto = nullptr;
  PlayDirection Direction;
  int NextStep = -1;
};

} // namespace banyan

#endif
