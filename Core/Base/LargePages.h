// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_LargePages_h
#define banyan_Base_LargePages_h

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

namespace banyan
{

/// Memory whose whole large pages (2 MiB) the system is asked to give at once: it is cleared in
/// larger pieces, and addresses all over it are found in fewer entries of the processor's tables.
/// Where it has no large pages, this is memory as any other.
class LargePages
{
public:
  static constexpr std::size_t PageBytes = std::size_t{ 1 } << 21;

  /// @param bytes at least a large page's. Throws std::bad_alloc.
  static void* Allocate(std::size_t bytes);
  static void Free(void* memory) noexcept;
};

/// An allocator of LargePages; smaller pieces than such a page are memory as any other.
template <class T>
struct InLargePages
{
  using value_type = T;

  InLargePages() = default;
  template <class U>
  InLargePages(const InLargePages<U>&) noexcept
  {
  }

  T* allocate(std::size_t count)
  {
    const std::size_t bytes = count * sizeof(T);
    return static_cast<T*>(
      bytes < LargePages::PageBytes ? ::operator new(bytes) : LargePages::Allocate(bytes));
  }
  void deallocate(T* memory, std::size_t count) noexcept
  {
    count * sizeof(T) < LargePages::PageBytes ? ::operator delete(memory)
                                              : LargePages::Free(memory);
  }

  template <class U>
  friend bool operator==(const InLargePages&, const InLargePages<U>&) noexcept
  {
    return true;
  }
  template <class U>
  friend bool operator!=(const InLargePages&, const InLargePages<U>&) noexcept
  {
    return false;
  }
};

/// Frees what NewInLargePages allocated.
template <class T>
struct FreeArray
{
  std::size_t Count = 0;
  void operator()(T* memory) const noexcept { InLargePages<T>().deallocate(memory, this->Count); }
};
template <class T>
using ArrayInLargePages = std::unique_ptr<T[], FreeArray<T>>;

/// An array of numbers, which hold anything at first. Throws std::bad_alloc.
template <class T>
ArrayInLargePages<T> NewInLargePages(std::size_t count)
{
  static_assert(std::is_arithmetic_v<T>, "nothing is constructed");
  return ArrayInLargePages<T>(InLargePages<T>().allocate(count), { count });
}

} // namespace banyan

#endif
