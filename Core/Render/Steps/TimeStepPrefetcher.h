// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Steps_TimeStepPrefetcher_h
#define banyan_Render_Steps_TimeStepPrefetcher_h

#include "Base/Box.h"
#include "Cache/BackgroundDecoder.h"
#include "Cache/BrickCache.h"
#include "Cache/PlayDirection.h"

namespace banyan
{

class BrickSource;
struct RayScene;

/// Decodes the next time steps of an encoded series in the direction of play, within half of what
/// the cache has for decoded bricks, so that those of this one can stay: of StepsAhead steps, the
/// bricks that were drawn of this one and those that come into sight; where rays were reused, all
/// that change in sight. After the last step the series begins again.
class TimeStepPrefetcher
{
public:
  /// Steps at which blocks begin anew (every eighth, where groups have as many) take several times
  /// as long to read and decode as those between: that time is spread over so many frames.
  static constexpr int StepsAhead = 4;

  /// @param cache must stay
  /// @param threads that decode
  TimeStepPrefetcher(BrickCache& cache, int threads)
    : Cache(cache)
    , Decoder(cache, threads)
  {
  }

  /// Tells which step is drawn. What was begun for it goes on.
  void Drawing(const SeriesFile& series, int step);
  /// After the rays of a picture were cast.
  /// @param cells that this rank draws, of the finest level
  /// @param source that it was drawn from: a SeriesBrickSource, or an EnhancedBrickSource or
  /// InterpolatedBrickSource of such; what comes into sight of the latter two is not expected
  void Drawn(const std::shared_ptr<const SeriesFile>& series, const RayScene& scene,
    const Box& cells, const BrickSource& source);

  /// The step that is expected to be drawn next; -1 for none.
  int Next() const { return this->NextStep; }
  const BrickCache& DecodesInto() const { return this->Cache; }
  BackgroundDecoder& Work() { return this->Decoder; }

private:
  BrickCache& Cache;
  BackgroundDecoder Decoder;
  PlayDirection Direction;
  int Step = -1;
  int NextStep = -1;
};

} // namespace banyan

#endif
