// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Codec_DecodeStages_h
#define banyan_Codec_DecodeStages_h

#include <cstdint>

/// Where decoding spends its time, counted by the processor's own clock. Costs nothing, and counts
/// nothing, unless the build says BANYAN_STAGES.
namespace banyan::stages
{

enum Name : int
{
  Elsewhere,    ///< whatever is no stage: callers
  Tables,       ///< tables of steps, nodes of bricks, frequencies of symbols
  Prefetch,     ///< references of the next block are asked for
  Lookup,       ///< boxes found in the cache, added to it, and memory for them
  Coarse,       ///< samples of the coarser plane, to their places
  Plain,        ///< faces of neighbours, uniform blocks and those that rest
  Payload,      ///< payloads are opened
  Edges,        ///< all of edges
  FaceCopies,   ///< faces to memory of their own and back
  FacePasses,   ///< predictions of faces
  FaceContexts, ///< which rows of faces have symbols, and tables of those
  References,   ///< means of references, subtracted and added
  RowClasses,   ///< which rows of interiors have symbols
  Contexts,     ///< tables and signs of their symbols
  Symbols,      ///< symbols and flags are read
  Residuals,    ///< magnitudes, sums and residuals are kept
  Passes,       ///< predictions of interiors, with residuals
  Order,        ///< the codec's order of axes to the data's
  Values,       ///< numbers to values, and these to memory
  Copies,       ///< bricks of one value
  Count
};

/// Ticks that a thread has spent since it began, by stage.
struct Spent
{
  std::uint64_t Ticks[Count] = {};
  std::uint64_t Times[Count] = {}; ///< how often it came there
  std::uint64_t SymbolsRead = 0;   ///< flags included
};

/// For tables that people read.
const char* TextOf(int stage);

/// Whether this build counts.
bool Counted();
/// Ticks of a second.
double TicksPerSecond();
/// Ticks that the calling thread has spent until now.
Spent OfThisThread();

#ifdef BANYAN_STAGES
struct Clock
{
  Spent All;
  int Now = Elsewhere;
  std::uint64_t Since = 0;

  /// Time is that of another stage from now on.
  void Switch(int stage);
};
extern thread_local Clock Own __attribute__((tls_model("initial-exec")));

/// While it lives, time is that of the stage; what another one inside takes is not.
class In
{
public:
  explicit In(Name stage)
    : Before(Own.Now)
  {
    Own.Switch(stage);
    ++Own.All.Times[stage];
  }
  ~In() { Own.Switch(this->Before); }
  In(const In&) = delete;
  In& operator=(const In&) = delete;

private:
  int Before;
};
#else
class [[maybe_unused]] In
{
public:
  constexpr explicit In(Name) {}
};
#endif

inline void CountSymbols([[maybe_unused]] int count)
{
#ifdef BANYAN_STAGES
  Own.All.SymbolsRead += static_cast<std::uint64_t>(count);
#endif
}

} // namespace banyan::stages

#endif
