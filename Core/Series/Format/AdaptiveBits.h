// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Format_AdaptiveBits_h
#define banyan_Series_Format_AdaptiveBits_h

#include "Base/Bytes.h"
#include "Base/Error.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

/// Arithmetic coding of single bits, each with a probability that adapts to what it was before: see
/// Documentation/format.md, "Coded bits". For tables, which are too small for anything that has to
/// be told its probabilities first.
namespace banyan::bits
{

constexpr int MostSeen = 30;
constexpr std::uint32_t LeastRange = std::uint32_t{ 1 } << 24;
constexpr int RawBits = 16; ///< at once

constexpr std::array<std::uint16_t, MostSeen + 1> MakeRates()
{
  std::array<std::uint16_t, MostSeen + 1> rates{};
  for (std::uint32_t n = 0; n < rates.size(); ++n)
  {
    rates[n] = static_cast<std::uint16_t>(131072u / (2u * n + 3u));
  }
  return rates;
}

/// A probability goes this share of the way to certainty, in 1/65536, by how often it has learnt.
constexpr std::array<std::uint16_t, MostSeen + 1> Rates = MakeRates();

/// How probable it is that a bit is set. Learns fast at first, later slowly.
class Model
{
public:
  std::uint32_t Share(std::uint32_t range) const { return (range >> 16) * this->Set; }

  void Learn(bool set)
  {
    const std::uint32_t rate = Rates[this->Seen];
    if (set)
    {
      this->Set = static_cast<std::uint16_t>(this->Set + ((65535u - this->Set) * rate >> 16));
    }
    else
    {
      this->Set = static_cast<std::uint16_t>(this->Set - (this->Set * rate >> 16));
    }
    this->Seen = static_cast<std::uint8_t>(this->Seen < MostSeen ? this->Seen + 1 : MostSeen);
  }

private:
  std::uint16_t Set = 32768; ///< in 1/65536
  std::uint8_t Seen = 0;
};

/// Writer and Reader have the same functions, so that one piece of code serves both directions:
/// each takes the value to write (the reader does not look at it) and returns the one that is
/// there.
class Writer
{
public:
  static constexpr bool Reads = false;

  bool Bit(Model& model, bool value)
  {
    const std::uint32_t share = model.Share(this->Range);
    if (value)
    {
      this->Range = share;
    }
    else
    {
      this->Add(share);
      this->Range -= share;
    }
    model.Learn(value);
    this->Shift();
    return value;
  }

  /// @param count up to RawBits
  std::uint32_t Raw(int count, std::uint32_t value)
  {
    this->Range >>= count;
    this->Add(value * this->Range);
    this->Shift();
    return value;
  }

  /// The bytes; nothing may be written after.
  Bytes Finish()
  {
    this->Add(LeastRange - 1);
    this->Out.push_back(static_cast<std::uint8_t>(this->Low >> 24));
    return std::move(this->Out);
  }

private:
  void Add(std::uint32_t value)
  {
    this->Low += value;
    if (this->Low < value)
    {
      for (std::size_t i = this->Out.size(); i-- > 0 && ++this->Out[i] == 0;)
      {
      }
    }
  }

  void Shift()
  {
    for (; this->Range < LeastRange; this->Range <<= 8)
    {
      this->Out.push_back(static_cast<std::uint8_t>(this->Low >> 24));
      this->Low <<= 8;
    }
  }

  Bytes Out;
  std::uint32_t Low = 0;
  std::uint32_t Range = 0xffffffffu;
};

/// Throws Error when there are fewer bytes than what is read takes.
class Reader
{
public:
  static constexpr bool Reads = true;

  Reader(const std::uint8_t* data, std::size_t bytes)
    : At(data)
    , End(data + bytes)
  {
    if (bytes == 0)
    {
      throw Error("A table of the segment is empty");
    }
    for (int i = 0; i < 4; ++i)
    {
      this->Next();
    }
  }

  bool Bit(Model& model, bool)
  {
    const std::uint32_t share = model.Share(this->Range);
    const bool set = this->Code < share;
    if (set)
    {
      this->Range = share;
    }
    else
    {
      this->Code -= share;
      this->Range -= share;
    }
    model.Learn(set);
    this->Shift();
    return set;
  }

  std::uint32_t Raw(int count, std::uint32_t)
  {
    this->Range >>= count;
    const std::uint32_t value = this->Code / this->Range;
    if (value >> count != 0)
    {
      throw Error("A table of the segment holds bits that nobody writes");
    }
    this->Code -= value * this->Range;
    this->Shift();
    return value;
  }

  void MustBeDone() const
  {
    if (this->Beyond != 3)
    {
      throw Error("A table of the segment is longer than what it holds");
    }
  }

private:
  void Next()
  {
    this->Code <<= 8;
    if (this->At != this->End)
    {
      this->Code |= *this->At++;
    }
    else if (++this->Beyond > 3)
    {
      throw Error("A table of the segment ends too early");
    }
  }

