#include "Series/NumberBox.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Series/NumberBox.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Extremes of lanes. Of samples two apart only those in even lanes count.
template <class Number>
struct Extremes
{
  // A row of a brick has 17 samples, and two vectors of these.
  using Tag = hn::CappedTag<Number, 16>;
  using Vector = hn::Vec<Tag>;
  Vector Low, High, Changed;

  HWY_INLINE void Include(Vector now, Vector before)
  {
    this->Low = hn::Min(this->Low, now);
    this->High = hn::Max(this->High, now);
    this->Changed = hn::Or(this->Changed, hn::Xor(now, before));
  }
};

/// A row that is at least as long as a vector: its last vector overlaps the one before, which
/// changes nothing.
template <int Stride, class Number>
HWY_INLINE void IncludeRow(
  const Number* now, const Number* before, int length, Extremes<Number>& extremes)
{
  const typename Extremes<Number>::Tag tag;
  const int lanes = static_cast<int>(hn::Lanes(tag));
  for (int x = 0; x + lanes <= length; x += lanes)
  {
    extremes.Include(hn::LoadU(tag, now + x), hn::LoadU(tag, before + x));
  }
  const int last = length - lanes;
  if (last % lanes == 0)
  {
    return;
  }
  auto lastNow = hn::LoadU(tag, now + last), lastBefore = hn::LoadU(tag, before + last);
  if constexpr (Stride == 2) // the length is odd: the samples lie in odd lanes
  {
    lastNow = hn::Reverse2(tag, lastNow);
    lastBefore = hn::Reverse2(tag, lastBefore);
  }
  extremes.Include(lastNow, lastBefore);
}

template <class Number, class Body>
HWY_INLINE void ForEachRow(const NumberBox<Number>& box, const Body& body)
{
  for (int slice = 0; slice < box.Slices; ++slice)
  {
    for (int row = 0; row < box.Rows; ++row)
    {
      const std::int64_t at = slice * box.SliceGap + row * box.RowGap;
      if (box.Next != nullptr)
      {
        __builtin_prefetch(box.Next + at);
      }
      body(box.Numbers + at, box.Before + at);
    }
  }
}

template <int Stride, class Number>
void IncludeVectors(const NumberBox<Number>& box, int length, NumberExtremes& result)
{
  const typename Extremes<Number>::Tag tag;
  const auto first = hn::Set(tag, box.Numbers[0]);
  Extremes<Number> extremes{ first, first, hn::Zero(tag) };
  ForEachRow(box, [&](const Number* now, const Number* before)
    { IncludeRow<Stride>(now, before, length, extremes); });
  Number low[16], high[16], changed[16];
  hn::StoreU(extremes.Low, tag, low);
  hn::StoreU(extremes.High, tag, high);
  hn::StoreU(extremes.Changed, tag, changed);
  for (std::size_t lane = 0; lane < hn::Lanes(tag); lane += Stride)
  {
    result.Low = std::min<std::int32_t>(result.Low, low[lane]);
    result.High = std::max<std::int32_t>(result.High, high[lane]);
    result.AsBefore = result.AsBefore && changed[lane] == 0;
  }
}

template <class Number>
void IncludeBoxHere(const NumberBox<Number>& box, NumberExtremes& result)
{
  const int length = (box.Count - 1) * box.Stride + 1;
  const int lanes = static_cast<int>(hn::Lanes(typename Extremes<Number>::Tag()));
  if (box.Stride <= 2 && lanes % 2 == 0 && length >= lanes)
  {
    return box.Stride == 1 ? IncludeVectors<1>(box, length, result)
                           : IncludeVectors<2>(box, length, result);
  }
  ForEachRow(box,
    [&](const Number* now, const Number* before)
    {
      for (int x = 0; x < length; x += box.Stride)
      {
        result.Low = std::min<std::int32_t>(result.Low, now[x]);
        result.High = std::max<std::int32_t>(result.High, now[x]);
        result.AsBefore = result.AsBefore && now[x] == before[x];
      }
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

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace banyan
{

HWY_EXPORT(IncludeShortBox);
HWY_EXPORT(IncludeLongBox);

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

} // namespace banyan
#endif
