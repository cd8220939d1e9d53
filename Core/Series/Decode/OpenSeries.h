// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Decode_OpenSeries_h
#define banyan_Series_Decode_OpenSeries_h

#include "Base/Error.h"
#include "Series/Decode/CacheContext.h"
#include "Series/Decode/SeriesFile.h"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace banyan
{

/// The index of a series and what follows from it, as all parts of the reader need it.
struct OpenSeries
{
  std::string Path;
  std::string Folder; ///< of the segments
  SeriesIndex Index;
  std::uint64_t Id = 0;
  std::shared_ptr<CacheContext> Caches;
  std::vector<BrickLayout> Layouts;           ///< by level
  std::vector<std::uint32_t> FirstComponents; ///< number of components before each array
  std::uint32_t Components = 0;               ///< of all arrays

  std::uint32_t ComponentOf(const FieldKey& field) const
  {
    return this->FirstComponents[static_cast<std::size_t>(field.Array)] +
           static_cast<std::uint32_t>(field.Component);
  }
  MaskRange MaskRangeOf(int array, int component) const;
};

/// Returns the samples of a part that brick k of a row writes.
inline Box RowPart(const BrickLayout& layout, std::int64_t first, int count, int k, const Box& part)
{
  const Box samples = layout.SamplesOf(first + k);
  Box result = part;
  result.Lo.x = std::max(part.Lo.x, samples.Lo.x);
  result.Hi.x = k + 1 < count ? std::min(part.Hi.x, samples.Hi.x - 1) : part.Hi.x;
  return result;
}

/// Runs `body`; an Error without a place gets the file and offset at hand.
template <class Body>
decltype(auto) WithErrorPlace(const std::string& path, std::uint64_t offset, Body&& body)
{
  try
  {
    return body();
  }
  catch (const Error& failure)
  {
    if (!failure.Place().File.empty())
    {
      throw;
    }
    throw Error(failure.what(), { path, offset });
  }
}

} // namespace banyan

#endif
