// SPDX-License-Identifier: BSD-3-Clause
#include "ZfpSeries.h"

#include "Deviation.h"

#include "Base/Error.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace banyan::bench
{
namespace
{

class ZfpEncoded : public EncodedSeries
{
public:
  ZfpEncoded(const RawSeries& series, double tolerance, bool exact)
    : Line(ZfpCoder::IsLine(series.Samples()))
    , Coder(series.Samples(), tolerance, exact)
  {
    for (int step = 0; step < series.Steps(); ++step)
    {
      this->Steps.push_back(this->Coder.Encode(series.Step(step)));
    }
  }

  std::uint64_t Bytes() const override
  {
    std::uint64_t bytes = 0;
    for (const ZfpStep& step : this->Steps)
    {
      bytes += step.Bytes();
    }
    return bytes;
  }

  void DecodeStep(int step, float* values) override
  {
    this->Coder.Decode(this->Steps[static_cast<std::size_t>(step)], values);
  }

  bool DecodesBricks() const override { return !this->Line; }

  void DecodeBrick(int step, const Box& samples, float* values) override
  {
    this->Coder.DecodeBrick(this->Steps[static_cast<std::size_t>(step)], samples, values);
  }

private:
  bool Line;
  ZfpCoder Coder;
  std::vector<ZfpStep> Steps;
};

/// Accuracy mode with the error bound as the tolerance. Its real errors are several times smaller.
class ZfpMethod : public CodecMethod
{
public:
  using CodecMethod::CodecMethod;

  std::unique_ptr<EncodedSeries> Encode(
    const RawSeries& series, const CodecSettings& settings) const override
  {
    return std::make_unique<ZfpEncoded>(series, settings.ErrorBound, false);
  }
};

/// Accuracy mode with the largest tolerance whose measured error still meets the bound.
class ZfpTunedMethod : public CodecMethod
{
public:
  using CodecMethod::CodecMethod;

  /// Bisects on a few steps, checks all, and takes the worst one in when it breaks the bound.
  void Prepare(const RawSeries& series, const CodecSettings& settings) override
  {
    const double bound = settings.ErrorBound;
    this->Tolerance = bound;
    if (!(bound > 0))
    {
      return;
    }
    std::vector<int> some;
    constexpr int stepsToBeginWith = 4;
    for (int i = 0; i < stepsToBeginWith; ++i)
    {
      some.push_back((2 * i + 1) * series.Steps() / (2 * stepsToBeginWith));
    }
    for (int attempt = 0; attempt < series.Steps(); ++attempt)
    {
      const double tolerance = Bisect(series, some, bound);
      const auto [error, step] = WorstStep(series, tolerance);
      if (error <= bound)
      {
        this->Tolerance = tolerance;
        return;
      }
      some.push_back(step);
    }
  }

  std::unique_ptr<EncodedSeries> Encode(
    const RawSeries& series, const CodecSettings&) const override
  {
    return std::make_unique<ZfpEncoded>(series, this->Tolerance, true);
  }

private:
  static double LargestError(
    const RawSeries& series, const std::vector<int>& steps, double tolerance)
  {
    ZfpCoder coder(series.Samples(), tolerance, true);
    std::vector<float> decoded(series.VoxelsPerStep());
    Deviation deviation;
    for (const int step : steps)
    {
      coder.Decode(coder.Encode(series.Step(step)), decoded.data());
      deviation.Include(series.Step(step), decoded.data(), decoded.size());
    }
    return deviation.Largest();
  }

  static double Bisect(const RawSeries& series, const std::vector<int>& steps, double bound)
  {
    // zfp's transform keeps errors below the tolerance, by a factor that never came near 64.
    double good = std::log2(bound);
    double bad = good + 6;
    constexpr double closeEnough = 0.005; // of a bit
    while (bad - good > closeEnough)
    {
      const double middle = 0.5 * (good + bad);
      (LargestError(series, steps, std::exp2(middle)) <= bound ? good : bad) = middle;
    }
    return std::exp2(good);
  }

  static std::pair<double, int> WorstStep(const RawSeries& series, double tolerance)
  {
    std::pair<double, int> worst(0.0, 0);
    for (int step = 0; step < series.Steps(); ++step)
    {
      worst = std::max(worst, { LargestError(series, { step }, tolerance), step });
    }
    return worst;
  }

  double Tolerance = 0;
};

} // namespace

void AppendZfpMethods(MethodList& methods)
{
  methods.push_back(std::make_unique<ZfpMethod>("zfp"));
  methods.push_back(std::make_unique<ZfpTunedMethod>("zfp-tuned"));
}

} // namespace banyan::bench
