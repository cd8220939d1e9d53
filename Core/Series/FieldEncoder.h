#ifndef banyan_Series_FieldEncoder_h
#define banyan_Series_FieldEncoder_h

#include "Series/BrickCodec.h"
#include "Series/BrickStatistics.h"
#include "Series/Grid.h"
#include "Series/SeriesFile.h"

#include <functional>
#include <vector>

namespace banyan
{

class ThreadPool;

/// One component of one array at one step, at one level.
struct FieldToEncode
{
  ScalarType Type = ScalarType::Float32;
  const void* Values = nullptr; ///< of the finest level, first component of the first tuple
  int Components = 1;           ///< per tuple
  int Component = 0;
  glm::ivec3 FineSamples{ 1 };
  BrickLayout Layout; ///< of the level to encode
  Quantizer Lattice;
  MaskRange Masks;
  int CompressionLevel = 3;
};

/// What comes out for one brick.
struct FieldBrick
{
  EncodedBrick Code;
  BrickNode Node; ///< PayloadBytes set
  BrickError Error;
};

/// Encodes bricks [first, first + bricks.size()) of a field in parallel. The result does not depend
/// on the number of threads.
void EncodeBricks(const FieldToEncode& field, std::int64_t first, std::vector<FieldBrick>& bricks,
  ThreadPool& pool);

/// Extremes of the finite values of a component, outward for 64-bit integers.
/// @param values `[tuples][components]`
ValueRange RangeOfComponent(ScalarType type, const void* values, std::int64_t tuples,
  int components, int component, ThreadPool& pool);

} // namespace banyan

#endif
