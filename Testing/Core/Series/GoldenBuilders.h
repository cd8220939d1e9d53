// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_GoldenBuilders_h
#define banyan_Testing_GoldenBuilders_h

#include "Series/GoldenCases.h"

/// Short words that lists of golden cases are made of.
namespace banyan::testing
{

inline Grid At(const glm::ivec3& low, const glm::ivec3& samples)
{
  Grid grid;
  grid.Extent = { low, low + samples };
  return grid;
}

inline EncodeOptions Within(double bound, ErrorBoundMode mode, int brickCells)
{
  EncodeOptions options;
  options.ErrorBound = bound;
  options.Mode = mode;
  options.BrickCells = brickCells;
  return options;
}

inline GoldenArray Array(const std::string& name, ScalarType type, GoldenPattern pattern,
  std::int64_t low = 0, std::int64_t factor = 1, int exponent = 0)
{
  GoldenArray array;
  array.Name = name;
  array.Type = type;
  array.Pattern = pattern;
  array.Low = low;
  array.Factor = factor;
  array.Exponent = exponent;
  return array;
}

} // namespace banyan::testing

#endif
