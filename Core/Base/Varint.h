// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_Varint_h
#define banyan_Base_Varint_h

#include "Base/Bytes.h"
#include "Base/Error.h"

namespace banyan
{

/// Numbers in 7 bits per byte, lowest first (LEB128); signed ones zigzag coded.
inline void PutVarint(Bytes& out, std::uint64_t value)
{
  while (value >= 128)
  {
    out.push_back(static_cast<std::uint8_t>(128 | (value & 127)));
    value >>= 7;
  }
  out.push_back(static_cast<std::uint8_t>(value));
}

inline void PutSigned(Bytes& out, std::int64_t value)
{
  PutVarint(
    out, (static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63));
}

/// Reads what a table holds, checking its end.
class ByteReader
{
public:
  ByteReader(const std::uint8_t* data, std::size_t bytes)
    : At(data)
    , End(data + bytes)
  {
  }

  std::uint8_t Byte()
  {
    this->Need(1);
    return *this->At++;
  }

  std::uint64_t Varint()
  {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7)
    {
      const std::uint64_t byte = this->Byte();
      value |= (byte & 127) << shift;
      if (byte < 128)
      {
        return value;
      }
    }
    throw Error("A table of the segment holds a number that is too long");
  }

  std::int64_t Signed()
  {
    const std::uint64_t code = this->Varint();
    return static_cast<std::int64_t>((code >> 1) ^ (0 - (code & 1)));
  }

  template <class T>
  T Number()
  {
    this->Need(sizeof(T));
    const T value = LoadNumber<T>(this->At);
    this->At += sizeof(T);
    return value;
  }

  const std::uint8_t* Skip(std::size_t bytes)
  {
    this->Need(bytes);
    const std::uint8_t* start = this->At;
    this->At += bytes;
    return start;
  }

  std::size_t Left() const { return static_cast<std::size_t>(this->End - this->At); }

  void MustBeDone() const
  {
    if (this->At != this->End)
    {
      throw Error("A table of the segment is longer than what it holds");
    }
  }

private:
  void Need(std::size_t bytes) const
  {
    if (this->Left() < bytes)
    {
      throw Error("A table of the segment ends too early");
    }
  }

  const std::uint8_t* At;
  const std::uint8_t* End;
};

} // namespace banyan

#endif
