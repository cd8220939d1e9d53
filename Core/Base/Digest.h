// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_Digest_h
#define banyan_Base_Digest_h

#include "Base/Hash.h"

#include <cstddef>
#include <string>
#include <type_traits>
#include <vector>

namespace banyan
{

/// Collects all that something depends on, bit by bit, for one hash of it.
class Digest
{
public:
  /// @tparam T without padding
  template <class T>
  void Add(const T& value)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    this->Bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  /// @tparam T without padding
  template <class T>
  void Add(const std::vector<T>& values)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    this->Add(values.size());
    this->Add(HashOf(values.data(), values.size() * sizeof(T)));
  }

  Hash128 Get() const { return HashOf(this->Bytes.data(), this->Bytes.size()); }

private:
  std::string Bytes;
};

} // namespace banyan

#endif
