// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Fuzz_h
#define banyan_Testing_Fuzz_h

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace banyan::fuzz
{

/// Takes numbers and bytes off the front of an input; zeros and nothing when it is used up.
class Input
{
public:
  Input(const std::uint8_t* data, std::size_t size)
    : Data(data)
    , Size(size)
  {
  }

  template <class T>
  T Take()
  {
    T value{};
    const std::vector<std::uint8_t> bytes = this->Bytes(sizeof(T));
    if (!bytes.empty())
    {
      std::memcpy(&value, bytes.data(), bytes.size());
    }
    return value;
  }

  std::vector<std::uint8_t> Bytes(std::size_t count)
  {
    const std::size_t some = std::min(count, this->Size);
    std::vector<std::uint8_t> bytes(this->Data, this->Data + some);
    this->Data += some;
    this->Size -= some;
    return bytes;
  }

  std::vector<std::uint8_t> Rest() { return this->Bytes(this->Size); }

private:
  const std::uint8_t* Data;
  std::size_t Size;
};

} // namespace banyan::fuzz

#endif
