// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_FieldReader_h
#define banyan_Series_FieldReader_h

#include "Series/SeriesFile.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace banyan
{

/// What SeriesFile needs of a format version. Arguments are checked before they come here. All
/// methods may be called from any thread.
class FieldReader
{
public:
  virtual ~FieldReader() = default;

  /// See SeriesFile.
  virtual std::shared_ptr<const std::vector<BrickNode>> Nodes(const FieldKey& field) = 0;
  virtual void DecodeBrick(const FieldKey& field, std::int64_t brick, void* values) = 0;
  /// As SeriesFile::DecodePart. @return false when the caller has to decode the whole brick instead
  virtual bool DecodePart(const FieldKey&, std::int64_t, const Box&, const glm::i64vec3&, void*)
  {
    return false;
  }
  /// As SeriesFile::DecodeRow, of several bricks. @return false when the caller has to decode them
  /// one by one
  virtual bool DecodeRow(const FieldKey&, std::int64_t, int, const Box&, const glm::i64vec3&, void*)
  {
    return false;
  }
  /// See SeriesFile.
  virtual double StepOfValues(const FieldKey&) { return 0.0; }
  /// Decodes some bricks at the end of the grid as well. Checksums do not tell that an index and
  /// its segments do not belong together, such as an index with another extent.
  virtual void VerifyBricks(const FieldKey& field, const std::vector<std::int64_t>& bricks) = 0;
  virtual std::uint64_t BytesRead() const = 0;
  virtual std::uint64_t BricksDecoded() const = 0;
};

/// What readers of all versions share.
struct OpenSeries
{
  std::string Path;
  std::string Folder; ///< of the segments
  SeriesIndex Index;
  std::uint64_t Id = 0;
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

/// What brick k of a row writes of a part.
inline Box RowPart(const BrickLayout& layout, std::int64_t first, int count, int k, const Box& part)
{
  const Box samples = layout.SamplesOf(first + k);
  Box result = part;
  result.Lo.x = std::max(part.Lo.x, samples.Lo.x);
  result.Hi.x = k + 1 < count ? std::min(part.Hi.x, samples.Hi.x - 1) : part.Hi.x;
  return result;
}

/// Readers of the two versions. Segments are opened at once, so that replacing the series does not
/// take them away from readers (see SegmentFile). Throw Error.
std::unique_ptr<FieldReader> MakeFieldReader1(const OpenSeries& series);
std::unique_ptr<FieldReader> MakeFieldReader2(const OpenSeries& series);

/// Segments that are looked at when a series is opened: the rest of a very long one waits.
constexpr std::size_t OpenedAtOnce = 16384;

constexpr std::size_t KeptTables = 64;
constexpr std::uint64_t KeptTableBytes = std::uint64_t{ 128 } << 20;

/// Runs `body`; an Error without a place gets the file and offset at hand.
template <class Body>
decltype(auto) InFile(const std::string& path, std::uint64_t offset, Body&& body)
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
