// SPDX-License-Identifier: BSD-3-Clause
// What random bricks are measured with.
#include "Measure.h"

#include "Series/Decode/CacheContext.h"
#include "Series/SeriesTesting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace
{

using namespace banyan;
using namespace banyan::bench;
using banyan::testing::TemporaryFolder;

/// Notes what is kept before each brick.
class Forgetful : public CodecMethod
{
public:
  using CodecMethod::CodecMethod;

  struct Call
  {
    bool Decodes = false;
    Decoded Kept = Decoded::All;
  };

  std::unique_ptr<EncodedSeries> Encode(
    const RawSeries& series, const CodecSettings&) const override
  {
    class Notes : public EncodedSeries
    {
    public:
      Notes(const RawSeries& series, std::vector<Call>& calls)
        : Series(series)
        , Calls(calls)
      {
      }
      std::uint64_t Bytes() const override { return 1; }
      void DecodeStep(int step, float* values) override
      {
        std::copy_n(this->Series.Step(step), this->Series.VoxelsPerStep(), values);
      }
      bool DecodesBricks() const override { return true; }
      bool KeepsDecoded() const override { return true; }
      void Keep(Decoded what) override { this->Calls.push_back({ false, what }); }
      void DecodeBrick(int step, const Box&, float* values) override
      {
        this->Calls.push_back({ true });
        this->DecodeStep(step, values);
      }
      const RawSeries& Series;
      std::vector<Call>& Calls;
    };
    return std::make_unique<Notes>(series, this->Calls);
  }

  mutable std::vector<Call> Calls;
};

TEST(RandomBricks, NothingIsDecodedBeforeARandomBrick)
{
  const TemporaryFolder folder;
  const RawSeries series("step", { 4, 4, 4 }, std::vector<float>(128, 4.0f));
  Forgetful method("forgetful");
  MeasureOptions options;
  options.WorkFolder = folder.Path();
  options.Bricks = 5;
  options.Repeat = 2;
  const Measurement measurement = Measure(method, series, 8, options);
  EXPECT_TRUE(measurement.RandomBrickMicroseconds && measurement.FinestBrickMicroseconds &&
              measurement.KeptBrickMicroseconds);
  std::map<Decoded, int> before;
  for (std::size_t i = 1; i < method.Calls.size(); ++i)
  {
    if (method.Calls[i].Decodes && !method.Calls[i - 1].Decodes)
    {
      ++before[method.Calls[i - 1].Kept];
    }
  }
  // Three passes each, the first of them untimed. Bricks that are kept begin with nothing, once.
  EXPECT_EQ(
    before, (std::map<Decoded, int>{ { Decoded::Nothing, 16 }, { Decoded::CoarserPlanes, 15 } }));
}

TEST(RandomBricks, OursForgetWhatWasDecoded)
{
  const TemporaryFolder folder;
  const glm::ivec3 samples(40);
  std::vector<float> values(40 * 40 * 40);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    values[i] = std::sin(0.7f * static_cast<float>(i % 40) + 0.01f * static_cast<float>(i / 40));
  }
  const RawSeries series("waves", samples, values);
  MethodList methods;
  AppendBanyanMethods(methods);
  const auto encoded = methods[0]->Encode(series, { 8, ErrorBoundFor(series, 8), folder.Path() });
  ASSERT_TRUE(encoded->KeepsDecoded());
  const QuantizedBlockCache& cache = CacheContext::Process()->Blocks();
  std::vector<float> brick(16 * 16 * 16);
  encoded->DecodeBrick(0, { glm::ivec3(0), glm::ivec3(16) }, brick.data());
  const std::uint64_t all = cache.Bytes();
  encoded->Keep(Decoded::All);
  EXPECT_EQ(cache.Bytes(), all);
  encoded->Keep(Decoded::CoarserPlanes);
  const std::uint64_t coarser = cache.Bytes();
  EXPECT_LT(coarser, all);
  EXPECT_GT(coarser, 0u);
  encoded->Keep(Decoded::Nothing);
  EXPECT_EQ(cache.Bytes(), 0u);
}

} // namespace
