// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_CodedBits_h
#define banyan_Testing_CodedBits_h

#include "Base/Bytes.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

namespace banyan::testing
{

/// "Coded bits": models have names here.
class CodedBits
{
public:
  explicit CodedBits(const Bytes& bytes)
    : Data(bytes)
  {
    for (int i = 0; i < 4; ++i)
    {
      this->Code = this->Code * 256 + this->Byte();
    }
  }

  bool Bit(const std::string& model)
  {
    auto& [p, n] = this->Models.try_emplace(model, 32768, 0).first->second;
    const std::uint64_t f = (this->Range >> 16) * p;
    const bool bit = this->Code < f;
    this->Range = bit ? f : this->Range - f;
    this->Code -= bit ? 0 : f;
    const std::uint64_t r = 131072 / (2 * n + 3);
    p = bit ? p + ((65535 - p) * r >> 16) : p - (p * r >> 16);
    n = n < 30 ? n + 1 : 30;
    this->Fill();
    return bit;
  }

  std::uint64_t Tree(const std::string& model, int n)
  {
    std::string path = model + " bits ";
    std::uint64_t value = 0;
    for (int i = 0; i < n; ++i)
    {
      const bool bit = this->Bit(path);
      path += bit ? "1" : "0";
      value = 2 * value + (bit ? 1 : 0);
    }
    return value;
  }

  std::uint64_t Raw(int n)
  {
    std::uint64_t value = 0;
    for (int m = n % 16 == 0 ? 16 : n % 16; n > 0; n -= m, m = 16)
    {
      this->Range >>= m;
      const std::uint64_t piece = this->Code / this->Range;
      this->Code -= piece * this->Range;
      value = value << m | piece;
      this->Fill();
    }
    return value;
  }

  std::uint32_t Number(const std::string& model)
  {
    const int length = static_cast<int>(this->Tree(model + " length", 6));
    if (length < 2)
    {
      return static_cast<std::uint32_t>(length);
    }
    const int below = length == 2 ? 1 : 2;
    const std::uint64_t top = this->Tree(model + " of length " + std::to_string(length), below);
    const int rest = length - 1 - below;
    return static_cast<std::uint32_t>(((std::uint64_t{ 1 } << below) + top) << rest) +
           static_cast<std::uint32_t>(this->Raw(rest));
  }

  std::int32_t Near(const std::string& model, std::int64_t e)
  {
    const std::int64_t code = this->Number(model);
    const std::int64_t difference = code % 2 == 0 ? code / 2 : -(code + 1) / 2;
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(e + difference));
  }

  std::uint64_t Long() { return this->Raw(static_cast<int>(this->Raw(7))); }

private:
  std::uint64_t Byte() { return this->At < this->Data.size() ? this->Data[this->At++] : 0; }
  void Fill()
  {
    for (; this->Range < 1 << 24; this->Range *= 256)
    {
      this->Code = this->Code * 256 + this->Byte();
    }
  }

  const Bytes& Data;
  std::size_t At = 0;
  std::uint64_t Code = 0;
  std::uint64_t Range = 0xffffffff;
  std::map<std::string, std::pair<std::uint64_t, std::uint64_t>> Models;
};

} // namespace banyan::testing

#endif
