// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Quantize/TransposedRows.h"

#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Series/Quantize/TransposedRows.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Numbers of a square that is copied at once.
constexpr int Square = 8;

#if HWY_TARGET != HWY_SCALAR
/// Interleaving rows with those four after them moves one bit of the row's number to that of the
/// lane: after three times all have changed places.
HWY_INLINE void CopySquare(
  const std::int16_t* from, std::ptrdiff_t fromRow, std::int16_t* to, std::ptrdiff_t toRow)
{
  const hn::Full128<std::int16_t> tag;
  hn::Vec<decltype(tag)> rows[Square], turned[Square];
  for (int i = 0; i < Square; ++i)
  {
    rows[i] = hn::LoadU(tag, from + i * fromRow);
  }
  for (int round = 0; round < 3; ++round)
  {
    for (int i = 0; i < Square / 2; ++i)
    {
      turned[2 * i] = hn::InterleaveLower(tag, rows[i], rows[i + Square / 2]);
      turned[2 * i + 1] = hn::InterleaveUpper(tag, rows[i], rows[i + Square / 2]);
    }
    for (int i = 0; i < Square; ++i)
    {
      rows[i] = turned[i];
    }
  }
  for (int j = 0; j < Square; ++j)
  {
    hn::StoreU(rows[j], tag, to + j * toRow);
  }
}
#endif

template <class Number>
HWY_INLINE void CopySlowly(
  const Number* from, std::ptrdiff_t fromRow, int rows, int count, Number* to, std::ptrdiff_t toRow)
{
  for (int j = 0; j < count; ++j)
  {
    for (int i = 0; i < rows; ++i)
    {
      to[j * toRow + i] = from[i * fromRow + j];
    }
  }
}

void CopyShort(const std::int16_t* from, std::ptrdiff_t fromRow, int rows, int count,
  std::int16_t* to, std::ptrdiff_t toRow)
{
#if HWY_TARGET == HWY_SCALAR
  CopySlowly(from, fromRow, rows, count, to, toRow);
#else
  int i = 0;
  for (; i + Square <= rows; i += Square)
  {
    int j = 0;
    for (; j + Square <= count; j += Square)
    {
      CopySquare(from + i * fromRow + j, fromRow, to + j * toRow + i, toRow);
    }
    CopySlowly(from + i * fromRow + j, fromRow, Square, count - j, to + j * toRow + i, toRow);
  }
  CopySlowly(from + i * fromRow, fromRow, rows - i, count, to + i, toRow);
#endif
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace banyan
{

HWY_EXPORT(CopyShort);

template <>
void CopyTransposed(const std::int16_t* from, std::ptrdiff_t fromRow, int rows, int count,
  std::int16_t* to, std::ptrdiff_t toRow)
{
  HWY_DYNAMIC_DISPATCH(CopyShort)(from, fromRow, rows, count, to, toRow);
}

template <>
void CopyTransposed(const std::int32_t* from, std::ptrdiff_t fromRow, int rows, int count,
  std::int32_t* to, std::ptrdiff_t toRow)
{
  for (int j = 0; j < count; ++j)
  {
    for (int i = 0; i < rows; ++i)
    {
      to[j * toRow + i] = from[i * fromRow + j];
    }
  }
}

} // namespace banyan
#endif
