// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Decode_CacheContext_h
#define banyan_Series_Decode_CacheContext_h

#include "Series/Decode/PayloadPages.h"
#include "Series/Decode/QuantizedBlockCache.h"

#include <any>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>

namespace banyan
{

/// The caches of the series that were opened with it, and the budget that they share: a quarter is
/// for quantized blocks, three eighths are for decoded bricks, five sixteenths for bricks that are
/// packed for drawing, and one for pictures. Payloads take an eighth of the first quarter's size
/// beside. May be used from any thread.
class CacheContext
{
public:
  explicit CacheContext(std::uint64_t budgetBytes);
  ~CacheContext();
  CacheContext(const CacheContext&) = delete;
  CacheContext& operator=(const CacheContext&) = delete;

  /// The context of all series that have none of their own, and of data that come from no series.
  /// Its budget is CacheBudgetBytes. It is never destroyed.
  static const std::shared_ptr<CacheContext>& Process();
  /// Returns the process's context, or a new one.
  /// @param budgetBytes of a new one; the process's if negative
  static std::shared_ptr<CacheContext> WithBudget(std::int64_t budgetBytes);

  std::uint64_t BudgetBytes() const { return this->Budget; }
  /// Returns the argument with which WithBudget gives this context, or one like it.
  std::int64_t OwnBudgetBytes() const;
  std::uint64_t DecodedBudgetBytes() const { return this->Budget / 8 * 3; }
  std::uint64_t DrawingBudgetBytes() const { return this->Budget / 16 * 5; }
  std::uint64_t PictureBudgetBytes() const { return this->Budget / 16; }

  QuantizedBlockCache& Blocks() { return this->QuantizedBlocks; }
  PayloadMemory& Payloads() { return this->PayloadsInMemory; }
  /// The cache of decoded bricks. Its class belongs to a layer above this one, and BrickCache::Of
  /// says which: always the same one.
  template <class Cache>
  Cache& Bricks()
  {
    std::call_once(this->DecodedBricksOnce,
      [this] { this->DecodedBricks = std::make_shared<Cache>(this->DecodedBudgetBytes()); });
    return *std::any_cast<const std::shared_ptr<Cache>&>(this->DecodedBricks);
  }
  /// How many sources keep packed bricks, and so share DrawingBudgetBytes.
  std::atomic<int>& DrawingSources() { return this->Drawing; }
  /// How many keep pictures, and so share PictureBudgetBytes.
  std::atomic<int>& PictureKeepers() { return this->Pictures; }

private:
  const std::uint64_t Budget;
  QuantizedBlockCache QuantizedBlocks;
  PayloadMemory PayloadsInMemory;
  std::once_flag DecodedBricksOnce;
  std::any DecodedBricks;
  std::atomic<int> Drawing{ 0 };
  std::atomic<int> Pictures{ 0 };
};

} // namespace banyan

#endif
