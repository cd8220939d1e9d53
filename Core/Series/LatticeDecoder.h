#ifndef banyan_Series_LatticeDecoder_h
#define banyan_Series_LatticeDecoder_h

#include "Series/LatticeValues.h"
#include "Series/Transform.h"

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace banyan
{

/// Decodes lattice numbers k of a transformed component: (T) f^-1(origin + k * step), in double
/// precision.
///
/// Lattices of a few thousand numbers are what error bounds for pictures give, so that the results
/// fit into a table: one load per voxel whatever the transform costs. Numbers outside the table are
/// computed; the bits are the same either way. Thread-safe once built.
template <class T>
class LatticeDecoder
{
public:
  /// Entries that a table may have: 256 KiB of float32, which a second-level cache holds.
  static constexpr std::int64_t GreatestTable = 65536;

  /// @param step finite, > 0; @param origin finite. Throws Error otherwise.
  /// @param first,last the numbers to expect, both included; only speed depends on them. No table
  /// is made when first > last or when there are more than GreatestTable.
  LatticeDecoder(
    const Transform& transform, double origin, double step, std::int64_t first, std::int64_t last);

  /// What one number decodes to.
  T ValueOf(std::int64_t number) const;

  /// decoded[i] from the number base + offsets[i], as Dequantize of Quantizer.h has it. Any input
  /// is safe.
  void Decode(std::int64_t base, const std::uint32_t* offsets, std::size_t count, T* decoded) const;

  /// decoded[i * step] from numbers[i * stride]. Any input is safe.
  /// @param Number std::int32_t or std::int16_t
  template <class Number>
  void Decode(const Number* numbers, std::ptrdiff_t stride, std::size_t count, T* decoded,
    std::ptrdiff_t step) const
  {
    if constexpr (std::is_floating_point_v<T>)
    {
      if (stride == 1 && step == 1 && this->Map.IsIdentity())
      {
        return ValuesOnLattice(numbers, count, this->Origin, this->Step, decoded);
      }
    }
    const std::uint64_t entries = this->Table.size();
    const std::int64_t first = entries > 0 ? this->First : 0;
    const T* table = this->Table.data();
    for (std::size_t i = 0; i < count; ++i, numbers += stride, decoded += step)
    {
      const std::uint64_t entry = static_cast<std::uint64_t>(*numbers - first);
      *decoded = entry < entries ? table[entry] : this->Compute(*numbers);
    }
  }

private:
  T Compute(std::int64_t number) const;

  Transform Map;
  double Origin;
  double Step;
  std::int64_t First;
  std::vector<T> Table; ///< of the numbers First, First + 1, ...
};

} // namespace banyan

#endif
