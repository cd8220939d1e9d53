#ifndef banyan_Series_LatticeBox_h
#define banyan_Series_LatticeBox_h

#include <cstddef>
#include <cstdint>
#include <memory>

namespace banyan
{

/// Lattice numbers of a decoded box, in 16 bits each where the range of the lattice allows it: what
/// decoding waits for is memory.
class LatticeBox
{
public:
  /// @param numbers from least to greatest
  LatticeBox(
    const std::int32_t* numbers, std::size_t count, std::int32_t least, std::int32_t greatest)
    : Count(count)
    , Least(least)
  {
    if (static_cast<std::uint32_t>(greatest) - static_cast<std::uint32_t>(least) <= 0xffffu)
    {
      this->Short.reset(new std::uint16_t[count]); // not set to zeros first
      for (std::size_t i = 0; i < count; ++i)
      {
        this->Short[i] = static_cast<std::uint16_t>(
          static_cast<std::uint32_t>(numbers[i]) - static_cast<std::uint32_t>(least));
      }
      return;
    }
    this->Long.reset(new std::int32_t[count]);
    for (std::size_t i = 0; i < count; ++i)
    {
      this->Long[i] = numbers[i];
    }
  }

  /// Calls body(pointer to numbers, what is to be added to each).
  template <class Body>
  void Visit(Body&& body) const
  {
    if (this->Short)
    {
      body(static_cast<const std::uint16_t*>(this->Short.get()), this->Least);
    }
    else
    {
      body(static_cast<const std::int32_t*>(this->Long.get()), std::int32_t{ 0 });
    }
  }

  void CopyTo(std::int32_t* numbers) const
  {
    const std::size_t count = this->Count;
    this->Visit(
      [&](const auto* from, std::int32_t base)
      {
        for (std::size_t i = 0; i < count; ++i)
        {
          numbers[i] = from[i] + base;
        }
      });
  }

  /// Every number at first, first + step, ...
  void CopyTo(
    std::size_t first, std::size_t step, std::size_t count, std::int32_t* numbers) const
  {
    this->Visit(
      [&](const auto* from, std::int32_t base)
      {
        for (std::size_t i = 0; i < count; ++i)
        {
          numbers[i] = from[first + i * step] + base;
        }
      });
  }

  std::uint64_t Bytes() const
  {
    return this->Count * (this->Short ? sizeof(std::uint16_t) : sizeof(std::int32_t));
  }

private:
  std::unique_ptr<std::uint16_t[]> Short; ///< less `Least`
  std::unique_ptr<std::int32_t[]> Long;
  std::size_t Count;
  std::int32_t Least;
};

} // namespace banyan

#endif
