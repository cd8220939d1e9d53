// SPDX-License-Identifier: BSD-3-Clause
// Colours of encoded series: those of the components, at all levels.
#include "Base/Error.h"
#include "Cache/BrickCache.h"
#include "Render/Bricks/SampledBox.h"
#include "Render/Bricks/SeriesBrickSource.h"
#include "Render/ColouredFields.h"
#include "Render/Steps/StepSource.h"
#include "Series/SeriesTesting.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace coloured;

const glm::ivec3 N{ 45, 38, 41 };
const glm::ivec2 Picture{ 61, 50 };
constexpr TemporalEnhancement None{ 0.0, 1.0, 0.0 };

/// A series of one step of colours without loss.
class EncodedColours : public ::testing::Test
{
protected:
  template <class T>
  std::shared_ptr<const SeriesFile> Encode(const std::vector<T>& values, int components)
  {
    const std::string path = this->Folder / ("colours" + std::to_string(this->Files++) + ".banyan");
    EncodeOptions options;
    options.ErrorBound = 0.0;
    options.Mode = ErrorBoundMode::Absolute;
    options.BrickCells = 16;
    const std::vector<std::string> names(static_cast<std::size_t>(components), "");
    SeriesEncoder encoder(path, banyan::testing::GridOf(N.x, N.y, N.z),
      { { "colours", ScalarTypeOf<T>(), names, {} } }, options, this->Pool);
    encoder.AddStep(0.0, { { values.data() } });
    encoder.Finish();
    return SeriesFile::Open(path);
  }

  /// Every sample of every brick of every level: the colour, the range and the mask.
  template <class T>
  void ExpectAll(const std::vector<T>& values, int components)
  {
    const std::shared_ptr<const SeriesFile> series = this->Encode(values, components);
    const std::vector<double> numbers = NumbersOf(values, components);
    for (int level = 0; level < series->Index().Levels; ++level)
    {
      SeriesBrickSource source(
        series, { 0, 0, 0, level }, SampleArray::Colours, BrickCache::Of(*series));
      EXPECT_TRUE(source.HasColours());
      const glm::ivec3 counts = source.Bricks();
      for (std::int64_t b = 0; b < std::int64_t{ counts.x } * counts.y * counts.z; ++b)
      {
        const Box cells = source.CellsOf(b);
        const Box samples{ cells.Lo, cells.Hi + 1 };
        std::vector<double> found(static_cast<std::size_t>(samples.Count()));
        CopySamples({ source.Load(b), samples }, samples, ScalarType::Float64, found.data());
        EXPECT_FALSE(source.UniformValueOf(b));
        std::size_t i = 0;
        for (glm::ivec3 p = samples.Lo; p.z < samples.Hi.z; ++p.z)
        {
          for (p.y = samples.Lo.y; p.y < samples.Hi.y; ++p.y)
          {
            for (p.x = samples.Lo.x; p.x < samples.Hi.x; ++p.x, ++i)
            {
              const glm::ivec3 at = glm::min(p << level, N - 1);
              const double expected =
                numbers[at.x + std::size_t(N.x) * (at.y + std::size_t(N.y) * at.z)];
              ASSERT_EQ(found[i], expected);
              const double shown = ColourNumber::ShownOf(found[i]);
              ASSERT_GE(shown, source.RangeOf(b).Low);
              ASSERT_LE(shown, source.RangeOf(b).High);
              ASSERT_TRUE(source.MaskOf(b) >> source.MasksAreOver().BinOf(shown) & 1);
            }
          }
        }
      }
    }
  }

  FloatImage Draw(BrickSource& source, const RayScene& scene)
  {
    return CastViewport(scene, source, scene.DomainCells, 1u << 30, this->Pool, this->Statistics);
  }

  banyan::testing::TemporaryFolder Folder;
  ThreadPool Pool{ 2 };
  RayStatistics Statistics;
  int Files = 0;
};

TEST_F(EncodedColours, AreThoseOfTheirComponents)
{
  this->ExpectAll(Sampled(N, 3), 3);
  this->ExpectAll(Sampled(N, 4, true), 4);
  // Beyond what is drawn, and not whole.
  std::vector<float> wide;
  for (const float value : Sampled<float>(N, 4))
  {
    wide.push_back(1.4f * value - 30.3f);
  }
  this->ExpectAll(wide, 4);
}

TEST_F(EncodedColours, DrawThePictureOfTheArray)
{
  for (const int components : { 3, 4 })
  {
    const std::vector<std::uint8_t> values = Sampled(N, components, components == 4);
    const std::shared_ptr<const SeriesFile> series = this->Encode(values, components);
    for (const bool shaded : { false, true })
    {
      RayScene scene = SceneOf(N, Picture, SparseWhite);
      scene.Shading = { shaded, 0.3f, 0.7f, 0.4f, 12.0f };
      const auto source = MakeSeriesSource(series, { 0, 0, 0, 0 }, SampleArray::Colours, None);
      const FloatImage image = this->Draw(*source, scene);
      EXPECT_GT(Most(image, ColourOf), 0.05f);
      EXPECT_EQ(
        MaxDifference(image, scenes::Draw(scene, ArrayOf(values, N, components)).Image), 0.0);
    }
  }
}

TEST_F(EncodedColours, AreNotLoadedWhereAlphaIsTransparent)
{
  std::vector<std::uint8_t> values = Sampled(N, 4);
  const std::size_t last = values.size() - 1;
  for (std::size_t i = 3; i < values.size(); i += 4)
  {
    values[i] = i == last ? 240 : 20;
  }
  const std::shared_ptr<const SeriesFile> series = this->Encode(values, 4);
  const auto source = MakeSeriesSource(series, { 0, 0, 0, 0 }, SampleArray::Colours, None);
  this->Draw(*source, SceneOf(N, Picture, SparseWhite));
  EXPECT_EQ(this->Statistics.BricksDrawn, 1);
}

TEST_F(EncodedColours, AreNotEnhanced)
{
  const std::shared_ptr<const SeriesFile> series = this->Encode(Sampled(N, 4), 4);
  EXPECT_THROW(
    MakeSeriesSource(series, { 0, 0, 0, 0 }, SampleArray::Colours, { 0.5, 1.0, 0.0 }), Error);
  const std::shared_ptr<const SeriesFile> scalars =
    this->Encode(scenes::Sampled<std::uint8_t>(scenes::Standard, N, 255.0), 1);
  EXPECT_THROW(MakeSeriesSource(scalars, { 0, 0, 0, 0 }, SampleArray::Colours, None), Error);
}

} // namespace
