// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Decode_LatticeDecoder_h
#define banyan_Series_Decode_LatticeDecoder_h

#include "Series/Quantize/DequantizeRows.h"
#include "Series/Quantize/Transform.h"

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
/// fit into a table, which is what transforms take then; without a transform floating-point values
/// are computed, in vectors. So are numbers outside the table; the bits are the same either way.
/// Thread-safe once built.
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

  /// Returns the value that one number decodes to.
  T ValueOf(std::int64_t number) const;

  /// decoded[i] from the number base + offsets[i]. Any input
  /// is safe.
  void Decode(std::int64_t base, const std::uint32_t* offsets, std::size_t count, T* decoded) const;

  /// Decodes a box of numbers; any input is safe.
  /// @param pitch of the numbers along y and z: rows lie side by side
  /// @param size along x, y, z
  /// @param to strides of what is decoded
  /// @param Number std::int32_t or std::int16_t
  template <class Number>
  void Decode(const Number* numbers, const glm::i64vec3& pitch, const glm::ivec3& size, T* decoded,
    const glm::i64vec3& to) const
  {
    if constexpr (std::is_floating_point_v<T>)
    {
      if (to.x == 1 && this->Map.IsIdentity())
      {
        return DequantizeRows(numbers, pitch, size, this->Origin, this->Step, decoded, to);
      }
    }
    const std::uint64_t entries = this->Table.size();
    const std::int64_t first = entries > 0 ? this->First : 0;
    const T* table = this->Table.data();
    for (int z = 0; z < size.z; ++z)
    {
      for (int y = 0; y < size.y; ++y)
      {
        const Number* from = numbers + z * pitch.z + y * pitch.y;
        T* at = decoded + z * to.z + y * to.y;
        for (int x = 0; x < size.x; ++x, at += to.x)
        {
          const std::uint64_t entry = static_cast<std::uint64_t>(from[x] - first);
          *at = entry < entries ? table[entry] : this->Compute(from[x]);
        }
      }
    }
  }

  /// Decodes boxes of numbers that lie side by side along x, row by row of all of them.
  /// @param y,z how many rows along these axes; each box has as many
  template <class Number>
  void DecodeParts(const LatticePart<Number>* parts, int count, int y, int z, T* decoded,
    const glm::i64vec3& to) const
  {
    if constexpr (std::is_floating_point_v<T>)
    {
      if (to.x == 1 && this->Map.IsIdentity())
      {
        return DequantizeParts(parts, count, y, z, this->Origin, this->Step, decoded, to);
      }
    }
    for (int i = 0; i < count; ++i)
    {
      this->Decode(
        parts[i].Numbers, { 1, parts[i].Y, parts[i].Z }, { parts[i].Width, y, z }, decoded, to);
      decoded += parts[i].Width * to.x;
    }
  }

  /// Decodes numbers that lie side by side.
  template <class Number>
  void Decode(const Number* numbers, std::size_t count, T* decoded) const
  {
    this->Decode(numbers, { 1, 0, 0 }, { static_cast<int>(count), 1, 1 }, decoded, { 1, 0, 0 });
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
