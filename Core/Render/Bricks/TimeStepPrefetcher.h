// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_TimeStepPrefetcher_h
#define banyan_Render_Bricks_TimeStepPrefetcher_h

#include "Cache/BackgroundDecoder.h"
#include "Cache/BrickCache.h"
#include "Cache/PlayDirection.h"

namespace banyan
{

class BrickSource;

/// Decodes the next time step of an encoded series in the direction of play, while the picture of
/// one is composited and shown: the bricks that were drawn of this one, within half of what the
/// cache has for decoded bricks, so that those of this one can stay. Stops while rays are cast.
///
/// @par Limits: bricks that were not drawn of this step are not expected to be drawn of the next.
class TimeStepPrefetcher
{
public:
  /// @param cache must stay
  /// @param threads that decode
  TimeStepPrefetcher(BrickCache& cache, int threads)
    : Cache(cache)
    , Decoder(cache, threads)
  {
  }

  /// Before a picture.
  void Drawing(const SeriesFile& series, int step);
  /// After its rays were cast.
  /// @param source that it was drawn from: a SeriesBrickSource, or an EnhancedBrickSource of such
  void Drawn(const std::shared_ptr<const SeriesFile>& series, const BrickSource& source);

  /// The step that is expected to be drawn next; -1 for none.
  int Next() const { return this->NextStep; }
  const BrickCache& DecodesInto() const { return this->Cache; }
  BackgroundDecoder& Work() { return this->Decoder; }

private:
  BrickCache& Cache;
  BackgroundDecoder Decoder;
  PlayDirection Direction;
  int NextStep = -1;
};

} // namespace banyan

#endif
