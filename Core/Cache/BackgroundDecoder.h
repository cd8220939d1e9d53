// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Cache_BackgroundDecoder_h
#define banyan_Cache_BackgroundDecoder_h

#include "Series/Decode/SeriesFile.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace banyan
{

class BrickCache;

/// Bricks of one field.
struct FieldBricks
{
  FieldKey Field;
  std::vector<std::int64_t> Bricks;
};

/// Reads and decodes bricks into a cache on threads of its own before anybody asks for them: those
/// of the next time step, say. The system runs these threads on cores that nobody else wants, so
/// they need not stop while a picture is drawn: they work while it waits for files, for messages,
/// or for its last tile. What cannot be read is left to whoever asks for it, who is then told why.
///
/// Use it from one thread.
class BackgroundDecoder
{
public:
  /// @param cache must stay
  /// @param threads at least 1; they are started when first needed
  BackgroundDecoder(BrickCache& cache, int threads);
  /// Stops.
  ~BackgroundDecoder();
  BackgroundDecoder(const BackgroundDecoder&) = delete;
  BackgroundDecoder& operator=(const BackgroundDecoder&) = delete;

  /// Finds out what is wanted, in one of the threads. What it throws is nobody's concern: nothing
  /// is decoded then.
  using FindWanted = std::function<std::vector<FieldBricks>()>;

  /// Begins, in place of what it was doing.
  /// @param wanted in the order in which they will be needed; bricks of one value are passed over
  /// @param mostBytes that may be decoded
  void Start(std::shared_ptr<const SeriesFile> series, std::vector<FieldBricks> wanted,
    std::uint64_t mostBytes);

  void Start(
    std::shared_ptr<const SeriesFile> series, FindWanted findWanted, std::uint64_t mostBytes);

  /// Begins no further brick, and does not wait for those that were begun: each thread may be at
  /// one.
  void Stop();
  /// Returns when all is done: for tests and benchmarks.
  void Finish();

private:
  struct Internals;
  std::unique_ptr<Internals> Self;
};

} // namespace banyan

#endif
