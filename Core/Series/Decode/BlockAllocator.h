// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Decode_BlockAllocator_h
#define banyan_Series_Decode_BlockAllocator_h

#include <cstddef>

#if defined(__SANITIZE_ADDRESS__)
#define BANYAN_HAS_ADDRESS_SANITIZER
#elif defined(__has_feature) // clang, which fuzzing takes
#if __has_feature(address_sanitizer)
#define BANYAN_HAS_ADDRESS_SANITIZER
#endif
#endif

namespace banyan
{

/// Memory for boxes of lattice numbers: tens of thousands of a few sizes, which come and go. They
/// lie side by side in slabs, which the system maps with large pages where it can: a box of a block
/// of 16 takes three small pages, and each has to be looked up. All slabs together take no more
/// than a limit, or 8 MiB; boxes beyond that have memory of their own. Slabs without boxes are kept
/// for the next ones: the system would clear their pages anew. Thread-safe.
class BlockAllocator
{
public:
  static constexpr std::size_t SlabBytes = std::size_t{ 2 } << 20;
  /// There may always be so many: one for each size of boxes of a series.
  static constexpr std::size_t FewSlabs = 4;
  /// Larger boxes have memory of their own.
  static constexpr std::size_t MostBytes = SlabBytes / 8;

  /// Memory that is aligned as lines of the cache are, and not set. Throws std::bad_alloc.
  static void* Allocate(std::size_t bytes);
  /// @param memory from Allocate, for as many bytes
  static void Free(void* memory, std::size_t bytes) noexcept;

  /// Limits the bytes of all slabs; those above it go when they are empty. Default: 128 MiB.
  /// QuantizedBlockCache sets it to the budgets of all of its kind.
  static void KeepAtMost(std::size_t bytes);

  /// Returns the bytes of all slabs, for tests.
  static std::size_t BytesOfSlabs();
};

} // namespace banyan

#endif
