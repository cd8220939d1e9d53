// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/ValueBins.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Render/Bricks/ValueBins.cxx"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;
using Words = hn::ScalableTag<std::uint64_t>;

/// As many values as a vector of double has.
template <class T>
HWY_INLINE V LoadDoubles(const T* values)
{
  if constexpr (sizeof(T) == sizeof(double))
  {
    return hn::LoadU(D(), values);
  }
  else
  {
    return hn::PromoteTo(D(), hn::LoadU(hn::Rebind<float, D>(), values));
  }
}

/// What one vector after the other of a slice is turned into.
class Binning
{
public:
  Binning(const MaskRange& over, const ValueRange& range)
    : Base(over.Low)
    , Scale(over.High > over.Low ? 64.0 / (over.High - over.Low) : 0.0)
    , Lowest(hn::Set(D(), range.Low))
    , Highest(hn::Set(D(), range.High))
  {
  }

  HWY_INLINE void Bin(V values, std::uint8_t* low, std::uint8_t* high)
  {
    const D d;
    const hn::Rebind<std::int32_t, D> ints;
    const hn::Rebind<std::uint8_t, D> bytes;
    const auto finite = hn::Le(hn::Abs(values), hn::Set(d, std::numeric_limits<double>::max()));
    const V infinity = hn::Set(d, std::numeric_limits<double>::infinity());
    const V forLow = hn::IfThenElse(finite, values, infinity);
    const V forHigh = hn::IfThenElse(finite, values, hn::Neg(infinity));
    this->Lowest = hn::IfThenElse(hn::Lt(forLow, this->Lowest), forLow, this->Lowest);
    this->Highest = hn::IfThenElse(hn::Gt(forHigh, this->Highest), forHigh, this->Highest);

    const V position = hn::Mul(hn::Sub(values, hn::Set(d, this->Base)), hn::Set(d, this->Scale));
    const V notBelow = hn::IfThenElseZero(hn::Gt(position, hn::Zero(d)), position);
    const V last = hn::Set(d, 63.0);
    const V bin = hn::IfThenElse(hn::Lt(notBelow, last), notBelow, last);
    const V none = hn::Set(d, double{ BinRowsOut::NoBinLow });
    hn::StoreU(
      hn::DemoteTo(bytes, hn::DemoteTo(ints, hn::IfThenElse(finite, bin, none))), bytes, low);
    hn::StoreU(
      hn::DemoteTo(bytes, hn::DemoteTo(ints, hn::IfThenElseZero(finite, bin))), bytes, high);
  }

  ValueRange Range() const
  {
    ValueRange range;
    HWY_ALIGN double low[hn::MaxLanes(D())];
    HWY_ALIGN double high[hn::MaxLanes(D())];
    hn::Store(this->Lowest, D(), low);
    hn::Store(this->Highest, D(), high);
    for (std::size_t i = 0; i < hn::Lanes(D()); ++i)
    {
      range.Low = low[i] < range.Low ? low[i] : range.Low;
      range.High = high[i] > range.High ? high[i] : range.High;
    }
    return range;
  }

private:
  double Base;
  double Scale;
  V Lowest;
  V Highest;
};

template <class T>
HWY_INLINE void BinAll(
  const ValueRows<T>& rows, const MaskRange& over, const BinRowsOut& out, ValueRange& range)
{
  constexpr int most = static_cast<int>(hn::MaxLanes(D()));
  const int lanes = static_cast<int>(hn::Lanes(D()));
  Binning binning(over, range);
  for (int y = 0; y < rows.Rows; ++y)
  {
    const T* const row = rows.Values + y * rows.Stride;
    std::uint8_t* const low = out.Low + y * BinRowsOut::PitchOf(rows.Width);
    std::uint8_t* const high = out.High + y * BinRowsOut::PitchOf(rows.Width);
    int x = 0;
    for (; x + lanes <= rows.Width; x += lanes)
    {
      binning.Bin(LoadDoubles(row + x), low + x, high + x);
    }
    if (x < rows.Width && rows.Width >= lanes)
    {
      // Those at the end, some of them once more.
      const int from = rows.Width - lanes;
      binning.Bin(LoadDoubles(row + from), low + from, high + from);
    }
    else if (x < rows.Width)
    {
      T padded[most];
      std::uint8_t lows[most];
      std::uint8_t highs[most];
      for (int i = 0; i < lanes; ++i)
      {
        padded[i] = row[i < rows.Width ? i : 0];
      }
      binning.Bin(LoadDoubles(padded), lows, highs);
      for (int i = 0; i < rows.Width; ++i)
      {
        low[i] = lows[i];
        high[i] = highs[i];
      }
    }
    low[rows.Width] = BinRowsOut::NoBinLow;
    high[rows.Width] = BinRowsOut::NoBinHigh;
  }
  range = binning.Range();
}

void BinFloats(
  const ValueRows<float>& rows, const MaskRange& over, const BinRowsOut& out, ValueRange& range)
{
  BinAll(rows, over, out, range);
}

void BinDoubles(
  const ValueRows<double>& rows, const MaskRange& over, const BinRowsOut& out, ValueRange& range)
{
  BinAll(rows, over, out, range);
}

ValueMask BinsBetweenHere(const std::uint8_t* low, const std::uint8_t* high, std::size_t count)
{
  const Words d;
  const hn::Rebind<std::uint32_t, Words> halves;
  const hn::Rebind<std::uint8_t, Words> bytes;
  const std::size_t lanes = hn::Lanes(d);
  const auto promoted = [&](const std::uint8_t* from) HWY_ATTR
  { return hn::PromoteTo(d, hn::PromoteTo(halves, hn::LoadU(bytes, from))); };
  const auto all = hn::Set(d, ~std::uint64_t{ 0 });
  const auto last = hn::Set(d, std::uint64_t{ 63 });
  auto found = hn::Zero(d);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes)
  {
    // Where there is no bin, the one has the last bit only, and the other the first.
    const auto from = hn::Shl(all, hn::And(promoted(low + i), last));
    const auto to = hn::Shr(all, hn::Sub(last, hn::And(promoted(high + i), last)));
    found = hn::Or(found, hn::And(from, to));
  }
  HWY_ALIGN std::uint64_t words[hn::MaxLanes(Words())];
  hn::Store(found, d, words);
  ValueMask mask = 0;
  for (std::size_t lane = 0; lane < lanes; ++lane)
  {
    mask |= words[lane];
  }
  for (; i < count; ++i)
  {
    mask |= low[i] <= high[i] ? MaskOfBins(low[i], high[i]) : ValueMask{ 0 };
  }
  return mask;
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace banyan
{

HWY_EXPORT(BinFloats);
HWY_EXPORT(BinDoubles);
HWY_EXPORT(BinsBetweenHere);

void BinValues(
  const ValueRows<float>& rows, const MaskRange& over, const BinRowsOut& out, ValueRange& range)
{
  HWY_DYNAMIC_DISPATCH(BinFloats)(rows, over, out, range);
}

void BinValues(
  const ValueRows<double>& rows, const MaskRange& over, const BinRowsOut& out, ValueRange& range)
{
  HWY_DYNAMIC_DISPATCH(BinDoubles)(rows, over, out, range);
}

ValueMask BinsBetween(const std::uint8_t* low, const std::uint8_t* high, std::size_t count)
{
  return HWY_DYNAMIC_DISPATCH(BinsBetweenHere)(low, high, count);
}

} // namespace banyan
#endif
