// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Decode_BrickDecoding_h
#define banyan_Series_Decode_BrickDecoding_h

#include "Series/Decode/OpenGroup.h"

namespace banyan
{

/// Decodes a brick as SeriesFile::DecodeBrick does.
/// @return false when there was nothing to decode: all samples are one value
bool DecodeWhole(const OpenSeries& series, OpenGroup& open, const FieldKey& field,
  std::int64_t brick, void* values);

/// Decodes a part of a brick as SeriesFile::DecodePart does, where that is simple: no exceptions,
/// all samples in one box of the codec.
/// @return false when it is not; nothing was written then
bool DecodePart(const OpenSeries& series, OpenGroup& open, const FieldKey& field,
  std::int64_t brick, const Box& part, const glm::i64vec3& stride, void* first);

/// Bricks that follow each other along x.
struct BrickRow
{
  std::int64_t First;
  int Count;
};

/// The same of a row of bricks, as SeriesFile::DecodeRow does.
bool DecodeSomeRow(const OpenSeries& series, OpenGroup& open, const FieldKey& field,
  const BrickRow& row, const Box& part, const glm::i64vec3& stride, void* first);

} // namespace banyan

#endif
