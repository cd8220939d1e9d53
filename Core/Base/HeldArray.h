// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_HeldArray_h
#define banyan_Base_HeldArray_h

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace banyan
{

/// An array that is read only, with what keeps its memory: a vector of its own, or memory that
/// other processes read, too. Copies refer to the same memory.
template <class T>
class HeldArray
{
public:
  HeldArray() = default;
  HeldArray(std::vector<T> values)
  {
    const auto kept = std::make_shared<const std::vector<T>>(std::move(values));
    *this = HeldArray(kept->data(), kept->size(), kept);
  }
  /// @param owner keeps the memory
  HeldArray(const T* first, std::size_t count, std::shared_ptr<const void> owner)
    : First(first)
    , Count(count)
    , Owner(std::move(owner))
  {
  }

  std::size_t size() const { return this->Count; }
  bool empty() const { return this->Count == 0; }
  const T* data() const { return this->First; }
  const T* begin() const { return this->First; }
  const T* end() const { return this->First + this->Count; }
  const T& operator[](std::size_t i) const { return this->First[i]; }
  const T& back() const { return this->First[this->Count - 1]; }

  std::size_t Bytes() const { return this->Count * sizeof(T); }

private:
  const T* First = nullptr;
  std::size_t Count = 0;
  std::shared_ptr<const void> Owner;
};

} // namespace banyan

#endif
