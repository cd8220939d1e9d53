// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Quantize/Histogram.h"

#include "Base/Bytes.h"
#include "Base/Error.h"
#include "Base/ForEachScalarType.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

constexpr int MantissaBits = 11; // 2048 bins per power of two
constexpr int Shift = 52 - MantissaBits;
constexpr std::uint32_t PageSize = ValueHistogram::BinsPerOctave;
constexpr std::uint32_t Exponents = 2047; // those of finite doubles
constexpr std::uint32_t ZeroBin = Exponents * PageSize;
/// Zero has a page of its own, of which only the first bin is used, so that bins of other values
/// fill whole pages.
constexpr std::uint32_t FirstPositive = ZeroBin + PageSize;
constexpr std::uint32_t BinCount = FirstPositive + Exponents * PageSize;
constexpr std::uint64_t SignBit = std::uint64_t{ 1 } << 63;

/// @param value finite
std::uint32_t BinOf(double value)
{
  const std::uint64_t bits = BitCast<std::uint64_t>(value);
  const std::uint32_t magnitude = static_cast<std::uint32_t>((bits & ~SignBit) >> Shift);
  if (value == 0.0)
  {
    return ZeroBin;
  }
  return value > 0 ? FirstPositive + magnitude : ZeroBin - 1 - magnitude;
}

/// The least magnitude of a bin, and what no magnitude of it reaches.
double EdgeOf(std::uint32_t magnitude)
{
  return magnitude >= Exponents * PageSize
           ? std::numeric_limits<double>::max()
           : BitCast<double>(static_cast<std::uint64_t>(magnitude) << Shift);
}

HistogramBin EdgesOf(std::uint32_t bin)
{
  if (bin >= FirstPositive)
  {
    return { EdgeOf(bin - FirstPositive), EdgeOf(bin - FirstPositive + 1), 0 };
  }
  if (bin >= ZeroBin)
  {
    return {};
  }
  return { -EdgeOf(ZeroBin - bin), -EdgeOf(ZeroBin - 1 - bin), 0 };
}

} // namespace

ValueHistogram::ValueHistogram()
  : Pages(BinCount / PageSize)
{
}

ValueHistogram::ValueHistogram(const ValueHistogram& other)
  : ValueHistogram()
{
  this->Merge(other);
}

ValueHistogram& ValueHistogram::operator=(const ValueHistogram& other)
{
  return *this = ValueHistogram(other);
}

std::uint64_t& ValueHistogram::CountOf(std::uint32_t bin)
{
  std::unique_ptr<Page>& page = this->Pages[bin / PageSize];
  if (!page)
  {
    page = std::make_unique<Page>();
  }
  return (*page)[bin % PageSize];
}

template <class T>
void ValueHistogram::Add(const T* values, std::size_t count)
{
  // Neighbours mostly share their power of two, so the page of the value before is tried first.
  std::uint32_t current = BinCount;
  std::uint64_t* page = nullptr;
  ValueRange range;
  std::uint64_t finite = 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    const double value = static_cast<double>(values[i]);
    if (std::isfinite(value))
    {
      const std::uint32_t bin = BinOf(value);
      if (bin / PageSize != current)
      {
        current = bin / PageSize;
        page = &this->CountOf(current * PageSize);
      }
      ++page[bin % PageSize];
      ++finite;
      range.Include(value);
    }
  }
  this->Finite += finite;
  this->NonFinite += count - finite;
  this->Extremes.Include(range);
}

void ValueHistogram::Merge(const ValueHistogram& other)
{
  for (std::size_t p = 0; p < other.Pages.size(); ++p)
  {
    if (other.Pages[p])
    {
      const Page& from = *other.Pages[p];
      this->CountOf(static_cast<std::uint32_t>(p) * PageSize);
      Page& to = *this->Pages[p];
      std::transform(from.begin(), from.end(), to.begin(), to.begin(), std::plus<>());
    }
  }
  this->Finite += other.Finite;
  this->NonFinite += other.NonFinite;
  this->Extremes.Include(other.Extremes);
}

void ValueHistogram::Merge(const HistogramMessage& message)
{
  for (const HistogramEntry& entry : message.Entries)
  {
    const bool exists =
      entry.Bin < BinCount && (entry.Bin <= ZeroBin || entry.Bin >= FirstPositive);
    if (!exists)
    {
      throw Error("A histogram from another rank has a bin that does not exist",
        { {}, {}, entry.Bin, BinCount - 1 });
    }
    this->CountOf(entry.Bin) += entry.Count;
    this->Finite += entry.Count;
  }
  this->NonFinite += message.NonFinite;
  this->Extremes.Include(message.Range);
}

HistogramMessage ValueHistogram::Message() const
{
  HistogramMessage message;
  message.NonFinite = this->NonFinite;
  message.Range = this->Extremes;
  for (std::size_t p = 0; p < this->Pages.size(); ++p)
  {
    for (std::uint32_t i = 0; this->Pages[p] && i < PageSize; ++i)
    {
      const std::uint64_t count = (*this->Pages[p])[i];
      if (count > 0)
      {
        message.Entries.push_back({ static_cast<std::uint32_t>(p) * PageSize + i, count });
      }
    }
  }
  return message;
}

std::vector<HistogramBin> ValueHistogram::Bins() const
{
  std::vector<HistogramBin> bins;
  for (const HistogramEntry& entry : this->Message().Entries)
  {
    bins.push_back(EdgesOf(entry.Bin));
    bins.back().Count = entry.Count;
  }
  return bins;
}

ValueRange ValueHistogram::Percentile(double share) const
{
  if (!(share >= 0.0) || !(share <= 1.0))
  {
    throw Error("The share of a percentile must lie within 0 and 1");
  }
  if (this->Finite == 0)
  {
    throw Error("There is no percentile of no finite values");
  }
  const double exact = std::ceil(share * static_cast<double>(this->Finite));
  const std::uint64_t rank = std::max<std::uint64_t>(
    1, std::min(this->Finite, static_cast<std::uint64_t>(std::min(exact, 0x1p63))));
  if (rank == 1 || rank == this->Finite)
  {
    const double extreme = rank == 1 ? this->Extremes.Low : this->Extremes.High;
    return { extreme, extreme };
  }
  std::uint64_t below = 0;
  for (const HistogramEntry& entry : this->Message().Entries)
  {
    below += entry.Count;
    if (below >= rank)
    {
      const HistogramBin bin = EdgesOf(entry.Bin);
      return { std::max(bin.Low, this->Extremes.Low), std::min(bin.High, this->Extremes.High) };
    }
  }
  return this->Extremes; // not reached: the counts add up to Finite
}

std::uint64_t ValueHistogram::CountOutside(const ValueRange& range) const
{
  std::uint64_t outside = 0;
  if (!range.Empty())
  {
    for (const HistogramBin& bin : this->Bins())
    {
      outside += bin.High < range.Low || bin.Low > range.High ? bin.Count : 0;
    }
  }
  return outside;
}

#define BANYAN_INSTANTIATE(T) template void ValueHistogram::Add<T>(const T*, std::size_t)
BANYAN_FOR_EACH_SCALAR_TYPE(BANYAN_INSTANTIATE);
#undef BANYAN_INSTANTIATE

} // namespace banyan