  void Shift()
  {
    for (; this->Range < LeastRange; this->Range <<= 8)
    {
      this->Next();
    }
  }

  const std::uint8_t* At;
  const std::uint8_t* End;
  int Beyond = 0; ///< bytes read behind the end, as zeros: 3 of the last 4 in the end
  std::uint32_t Code = 0;
  std::uint32_t Range = 0xffffffffu;
};

/// A number of `count` bits, highest first, each with a model for all that came before it.
/// @param models 2^count of them
template <class Coder>
std::uint32_t Tree(Coder& coder, Model* models, int count, std::uint32_t value)
{
  std::uint32_t node = 1;
  for (int i = count; i-- > 0;)
  {
    node = node * 2 + (coder.Bit(models[node], (value >> i & 1) != 0) ? 1 : 0);
  }
  return node - (std::uint32_t{ 1 } << count);
}

/// Bits of any count without models, the highest ones first.
template <class Coder>
std::uint64_t Raw(Coder& coder, int count, std::uint64_t value)
{
  std::uint64_t all = 0;
  while (count > 0)
  {
    const int now = count % RawBits == 0 ? RawBits : count % RawBits;
    count -= now;
    const std::uint64_t part = value >> count & ((std::uint64_t{ 1 } << now) - 1);
    all = all << now | coder.Raw(now, static_cast<std::uint32_t>(part));
  }
  return all;
}

/// Whole numbers that are small more often than not.
class Numbers
{
public:
  template <class Coder>
  std::uint32_t Code(Coder& coder, std::uint32_t value)
  {
    int length = 0;
    for (std::uint32_t rest = Coder::Reads ? 0 : value; rest != 0; rest >>= 1)
    {
      ++length;
    }
    length =
      static_cast<int>(Tree(coder, this->Lengths.data(), 6, static_cast<std::uint32_t>(length)));
    if (length > 32)
    {
      throw Error("A table of the segment holds a number that is out of range");
    }
    if (length < 2)
    {
      return static_cast<std::uint32_t>(length);
    }
    // The two bits behind the highest, then the rest, which is noise.
    const int modelled = length > 2 ? 2 : 1;
    const int rest = length - 1 - modelled;
    const std::uint32_t top = Tree(coder, this->Tops[static_cast<std::size_t>(length)].data(),
      modelled, value >> rest & ((1u << modelled) - 1));
    const std::uint32_t low = static_cast<std::uint32_t>(Raw(coder, rest, value));
    return ((1u << modelled | top) << rest) | low;
  }

  /// A number that is not far from `expected`, in arithmetic modulo 2^32.
  template <class Coder>
  std::int32_t Near(Coder& coder, std::int32_t value, std::int32_t expected)
  {
    const std::uint32_t from = static_cast<std::uint32_t>(expected);
    const std::uint32_t difference = static_cast<std::uint32_t>(value) - from;
    const std::uint32_t code = this->Code(coder, difference << 1 ^ (0u - (difference >> 31)));
    return static_cast<std::int32_t>(from + (code >> 1 ^ (0u - (code & 1))));
  }

private:
  std::array<Model, 64> Lengths;
  std::array<std::array<Model, 4>, 33> Tops;
};

/// Finite real numbers in two series, of which many are repeated, or need no more than an f32.
class Reals
{
public:
  template <class Coder>
  double Code(Coder& coder, std::size_t which, double value)
  {
    const std::uint64_t all = BitCast<std::uint64_t>(value);
    if (coder.Bit(this->Repeats[which], all == BitCast<std::uint64_t>(this->Last[which])))
    {
      return this->Last[which];
    }
    const bool fits = std::abs(value) <= std::numeric_limits<float>::max() &&
                      static_cast<double>(static_cast<float>(value)) == value;
    const bool isFloat = coder.Bit(this->IsFloat, fits);
    const std::uint64_t bits =
      isFloat && fits ? BitCast<std::uint32_t>(static_cast<float>(value)) : all;
    const int rest = isFloat ? 16 : 48;
    std::uint64_t read = 0;
    for (int i = 0; i < 2; ++i)
    {
      read = read << 8 | Tree(coder, this->Tops[isFloat ? 1 : 0][i].data(), 8,
                           static_cast<std::uint32_t>(bits >> (rest + 8 - 8 * i) & 255));
    }
    read = read << rest | Raw(coder, rest, bits);
    const double real = isFloat
                          ? static_cast<double>(BitCast<float>(static_cast<std::uint32_t>(read)))
                          : BitCast<double>(read);
    this->Last[which] = real;
    return real;
  }

private:
  Model Repeats[2], IsFloat;
  std::array<Model, 256> Tops[2][2];
  double Last[2] = {};
};

} // namespace banyan::bits

#endif
