// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Codec_ScalarSymbols_h
#define banyan_Codec_ScalarSymbols_h

#include "Base/Error.h"
#include "Codec/Tans.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace banyan::scalar
{

/// The symbol that a state of a context decodes to, and the way to the next state.
struct State
{
  int Symbol;
  int Bits;
  int Base;
};
using StateOf = std::function<State(int context, std::uint32_t state)>;

/// The 512 states of a context.
std::vector<State> StatesFrom(const tans::Frequencies& frequencies);

/// Reads a payload bit by bit, lowest bit of a byte first.
class BitReader
{
public:
  BitReader(const std::uint8_t* data, std::size_t bytes)
    : Data(data)
    , Bits(8 * bytes)
  {
  }

  std::uint32_t Take(int count)
  {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i)
    {
      if (this->Next == this->Bits)
      {
        throw Error("The payload of a block is damaged: it ends too early");
      }
      value |= static_cast<std::uint32_t>(this->Data[this->Next / 8] >> this->Next % 8 & 1) << i;
      ++this->Next;
    }
    return value;
  }

  std::size_t Left() const { return this->Bits - this->Next; }

private:
  const std::uint8_t* Data;
  std::size_t Bits;
  std::size_t Next = 0;
};

/// Symbols of a payload: 1, 2, 4 or 8 states take turns in each run.
class Symbols
{
public:
  Symbols(const StateOf& stateOf, const std::uint8_t* data, std::size_t bytes)
    : OfContext(stateOf)
    , Bits(data, bytes)
    , States(std::size_t{ 1 } << this->Bits.Take(2))
  {
    for (std::uint32_t& state : this->States)
    {
      state = this->Bits.Take(9);
    }
  }

  /// The symbol number `place` of a run.
  int Next(int context, std::size_t place)
  {
    std::uint32_t& state = this->States[place % this->States.size()];
    const State entry = this->OfContext(context, state);
    state = static_cast<std::uint32_t>(entry.Base) + this->Bits.Take(entry.Bits);
    return entry.Symbol;
  }

  /// 0, 1, -1, 2, -2, ... by code; takes the symbol's extra bits.
  std::int32_t Residual(int symbol)
  {
    const std::uint32_t code =
      symbol < 40 ? static_cast<std::uint32_t>(symbol)
                  : 39u + (std::uint32_t{ 1 } << (symbol - 40)) + this->Bits.Take(symbol - 40);
    return static_cast<std::int32_t>(code % 2 == 0 ? code / 2 : 0u - (code / 2 + code % 2));
  }

  void MustBeAtEnd() const
  {
    for (const std::uint32_t state : this->States)
    {
      if (state != 0)
      {
        throw Error(
          "The payload of a block is damaged: its states do not end where encoding began");
      }
    }
    if (this->Bits.Left() >= 8)
    {
      throw Error("The payload of a block is damaged: it is too long");
    }
  }

private:
  const StateOf& OfContext;
  BitReader Bits;
  std::vector<std::uint32_t> States;
};

} // namespace banyan::scalar

#endif
