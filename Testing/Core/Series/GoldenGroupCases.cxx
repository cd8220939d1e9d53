// SPDX-License-Identifier: BSD-3-Clause
#include "Series/GoldenBuilders.h"

#include <cmath>

namespace banyan::testing
{
namespace
{

using Pattern = GoldenPattern;

/// Two groups of 8 steps and one of 3: of an array that keeps its lattice, one whose range (which
/// nobody told) differs from group to group, one that rests for some steps, and vectors with holes.
GoldenCase Groups()
{
  GoldenCase series{ "groups", At({ 2, 0, -7 }, { 18, 8, 3 }),
    Within(2, ErrorBoundMode::Absolute, 16), 19, {} };
  GoldenArray wave = Array("wave", ScalarType::Float32, Pattern::Bumps, -100, 1, -1);
  GoldenArray drift = Array("drift", ScalarType::Float32, Pattern::Bumps, 0, 1, -2);
  drift.Promised = false;
  drift.Rise = 40;
  GoldenArray rests = Array("rests", ScalarType::Int16, Pattern::Noise, 500, 1);
  rests.Bits = 5;
  rests.QuietBelow = 17;
  rests.Hold = 5;
  GoldenArray vector = Array("vector", ScalarType::Float64, Pattern::Bumps, 7, 1, -2);
  vector.Components = { "along", "across" };
  vector.NonFiniteOneIn = 400;
  vector.Hold = 2;
  series.Arrays = { wave, drift, rests, vector };
  return series;
}

/// Groups of 3 steps and one of a single step.
GoldenCase Thirds()
{
  GoldenCase series{ "thirds", At({ 0, 0, 0 }, { 17, 18, 5 }),
    Within(1.0 / 128, ErrorBoundMode::RelativeToSeriesRange, 16), 7, {} };
  series.Options.KeyframeInterval = 3;
  series.Options.Profile = EncodeProfile::Fast;
  GoldenArray counts = Array("counts", ScalarType::UInt8, Pattern::Noise);
  counts.Bits = 3;
  counts.Hold = 4;
  series.Arrays = { Array("real", ScalarType::Float32, Pattern::Bumps, 0, 3, -9), counts,
    Array("wide", ScalarType::UInt64, Pattern::Bumps, std::int64_t{ 1 } << 40, 1 << 20) };
  return series;
}

/// Every step by itself.
GoldenCase Singles()
{
  GoldenCase series{ "singles", At({ 0, 0, 0 }, { 18, 7, 5 }),
    Within(1.0 / 64, ErrorBoundMode::RelativeToSeriesRange, 16), 3, {} };
  series.Options.KeyframeInterval = 1;
  series.Arrays = { Array("real", ScalarType::Float64, Pattern::Bumps, 9, 1, 3),
    Array("count", ScalarType::Int32, Pattern::Bumps, -70000, 300) };
  return series;
}

/// Blocks of every way of prediction, in two groups of 4 of which the second refers to the first.
GoldenCase Modes()
{
  GoldenCase series{ "modes", At({ 0, 0, 0 }, { 128, 8, 8 }),
    Within(1, ErrorBoundMode::Absolute, 16), 6, {} };
  series.Options.KeyframeInterval = 4;
  series.Options.Profile = EncodeProfile::Compact;
  series.Arrays = { Array("fates", ScalarType::Float32, Pattern::Fates, -37, 1, 0) };
  return series;
}

/// Payloads of thousands of bits, large blocks, and a block that no lattice holds.
std::vector<GoldenCase> Large()
{
  GoldenArray noise = Array("noise", ScalarType::UInt8, Pattern::Noise);
  noise.Bits = 3;
  GoldenArray holes = Array("holes", ScalarType::Float32, Pattern::Bumps, 0, 1, -3);
  holes.NonFiniteOneIn = 3;
  GoldenCase dense{ "dense", At({ 0, 0, 0 }, { 17, 16, 9 }),
    Within(0.5, ErrorBoundMode::Absolute, 16), 2, { noise, holes } };
  GoldenArray smooth = Array("smooth", ScalarType::Float32, Pattern::Bumps, 1, 1, -4);
  smooth.QuietBelow = 7;
  smooth.NonFiniteOneIn = 2000;
  GoldenCase wide{ "wide", At({ 1, 0, 0 }, { 37, 33, 3 }),
    Within(1.0 / 32, ErrorBoundMode::RelativeToSeriesRange, 32), 3, { smooth } };
  GoldenArray thin = smooth;
  thin.Type = ScalarType::UInt16;
  thin.NonFiniteOneIn = 0;
  GoldenCase wider{ "wider", At({ 0, 0, 0 }, { 67, 3, 2 }),
    Within(1.0 / 64, ErrorBoundMode::RelativeToSeriesRange, 32), 2, { thin } };
  GoldenArray random = Array("random", ScalarType::UInt32, Pattern::Noise);
  random.Bits = 32;
  GoldenCase full{ "full", At({ 0, 0, 0 }, { 16, 16, 16 }),
    Within(0, ErrorBoundMode::RelativeToSeriesRange, 16), 1, { random } };
  return { dense, wide, wider, full };
}

QuantizerOptions AsinhOf(double scale)
{
  QuantizerOptions quantizer;
  quantizer.Map = TransformChoice::Asinh;
  quantizer.AsinhScale = scale;
  return quantizer;
}

/// Whatever a quantizer can be told, one array each.
GoldenCase Quantizers()
{
  GoldenCase series{ "quantizers", At({ 0, 3, 0 }, { 9, 7, 4 }),
    Within(1.0 / 128, ErrorBoundMode::RelativeToSeriesRange, 16), 5, {} };
  series.Options.KeyframeInterval = 2;
  auto& told = series.Options.QuantizerOfArray;
  const auto add = [&](const std::string& name, ScalarType type, std::int64_t low, int exponent)
  {
    GoldenArray array = Array(name, type, Pattern::Bumps, low, 1, exponent);
    array.Hold = 2;
    series.Arrays.push_back(array);
  };
  add("asinh", ScalarType::Float64, -90, -3);
  told["asinh"] = AsinhOf(0.75);
  add("asinh by itself", ScalarType::Float32, -300, 12);
  told["asinh by itself"] = AsinhOf(0);
  add("table", ScalarType::Int16, -50, 0);
  told["table"].Map = TransformChoice::Table;
  told["table"].Knots = { { -60, -200 }, { 100, 0 }, { 150, 10 }, { 800, 500 } };
  add("adaptive", ScalarType::Float32, 3, -5);
  told["adaptive"].Map = TransformChoice::Adaptive;
  told["adaptive"].Adaptive.Cells = 16;
  add("opacity", ScalarType::Float32, 0, -2);
  told["opacity"].Opacity = { { 250, 0 }, { 270, 1 }, { 350, 0.25 }, { 370, 0 } };
  series.Arrays.back().Rise = 400; // nothing is visible at first
  add("clamped", ScalarType::Float32, -10, -1);
  told["clamped"].Range.From = RangeRule::Source::Given;
  told["clamped"].Range.Given = ValueRange{ 50, 250 };
  told["clamped"].Range.ClampOutside = true;
  add("fill", ScalarType::UInt16, 40, 0);
  told["fill"].FillValues = { 65535, 7 };
  series.Arrays.back().SpecialOneIn = 23;
  series.Arrays.back().Special = 65535;
  add("outliers", ScalarType::Float64, 0, -4);
  told["outliers"].Range.From = RangeRule::Source::Percentiles;
  told["outliers"].Range.LowShare = 0.02;
  told["outliers"].Range.HighShare = 0.97;
  series.Arrays.back().SpecialOneIn = 90;
  series.Arrays.back().Special = -1e9;
  return series;
}

} // namespace

std::vector<GoldenCase> GoldenGroupCases()
{
  std::vector<GoldenCase> cases = { Groups(), Thirds(), Singles(), Modes(), Quantizers() };
  for (const GoldenCase& large : Large())
  {
    cases.push_back(large);
  }
  return cases;
}

} // namespace banyan::testing
