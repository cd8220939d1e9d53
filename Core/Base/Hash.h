// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_Hash_h
#define banyan_Base_Hash_h

#include <cstddef>
#include <cstdint>
#include <string>

namespace banyan
{

/// xxHash's XXH3-128, the halves as that library names them.
struct Hash128
{
  std::uint64_t Low = 0;
  std::uint64_t High = 0;
  friend bool operator==(const Hash128& a, const Hash128& b)
  {
    return a.Low == b.Low && a.High == b.High;
  }
  friend bool operator!=(const Hash128& a, const Hash128& b) { return !(a == b); }
};

/// Detects damage, not malice: nothing that is read may trust a matching hash for memory safety.
Hash128 HashOf(const void* data, std::size_t bytes, std::uint64_t seed = 0);
std::uint64_t ShortHashOf(const void* data, std::size_t bytes);

/// 32 lower-case hexadecimal digits, the high half first, and back. `FromHex` throws Error for any
/// other text.
std::string ToHex(const Hash128& hash);
Hash128 FromHex(const std::string& text);

} // namespace banyan

#endif
