// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Decode/CacheContext.h"

#include "Base/CacheBudget.h"

namespace banyan
{

CacheContext::CacheContext(std::uint64_t budgetBytes)
  : Budget(budgetBytes)
  , QuantizedBlocks(budgetBytes / 4)
  , PayloadsInMemory(budgetBytes / 32)
{
}

CacheContext::~CacheContext() = default;

const std::shared_ptr<CacheContext>& CacheContext::Process()
{
  // Never destroyed: series that are closed while the process ends still come here.
  static const auto* const context =
    new std::shared_ptr<CacheContext>(std::make_shared<CacheContext>(CacheBudgetBytes()));
  return *context;
}

std::shared_ptr<CacheContext> CacheContext::WithBudget(std::int64_t budgetBytes)
{
  return budgetBytes < 0 ? Process()
                         : std::make_shared<CacheContext>(static_cast<std::uint64_t>(budgetBytes));
}

std::int64_t CacheContext::OwnBudgetBytes() const
{
  return this == Process().get() ? -1 : static_cast<std::int64_t>(this->Budget);
}

} // namespace banyan
