// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_FetchedBricks_h
#define banyan_Parallel_Fields_FetchedBricks_h

#include "Render/Bricks/SampledBox.h"

#include <cstdint>
#include <map>

namespace banyan
{

class BrickCache;

/// Samples of bricks that other ranks hold, received from them: under packed bricks
/// (PackedBrickCache), which are made of them, the second level of what a rank keeps from frame to
/// frame. The least recently used go first; what the frame uses stays.
///
/// Find() may be called from many threads at once, while nobody calls anything else.
class FetchedBricks
{
public:
  /// @param sharesWith a cache whose room for decoded bricks fetched ones take; null for none
  explicit FetchedBricks(BrickCache* sharesWith = nullptr);
  ~FetchedBricks();
  FetchedBricks(const FetchedBricks&) = delete;
  FetchedBricks& operator=(const FetchedBricks&) = delete;

  /// Null when the brick is not here.
  const SampledBox* Find(std::int64_t brick) const;
  /// Whether a brick is here with at least these samples.
  bool Has(std::int64_t brick, const Box& samples) const;
  /// A brick that is here counts as used by the frame.
  void Use(std::int64_t brick) { this->Bricks.at(brick).UsedIn = this->Frame; }
  /// Keeps a brick, in place of the one under its number.
  /// @param bytes that its samples take
  void Keep(std::int64_t brick, const SampledBox& samples, std::uint64_t bytes);

  void BeginFrame() { ++this->Frame; }
  /// Lets go of bricks that the frame did not use, the least recently used first, until `coming`
  /// more bytes are within the budget, or nothing is left that could go.
  void MakeRoom(std::uint64_t coming, std::uint64_t budgetBytes);
  void Clear();

  std::uint64_t Bytes() const { return this->HeldBytes; }
  std::size_t Count() const { return this->Bricks.size(); }

private:
  struct Item
  {
    SampledBox Samples;
    std::uint64_t Bytes = 0;
    std::int64_t UsedIn = 0;
  };

  void Change(std::int64_t bytes);

  BrickCache* Shared;
  std::map<std::int64_t, Item> Bricks;
  std::uint64_t HeldBytes = 0;
  std::int64_t Frame = 0;
};

} // namespace banyan

#endif
