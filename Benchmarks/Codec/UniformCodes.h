// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_UniformCodes_h
#define banyan_Benchmarks_UniformCodes_h

#include "CodecMethod.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace banyan::bench
{

/// Uniform scalar quantisation, as renderers of 8-bit data do it: 2^bits codes over the range
/// that bounds are made from, one byte each up to 8 bits and two beyond. Values outside the range
/// are clipped, so the bound holds only inside it.
class UniformCodes
{
public:
  /// @param bits in [1, 16]
  UniformCodes(const ValueRange& range, int bits)
    : Low(static_cast<float>(range.Low))
    , Width(static_cast<float>(std::ldexp(range.Width(), -bits)))
    , Last(static_cast<float>((1 << bits) - 1))
    , CodeBytes(bits <= 8 ? 1 : 2)
  {
  }

  int BytesPerCode() const { return this->CodeBytes; }

  /// @tparam Code std::uint8_t up to 8 bits, std::uint16_t for any number of them
  template <class Code>
  void Quantize(const float* values, std::size_t count, Code* codes) const
  {
    const float inverse = this->Width > 0 ? 1 / this->Width : 0;
    for (std::size_t i = 0; i < count; ++i)
    {
      const float code = (values[i] - this->Low) * inverse;
      // Written so that NaN becomes 0.
      codes[i] = static_cast<Code>(code > 0 ? (code < this->Last ? code : this->Last) : 0);
    }
  }

  /// Each value becomes the middle of its class.
  template <class Code>
  void Restore(const Code* codes, std::size_t count, float* values) const
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      values[i] = this->Low + (static_cast<float>(codes[i]) + 0.5f) * this->Width;
    }
  }

  /// As above, with BytesPerCode() bytes for each code in memory.
  void QuantizeToBytes(
    const float* values, std::size_t count, std::vector<std::uint8_t>& bytes) const
  {
    bytes.resize(count * static_cast<std::size_t>(this->CodeBytes));
    this->CodeBytes == 1
      ? this->Quantize(values, count, bytes.data())
      : this->Quantize(values, count, reinterpret_cast<std::uint16_t*>(bytes.data()));
  }

  void RestoreFromBytes(const std::vector<std::uint8_t>& bytes, float* values) const
  {
    const std::size_t count = bytes.size() / static_cast<std::size_t>(this->CodeBytes);
    this->CodeBytes == 1
      ? this->Restore(bytes.data(), count, values)
      : this->Restore(reinterpret_cast<const std::uint16_t*>(bytes.data()), count, values);
  }

private:
  float Low;
  float Width;
  float Last;
  int CodeBytes;
};

} // namespace banyan::bench

#endif
