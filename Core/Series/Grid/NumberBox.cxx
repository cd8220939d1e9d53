// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Grid/NumberBox.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Series/Grid/NumberBox.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

// A row of a brick has 17 samples, and two vectors of these.
template <class Number>
using LanesOf = hn::CappedTag<Number, 16>;

/// Calls body(first) for the vectors of a row that is at least as long as one: the last one
/// overlaps the one before, which changes nothing.
template <class Body>
HWY_INLINE void ForEachVector(int length, int lanes, const Body& body)
{
  int x = 0;
  for (; x + lanes <= length; x += lanes)
  {
    body(x);
  }
  if (x < length)
  {
    body(length - lanes);
  }
}

/// Calls body(where its first sample is) for each row, until that is false.
/// @return whether it never was
template <class Number, class Body>
HWY_INLINE bool ForEachRow(const NumberBox<Number>& box, const Body& body)
{
  for (int slice = 0; slice < box.Slices; ++slice)
  {
    for (int row = 0; row < box.Rows; ++row)
    {
      if (!body(slice * box.SliceGap + row * box.RowGap))
      {
        return false;
      }
    }
  }
  return true;
}

template <class Number>
int LengthOf(const NumberBox<Number>& box)
{
  return (box.Count - 1) * box.Stride + 1;
}

/// Whether rows are taken as vectors.
template <class Number>
bool HasVectors(const NumberBox<Number>& box)
{
  const int lanes = static_cast<int>(hn::Lanes(LanesOf<Number>()));
  return box.Stride <= 2 && lanes % 2 == 0 && LengthOf(box) >= lanes;
}

/// The samples of a vector of a row; those two apart in its even lanes, others count for nothing.
/// @param from its first lane, and @param x the place of that in the row
template <int Stride, class Number>
HWY_INLINE hn::Vec<LanesOf<Number>> SamplesOf(const Number* from, int x)
{
  const LanesOf<Number> tag;
  const auto some = hn::LoadU(tag, from);
  if constexpr (Stride == 2)
  {
    return x % 2 == 0 ? some : hn::Reverse2(tag, some); // a last vector ends with a sample
  }
  else
  {
    return some;
  }
}

template <int Stride, class Number>
void IncludeVectors(const NumberBox<Number>& box, NumberExtremes& result)
{
  const LanesOf<Number> tag;
  const int length = LengthOf(box), lanes = static_cast<int>(hn::Lanes(tag));
  auto low = hn::Set(tag, box.Numbers[0]), high = low, sum = hn::Zero(tag);
  ForEachRow(box,
    [&](std::int64_t at)
    {
      const Number* const row = box.Numbers + at;
      ForEachVector(length, lanes,
        [&](int x)
        {
          const auto some = SamplesOf<Stride>(row + x, x);
          low = hn::Min(low, some);
          high = hn::Max(high, some);
          sum = hn::Add(sum, some); // wraps
        });
      return true;
    });
  Number lows[16], highs[16], sums[16];
  hn::StoreU(low, tag, lows);
  hn::StoreU(high, tag, highs);
  hn::StoreU(sum, tag, sums);
  for (int lane = 0; lane < lanes; lane += Stride)
  {
    result.Low = std::min<std::int32_t>(result.Low, lows[lane]);
    result.High = std::max<std::int32_t>(result.High, highs[lane]);
    result.Check = 31 * result.Check + static_cast<std::uint32_t>(sums[lane]);
  }
}

template <class Number>
void IncludeBoxHere(const NumberBox<Number>& box, NumberExtremes& result)
{
  if (HasVectors(box))
  {
    return box.Stride == 1 ? IncludeVectors<1>(box, result) : IncludeVectors<2>(box, result);
  }
  ForEachRow(box,
    [&](std::int64_t at)
    {
      for (int x = 0; x < LengthOf(box); x += box.Stride)
      {
        result.Low = std::min<std::int32_t>(result.Low, box.Numbers[at + x]);
        result.High = std::max<std::int32_t>(result.High, box.Numbers[at + x]);
        result.Check = 31 * result.Check + static_cast<std::uint32_t>(box.Numbers[at + x]);
      }
      return true;
    });
}

template <int Stride, class Number>
bool SameVectors(const NumberBox<Number>& box)
{
  const LanesOf<Number> tag;
  const int length = LengthOf(box), lanes = static_cast<int>(hn::Lanes(tag));
  Number counted[16];
  for (int lane = 0; lane < lanes; ++lane)
  {
    counted[lane] = lane % Stride == 0 ? Number{ -1 } : Number{ 0 };
  }
  const auto mask = hn::LoadU(tag, counted);
  return ForEachRow(box,
    [&](std::int64_t at)
    {
      if (box.Next != nullptr)
      {
        __builtin_prefetch(box.Next + at);
      }
      auto changed = hn::Zero(tag);
      ForEachVector(length, lanes,
        [&](int x)
        {
          changed = hn::Or(changed, hn::Xor(SamplesOf<Stride>(box.Numbers + at + x, x),
                                      SamplesOf<Stride>(box.Before + at + x, x)));
        });
      return hn::AllTrue(tag, hn::Eq(hn::And(changed, mask), hn::Zero(tag)));
    });
}

template <class Number>
bool SameHere(const NumberBox<Number>& box)
{
  if (HasVectors(box))
  {
    return box.Stride == 1 ? SameVectors<1>(box) : SameVectors<2>(box);
  }
  return ForEachRow(box,
    [&](std::int64_t at)
    {
      bool same = true;
      for (int x = 0; x < LengthOf(box); x += box.Stride)
      {
        same = same && box.Numbers[at + x] == box.Before[at + x];
      }
      return same;
    });
}

void IncludeShortBox(const NumberBox<std::int16_t>& box, NumberExtremes& extremes)
{
  IncludeBoxHere(box, extremes);
}
void IncludeLongBox(const NumberBox<std::int32_t>& box, NumberExtremes& extremes)
{
  IncludeBoxHere(box, extremes);
}
bool SameShortBox(const NumberBox<std::int16_t>& box)
{
  return SameHere(box);
}
bool SameLongBox(const NumberBox<std::int32_t>& box)
{
  return SameHere(box);
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace banyan
{

HWY_EXPORT(IncludeShortBox);
HWY_EXPORT(IncludeLongBox);
HWY_EXPORT(SameShortBox);
HWY_EXPORT(SameLongBox);

template <>
void IncludeBox(const NumberBox<std::int16_t>& box, NumberExtremes& extremes)
{
  HWY_DYNAMIC_DISPATCH(IncludeShortBox)(box, extremes);
}

template <>
void IncludeBox(const NumberBox<std::int32_t>& box, NumberExtremes& extremes)
{
  HWY_DYNAMIC_DISPATCH(IncludeLongBox)(box, extremes);
}

template <>
bool SameAsBefore(const NumberBox<std::int16_t>& box)
{
  return HWY_DYNAMIC_DISPATCH(SameShortBox)(box);
}

template <>
bool SameAsBefore(const NumberBox<std::int32_t>& box)
{
  return HWY_DYNAMIC_DISPATCH(SameLongBox)(box);
}

} // namespace banyan
#endif
