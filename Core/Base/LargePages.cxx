// SPDX-License-Identifier: BSD-3-Clause
#include "Base/LargePages.h"

#include <sys/mman.h>

namespace banyan
{

void* LargePages::Allocate(std::size_t bytes)
{
  void* const memory = ::operator new (bytes, std::align_val_t{ PageBytes });
#ifdef MADV_HUGEPAGE
  // Not the rest of the last one: it would be cleared as a whole.
  (void)madvise(memory, bytes / PageBytes * PageBytes, MADV_HUGEPAGE);
#endif
  return memory;
}

void LargePages::Free(void* memory) noexcept
{
  ::operator delete (memory, std::align_val_t{ PageBytes });
}

} // namespace banyan
