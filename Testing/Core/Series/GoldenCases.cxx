// SPDX-License-Identifier: BSD-3-Clause
#include "Series/GoldenBuilders.h"

namespace banyan::testing
{
namespace
{

using Pattern = GoldenPattern;

/// Every scalar type on a lattice, by an absolute bound.
GoldenCase Types()
{
  GoldenCase series{ "types", At({ 0, 0, 0 }, { 19, 4, 3 }),
    Within(2.5, ErrorBoundMode::Absolute, 16), 1, {} };
  for (int type = 0; type < 10; ++type)
  {
    const ScalarType scalar = static_cast<ScalarType>(type);
    GoldenArray array = Array(NameOf(scalar), scalar, Pattern::Bumps, -40, 1, -1);
    array.Promised = type % 3 != 0;
    array.Seed = static_cast<unsigned>(type);
    array.Factor = SizeOf(scalar) > 1 ? 40 : 1;
    series.Arrays.push_back(array);
  }
  return series;
}

/// Bit-exact, with numbers as wide as the types and as odd as they come.
GoldenCase Exact()
{
  GoldenCase series{ "exact", At({ 3, -2, 5 }, { 9, 4, 3 }),
    Within(0.0, ErrorBoundMode::RelativeToSeriesRange, 16), 1, {} };
  series.Arrays = {
    Array("not a double", ScalarType::Int64, Pattern::Constant, (std::int64_t{ 1 } << 53) + 1),
    Array("wide", ScalarType::UInt64, Pattern::Noise),
    Array("31 bits", ScalarType::Int64, Pattern::Noise, -(std::int64_t{ 1 } << 40)),
    Array("32 bits", ScalarType::UInt32, Pattern::Noise),
    Array("16 bits", ScalarType::Int16, Pattern::Noise),
    Array("smooth", ScalarType::Int16, Pattern::Bumps, -300, 3),
    Array("real", ScalarType::Float64, Pattern::Bumps, 1, 3, -20),
    Array("small", ScalarType::Float32, Pattern::Noise, -(1 << 18), 1, -149),
    Array("large", ScalarType::Float64, Pattern::Noise, -(std::int64_t{ 1 } << 52), 1, 970),
    Array("holes", ScalarType::Float32, Pattern::Noise, 0, 1, -3),
    Array("nothing finite", ScalarType::Float64, Pattern::Constant),
  };
  const int bits[] = { 0, 64, 31, 32, 16, 0, 0, 19, 53, 24, 0 };
  for (std::size_t i = 0; i < series.Arrays.size(); ++i)
  {
    series.Arrays[i].Bits = bits[i];
    series.Arrays[i].Promised = i % 2 == 0;
  }
  series.Arrays[9].NonFiniteOneIn = 9;
  series.Arrays[10].NonFiniteOneIn = 1;
  return series;
}

/// Steps and segments, vectors, a domain that is neither at the origin nor along the axes; bricks
/// that stay, that are one value, and that two arrays share.
GoldenCase Moving()
{
  GoldenCase series{ "moving", At({ -4, 7, 2 }, { 33, 6, 5 }),
    Within(1.0 / 256, ErrorBoundMode::RelativeToSeriesRange, 16), 5, {} };
  series.Options.KeyframeInterval = 2;
  series.Options.CompressionLevel = 19;
  series.Domain.Origin = { -1.25, 1e6, 3.0 };
  series.Domain.Spacing = { 0.5, 0.125, 3.0 };
  series.Domain.Direction =
    glm::dmat3(glm::dvec3(0, 1, 0), glm::dvec3(-0.6, 0, 0.8), glm::dvec3(0.8, 0, 0.6));
  GoldenArray scalar = Array("temperature", ScalarType::Float32, Pattern::Bumps, 4096, 7, -4);
  scalar.QuietBelow = 17;
  scalar.Hold = 2;
  GoldenArray twin = scalar;
  twin.Name = "twin";
  GoldenArray vector = Array("velocity", ScalarType::Float32, Pattern::Bumps, -300, 1, -6);
  vector.Components = { "x", "y", "z" };
  vector.QuietBelow = 17;
  vector.Hold = 4;
  vector.NonFiniteOneIn = 700;
  series.Arrays = { scalar, vector, twin };
  return series;
}

/// Codes of every width that zstd makes smaller, and three levels of bricks of 16.
GoldenCase Packed()
{
  GoldenCase series{ "packed", At({ 0, 0, 0 }, { 34, 8, 2 }),
    Within(0.5, ErrorBoundMode::Absolute, 16), 1, {} };
  series.Arrays = {
    Array("picks 1", ScalarType::Float32, Pattern::Picks, 5, 40),
    Array("picks 2", ScalarType::Float32, Pattern::Picks, -1000, 10007),
    Array("picks 4", ScalarType::Float64, Pattern::Picks, 77, 1 << 24),
    Array("smooth 1", ScalarType::UInt8, Pattern::Bumps, 3, 1, 0),
    Array("smooth 2", ScalarType::Float32, Pattern::Bumps, 0, 20, 0),
    Array("smooth 4", ScalarType::Float64, Pattern::Bumps, -9, 1 << 16, 0),
  };
  series.Arrays[3].QuietBelow = 20;
  series.Arrays[3].Low = 3;
  return series;
}

/// So few samples that zstd cannot make them smaller: codes of every width as they are.
GoldenCase Tiny()
{
  GoldenCase series{ "tiny", At({ 1, 1, 1 }, { 3, 2, 2 }),
    Within(0.5, ErrorBoundMode::Absolute, 16), 1, {} };
  series.Arrays = {
    Array("picks 1", ScalarType::Float64, Pattern::Picks, 5, 40),
    Array("picks 2", ScalarType::Float64, Pattern::Picks, -1000, 10007),
    Array("picks 4", ScalarType::Float64, Pattern::Picks, 77, 0x01020305),
    Array("smooth 1", ScalarType::Float64, Pattern::Bumps, 0, 1, -3),
    Array("smooth 2", ScalarType::Float64, Pattern::Bumps, 0, 20, 0),
    Array("smooth 4", ScalarType::Float64, Pattern::Bumps, 0, 1 << 20, 0),
    Array("noise 4", ScalarType::Float64, Pattern::Noise, 0, 1, 0),
  };
  series.Arrays[6].Bits = 30;
  return series;
}

/// Axes without cells.
std::vector<GoldenCase> Flat()
{
  const EncodeOptions options = Within(1.0 / 64, ErrorBoundMode::RelativeToSeriesRange, 16);
  GoldenArray plane = Array("plane", ScalarType::UInt16, Pattern::Bumps, 1000, 5);
  GoldenArray line = Array("line", ScalarType::Float32, Pattern::Bumps, 0, 1, -5);
  line.NonFiniteOneIn = 13;
  GoldenArray point = Array("point", ScalarType::Float32, Pattern::Bumps, 12345, 1, -7);
  GoldenArray hole = Array("hole", ScalarType::Float32, Pattern::Constant);
  hole.NonFiniteOneIn = 1;
  return { { "flat", At({ 0, 9, 0 }, { 34, 1, 18 }), options, 1, { plane } },
    { "line", At({ 0, 0, -3 }, { 1, 1, 67 }), options, 2, { line } },
    { "point", At({ 5, 5, 5 }, { 1, 1, 1 }), options, 2, { point, hole } } };
}

} // namespace

std::vector<GoldenCase> GoldenCases()
{
  std::vector<GoldenCase> cases = { Types(), Exact(), Moving(), Packed(), Tiny() };
  for (const GoldenCase& flat : Flat())
  {
    cases.push_back(flat);
  }
  for (const auto& more : { GoldenGroupCases(), GoldenFeatureCases() })
  {
    cases.insert(cases.end(), more.begin(), more.end());
  }
  return cases;
}

} // namespace banyan::testing
