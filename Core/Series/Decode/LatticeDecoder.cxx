// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Decode/LatticeDecoder.h"

#include "Base/Error.h"
#include "Base/ForEachScalarType.h"

#include <algorithm>
#include <cmath>

namespace banyan
{

template <class T>
LatticeDecoder<T>::LatticeDecoder(
  const Transform& transform, double origin, double step, std::int64_t first, std::int64_t last)
  : Map(transform)
  , Origin(origin)
  , Step(step)
  , First(first)
{
  if (!std::isfinite(origin) || !std::isfinite(step) || !(step > 0))
  {
    throw Error(
      "The quantizer of a transformed component has no finite origin or no positive step");
  }
  // Unsigned, because the difference of two 64-bit numbers may overflow.
  const std::uint64_t span = static_cast<std::uint64_t>(last) - static_cast<std::uint64_t>(first);
  if (first <= last && span < static_cast<std::uint64_t>(GreatestTable))
  {
    const std::size_t entries = static_cast<std::size_t>(span) + 1;
    std::vector<double> y(entries);
    for (std::size_t i = 0; i < entries; ++i)
    {
      const std::int64_t number = first + static_cast<std::int64_t>(i);
      y[i] = this->Origin + static_cast<double>(number) * this->Step;
    }
    this->Table.resize(entries);
    this->Map.InverseValues(y.data(), entries, this->Table.data());
  }
}

template <class T>
T LatticeDecoder<T>::Compute(std::int64_t number) const
{
  return ValueFromReal<T>(
    this->Map.Inverse(this->Origin + static_cast<double>(number) * this->Step));
}

template <class T>
T LatticeDecoder<T>::ValueOf(std::int64_t number) const
{
  const std::uint64_t entry =
    static_cast<std::uint64_t>(number) - static_cast<std::uint64_t>(this->First);
  return entry < this->Table.size() ? this->Table[entry] : this->Compute(number);
}

template <class T>
void LatticeDecoder<T>::Decode(
  std::int64_t base, const std::uint32_t* offsets, std::size_t count, T* decoded) const
{
  if (this->Table.empty())
  {
    constexpr std::size_t chunk = 512;
    double y[chunk];
    for (std::size_t start = 0; start < count; start += chunk)
    {
      const std::size_t some = std::min(chunk, count - start);
      for (std::size_t i = 0; i < some; ++i)
      {
        const auto number =
          static_cast<std::int64_t>(static_cast<std::uint64_t>(base) + offsets[start + i]);
        y[i] = this->Origin + static_cast<double>(number) * this->Step;
      }
      this->Map.InverseValues(y, some, decoded + start);
    }
    return;
  }
  const std::uint64_t first =
    static_cast<std::uint64_t>(base) - static_cast<std::uint64_t>(this->First);
  const std::uint64_t entries = this->Table.size();
  for (std::size_t i = 0; i < count; ++i)
  {
    const std::uint64_t entry = first + offsets[i];
    decoded[i] =
      entry < entries
        ? this->Table[entry]
        : this->Compute(static_cast<std::int64_t>(static_cast<std::uint64_t>(base) + offsets[i]));
  }
}

#define BANYAN_INSTANTIATE(T) template class LatticeDecoder<T>
BANYAN_FOR_EACH_SCALAR_TYPE(BANYAN_INSTANTIATE);
#undef BANYAN_INSTANTIATE

} // namespace banyan
