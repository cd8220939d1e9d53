// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_RecycledMemory_h
#define banyan_Base_RecycledMemory_h

#include <cstddef>
#include <new>

namespace banyan
{

/// Large pieces of memory that are needed again soon, such as pictures of frame after frame, and
/// bricks that are packed for one picture. Where they go back to the system in between, it clears
/// each page anew: 16 MB take it longer than drawing what is in a simple picture. Those given back
/// last are kept, up to MostKeptBytes in all. Safe to use from any thread.
class LargeMemory
{
public:
  static constexpr std::size_t Smallest = std::size_t{ 1 } << 16; ///< smaller ones are not kept
  static constexpr std::size_t MostKeptBytes = std::size_t{ 128 } << 20;

  /// Throws std::bad_alloc.
  static void* Allocate(std::size_t bytes);
  /// @param bytes as they were allocated
  static void Free(void* memory, std::size_t bytes) noexcept;

  /// Returns the bytes that are kept at present. Trim gives all of them back to the system.
  static std::size_t KeptBytes();
  static void Trim() noexcept;
};

/// An allocator of LargeMemory.
/// @tparam Smallest pieces of fewer bytes are not kept: of those whose size is ever another one,
/// such as small pictures, more and more would be
template <class T, std::size_t Smallest = std::size_t{ 1 } << 20>
struct RecycledMemory
{
  static_assert(Smallest >= LargeMemory::Smallest, "smaller ones are not kept anyway");
  using value_type = T;

  RecycledMemory() = default;
  template <class U>
  struct rebind
  {
    using other = RecycledMemory<U, Smallest>;
  };
  template <class U>
  RecycledMemory(const RecycledMemory<U, Smallest>&) noexcept
  {
  }

  T* allocate(std::size_t count)
  {
    const std::size_t bytes = count * sizeof(T);
    return static_cast<T*>(bytes < Smallest ? ::operator new(bytes) : LargeMemory::Allocate(bytes));
  }
  void deallocate(T* memory, std::size_t count) noexcept
  {
    const std::size_t bytes = count * sizeof(T);
    bytes < Smallest ? ::operator delete(memory) : LargeMemory::Free(memory, bytes);
  }

  /// Elements that `resize` adds are not set: whoever wants zeros says so.
  template <class U>
  void construct(U* place)
  {
    ::new (static_cast<void*>(place)) U;
  }

  template <class U>
  friend bool operator==(const RecycledMemory&, const RecycledMemory<U, Smallest>&) noexcept
  {
    return true;
  }
  template <class U>
  friend bool operator!=(const RecycledMemory&, const RecycledMemory<U, Smallest>&) noexcept
  {
    return false;
  }
};

} // namespace banyan

#endif
