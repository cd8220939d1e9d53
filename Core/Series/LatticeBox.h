#ifndef banyan_Series_LatticeBox_h
#define banyan_Series_LatticeBox_h

#include <cstddef>
#include <cstdint>
#include <memory>

namespace banyan
{

/// Lattice numbers of a decoded box, in 16 bits each where block::Narrow says so of the lattice: what
/// decoding waits for is memory.
class LatticeBox
{
public:
  /// The numbers are not set.
  LatticeBox(std::size_t count, bool narrow)
    : Short(narrow ? new std::int16_t[count] : nullptr)
    , Long(narrow ? nullptr : new std::int32_t[count])
    , Count(count)
  {
  }

  template <class Number>
  const Number* Numbers() const
  {
    return const_cast<LatticeBox*>(this)->Numbers<Number>();
  }
  /// @param Number std::int16_t or std::int32_t, as the box has them
  template <class Number>
  Number* Numbers()
  {
    if constexpr (sizeof(Number) == sizeof(std::int16_t))
    {
      return this->Short.get();
    }
    else
    {
      return this->Long.get();
    }
  }

  /// Calls body(pointer to numbers).
  template <class Body>
  void Visit(Body&& body) const
  {
    if (this->Short)
    {
      body(static_cast<const std::int16_t*>(this->Short.get()));
    }
    else
    {
      body(static_cast<const std::int32_t*>(this->Long.get()));
    }
  }

  /// Asks for the numbers, which will be read soon: for every other line of the cache, as processors fetch
  /// pairs of them.
  void Prefetch() const
  {
    this->Visit(
      [this](const auto* numbers)
      {
        const char* const bytes = reinterpret_cast<const char*>(numbers);
        for (std::uint64_t at = 0; at < this->Bytes(); at += 128)
        {
          __builtin_prefetch(bytes + at, 0, 2);
        }
      });
  }

  std::uint64_t Bytes() const
  {
    return this->Count * (this->Short ? sizeof(std::int16_t) : sizeof(std::int32_t));
  }

private:
  std::unique_ptr<std::int16_t[]> Short;
  std::unique_ptr<std::int32_t[]> Long;
  std::size_t Count;
};

} // namespace banyan

#endif
