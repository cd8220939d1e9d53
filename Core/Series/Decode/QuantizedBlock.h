// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Decode_QuantizedBlock_h
#define banyan_Series_Decode_QuantizedBlock_h

#include "Series/Decode/BlockAllocator.h"

#include <cstddef>
#include <cstdint>

namespace banyan
{

/// Lattice numbers of a decoded box, in 16 bits each where block::Narrow says so of the lattice:
/// what decoding waits for is memory.
class QuantizedBlock
{
public:
  /// The numbers are not set.
  QuantizedBlock(std::size_t count, bool narrow)
    : Size(count * (narrow ? sizeof(std::int16_t) : sizeof(std::int32_t)))
    , Short(narrow)
    , Place(BlockAllocator::Allocate(this->Size))
  {
  }
  ~QuantizedBlock() { BlockAllocator::Free(this->Place, this->Size); }
  QuantizedBlock(const QuantizedBlock&) = delete;
  QuantizedBlock& operator=(const QuantizedBlock&) = delete;

  template <class Number>
  const Number* Numbers() const
  {
    return const_cast<QuantizedBlock*>(this)->Numbers<Number>();
  }
  /// @param Number std::int16_t or std::int32_t, as the box has them; else there are none
  template <class Number>
  Number* Numbers()
  {
    return this->Short == (sizeof(Number) == sizeof(std::int16_t))
             ? static_cast<Number*>(this->Place)
             : nullptr;
  }

  /// Calls body(pointer to numbers).
  template <class Body>
  void Visit(Body&& body) const
  {
    if (this->Short)
    {
      body(this->Numbers<std::int16_t>());
    }
    else
    {
      body(this->Numbers<std::int32_t>());
    }
  }

  /// Where the numbers lie.
  const void* Memory() const { return this->Place; }
  std::uint64_t Bytes() const { return this->Size; }

private:
  std::size_t Size;
  bool Short;
  void* Place;
};

} // namespace banyan

#endif
