// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Cache_BrickCache_h
#define banyan_Cache_BrickCache_h

#include "Series/Decode/SeriesFile.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace banyan
{

class CacheContext;

/// Decoded samples of one brick, in the array's own type, `[z][y][x]`, x fastest.
struct BrickValues
{
  ScalarType Type = ScalarType::Float32;
  Box Samples; ///< in samples of its level, starting at 0 (see BrickLayout)
  std::vector<unsigned char> Bytes;

  template <class T>
  const T* As() const
  {
    return reinterpret_cast<const T*>(this->Bytes.data());
  }
};

/// Least-recently-used cache of decoded bricks under a hard byte budget, shared by reader and
/// renderer. Bricks are known by what they decode to (payload identity), so one that does not
/// change over time is held once.
///
/// Bricks in use (whose pointer somebody holds) are not counted after they were evicted; callers
/// that hold many must bound them on their own (the renderer draws in batches).
/// All methods may be called from any thread; two threads that ask for the same brick decode it
/// once.
class BrickCache
{
public:
  struct Statistics
  {
    std::uint64_t Bytes = 0;     ///< held now
    std::uint64_t PeakBytes = 0; ///< most ever held
    std::uint64_t Hits = 0;
    std::uint64_t Misses = 0; ///< equals the number of bricks decoded through the cache
    std::uint64_t Evictions = 0;
    double DecodeSeconds = 0.0; ///< of all threads that decoded; reading is a part of it
    double WaitSeconds = 0.0;   ///< of all threads that asked and found nothing: decoding, waiting
  };

  /// @param budgetBytes 0 keeps nothing
  explicit BrickCache(std::uint64_t budgetBytes);
  ~BrickCache();
  BrickCache(const BrickCache&) = delete;
  BrickCache& operator=(const BrickCache&) = delete;

  std::shared_ptr<const BrickValues> Get(
    const SeriesFile& series, const FieldKey& field, std::int64_t brick);

  /// The brick if it is held, otherwise null: for those who decode past the cache.
  /// @param node of the brick
  std::shared_ptr<const BrickValues> GetIfHeld(
    const SeriesFile& series, const FieldKey& field, const BrickNode& node, std::int64_t brick);

  /// Decodes a brick before anybody asks for it, if it is not held already. Asking for it later is
  /// a hit, and counted among those of AheadStatistics the first time.
  /// @return bytes that the cache holds more
  std::uint64_t GetAhead(const SeriesFile& series, const FieldKey& field, std::int64_t brick);
  struct AheadStatistics
  {
    std::uint64_t Decoded = 0; ///< bricks; among the misses
    std::uint64_t Hits = 0;    ///< of these were asked for later
  };
  AheadStatistics GetAheadStatistics() const;

  std::uint64_t Budget() const;
  /// Others take so much more (or less) of that: bricks that ranks fetch from each other. Evicts at
  /// once.
  void Reserve(std::int64_t change);
  void Clear();
  Statistics GetStatistics() const;

  /// The cache of a context, and of that which a series was opened with.
  static BrickCache& Of(CacheContext& context);
  static BrickCache& Of(const SeriesFile& series);

private:
  struct Internals;
  std::unique_ptr<Internals> Self;
};

/// Copies the part `samples` of a field into a caller's array, decoding (in parallel) only the
/// bricks that it touches. They come from the cache and go there. But a part of a sixth or more
/// of the cache's budget goes past it, because it would push out everything else and be gone itself
/// before it comes again; and so does a part of 1 MiB or more whose values are multiples of a step
/// (SeriesFile::StepOfValues), because the numbers are kept and values are soon made of them.
/// @param samples of the field's level, inside the layout's samples
/// @param values receives samples.Count() tuples; the value goes to
/// `values[tupleIndex * stride + component]`, x fastest, in the array's own type.
/// @param stride components per tuple of the receiving array
void ReadRegion(BrickCache& cache, const SeriesFile& series, const FieldKey& field,
  const Box& samples, void* values, int stride, int component);

} // namespace banyan

#endif
