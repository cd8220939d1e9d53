// SPDX-License-Identifier: BSD-3-Clause
// What must not change a picture by more than one level of 8 bits: steps, the grid that the samples
// of one and the same function lie on, bricks, types, and levels of detail.
#include "Render/Analytic.h"

#include "Render/Bricks/SeriesBrickSource.h"
#include "Series/Encode/SeriesEncoder.h"

#include <cstdlib>
#include <filesystem>

namespace
{

using namespace banyan;
using analytic::OneLevel;

const glm::ivec2 Pixels(48, 40);
const glm::dvec3 Size(24.0, 18.0, 30.0); // of the domain in the world

/// Between 0 and 1, linear in each coordinate: its trilinear interpolant is itself on every grid.
double Trilinear(const glm::dvec3& p)
{
  return 0.1 + 0.3 * p.x + 0.2 * p.y * p.z - 0.25 * p.x * p.z + 0.5 * p.x * p.y * p.z + 0.1 * p.z;
}

/// A broad bell.
double Bell(const glm::dvec3& p)
{
  return std::exp(-6.0 * glm::dot(p - 0.5, p - 0.5));
}

/// The scene of a grid of n samples over the domain, at distances of `step` in the world.
RayScene SceneOf(const glm::ivec3& n, double step)
{
  const glm::dmat4 toWorld = glm::scale(glm::dmat4(1.0), Size / glm::dvec3(n - 1));
  RayScene scene = scenes::Scene(n, Pixels, toWorld);
  scene.SampleDistance = step;
  return scene;
}

FloatImage DrawOn(const glm::ivec3& n, const scenes::Field& field, double step, int brickCells = 16)
{
  const std::vector<float> values = scenes::Sampled(field, n);
  return scenes::Draw(SceneOf(n, step), scenes::ArrayOf(values, n), { brickCells }).Image;
}

double Strongest(const FloatImage& image)
{
  float strongest = 0.0f;
  for (const glm::vec4& pixel : image.Pixels)
  {
    strongest = std::max(strongest, pixel.a);
  }
  return strongest;
}

TEST(AnalyticInvariance, StepsChangeLessThanALevel)
{
  for (const scenes::Field& field : { scenes::Field(Trilinear), scenes::Field(Bell) })
  {
    const FloatImage fine = DrawOn(glm::ivec3(25), field, 0.1);
    EXPECT_GT(Strongest(fine), 0.3);
    for (const double step : { 0.3, 0.5, 1.0, 1.7 })
    {
      EXPECT_LE(MaxDifference(fine, DrawOn(glm::ivec3(25), field, step)), OneLevel) << step;
    }
  }
}

TEST(AnalyticInvariance, SpacingsChangeLessThanALevel)
{
  const FloatImage cubes = DrawOn({ 25, 19, 31 }, Trilinear, 0.5);
  EXPECT_GT(Strongest(cubes), 0.3);
  for (const glm::ivec3& n : { glm::ivec3(2), glm::ivec3(3, 40, 9), glm::ivec3(50, 2, 17),
         glm::ivec3(7, 7, 2), glm::ivec3(33) })
  {
    EXPECT_LE(MaxDifference(cubes, DrawOn(n, Trilinear, 0.5)), OneLevel)
      << n.x << " x " << n.y << " x " << n.z;
  }
}

TEST(AnalyticInvariance, LongCellsAreDrawnAsLong)
{
  // A volume a thousand times as flat as wide, drawn large: lengths of rays decide.
  const glm::ivec3 n(20, 20, 9);
  const glm::dvec3 spacing(1000.0, 1000.0, 1.0);
  const glm::dvec3 size = glm::dvec3(n - 1) * spacing;
  const std::vector<float> values = scenes::Sampled([](const glm::dvec3&) { return 0.5; }, n);
  RayScene scene = scenes::Scene(n, Pixels, glm::scale(glm::dmat4(1.0), spacing));
  scene.SampleDistance = 0.7;
  const double extinction = 0.03;
  scene.Transfer =
    scenes::Tabulate([&](double) { return glm::dvec4(1, 1, 1, analytic::OpacityOf(extinction)); });
  analytic::ExpectIntegral(
    scenes::Draw(scene, scenes::ArrayOf(values, n)).Image, scene, size,
    [&](const analytic::Chord& chord)
    { return glm::dvec4(analytic::OpacityOf(extinction * chord.Length())); },
    0.1 * OneLevel);
}

TEST(AnalyticInvariance, BricksChangeLessThanALevel)
{
  const FloatImage whole = DrawOn({ 25, 19, 31 }, scenes::Standard, 0.7, 64);
  EXPECT_GT(Strongest(whole), 0.3);
  for (const int cells : { 1, 2, 7, 16, 30 })
  {
    const FloatImage image = DrawOn({ 25, 19, 31 }, scenes::Standard, 0.7, cells);
    EXPECT_LE(MaxDifference(whole, image), OneLevel) << cells;
  }
}

template <class T>
FloatImage DrawAs(const RayScene& scene, const glm::ivec3& n, double high)
{
  RayScene scaled = scene;
  scaled.Transfer.High = high;
  const std::vector<T> values = scenes::Sampled<T>(Trilinear, n, high, high > 1.0 ? 0.5 : 0.0);
  return scenes::Draw(scaled, scenes::ArrayOf(values, n)).Image;
}

TEST(AnalyticInvariance, TypesChangeLessThanALevel)
{
  const glm::ivec3 n(25);
  const RayScene scene = SceneOf(n, 0.5);
  const FloatImage floats = DrawAs<float>(scene, n, 1.0);
  EXPECT_LE(MaxDifference(floats, DrawAs<double>(scene, n, 1.0)), OneLevel);
  EXPECT_LE(MaxDifference(floats, DrawAs<std::uint8_t>(scene, n, 255.0)), OneLevel);
  EXPECT_LE(MaxDifference(floats, DrawAs<std::int16_t>(scene, n, 32767.0)), OneLevel);
  EXPECT_LE(MaxDifference(floats, DrawAs<std::uint16_t>(scene, n, 65535.0)), OneLevel);
  EXPECT_LE(MaxDifference(floats, DrawAs<std::int32_t>(scene, n, 2e9)), OneLevel);
  EXPECT_LE(MaxDifference(floats, DrawAs<std::int64_t>(scene, n, 4e18)), OneLevel);
}

/// An encoded series of one step in a folder of its own.
class AnalyticLevels : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Folder = (std::filesystem::temp_directory_path() / "banyan-levels-XXXXXX").string();
    ASSERT_NE(mkdtemp(this->Folder.data()), nullptr);
  }
  void TearDown() override { std::filesystem::remove_all(this->Folder); }

  std::shared_ptr<SeriesFile> Encoded(const scenes::Field& field, int n, int brickCells)
  {
    const std::vector<float> values = scenes::Sampled(field, glm::ivec3(n));
    Grid grid;
    grid.Extent.Hi = glm::ivec3(n);
    ArrayDescription array;
    array.Name = "value";
    array.ComponentNames = { "" };
    array.SeriesRanges = { { 0.0, 1.0 } };
    EncodeOptions options;
    options.ErrorBound = 1e-4;
    options.BrickCells = brickCells;
    ThreadPool pool(2);
    const std::string path = this->Folder + "/" + std::to_string(brickCells) + ".banyan";
    SeriesEncoder encoder(path, grid, { array }, options, pool);
    encoder.AddStep(0.0, { { values.data() } });
    encoder.Finish();
    return SeriesFile::Open(path);
  }

  static FloatImage DrawLevel(const std::shared_ptr<SeriesFile>& series, int n, int level)
  {
    FieldKey field;
    field.Level = level;
    BrickCache cache(1u << 24);
    ThreadPool pool(2);
    SeriesBrickSource source(series, field, 0, cache);
    const RayScene scene = SceneOf(glm::ivec3(((n - 1) >> level) + 1), 0.5);
    RayStatistics statistics;
    return CastRays(scene, source, scene.DomainCells, 1u << 24, pool, statistics);
  }

  std::string Folder;
};

TEST_F(AnalyticLevels, LevelsOfWhatTheyHoldExactlyAreThePicture)
{
  const int n = 129;
  const FloatImage plain = DrawOn(glm::ivec3(n), Trilinear, 0.5);
  EXPECT_GT(Strongest(plain), 0.3);
  for (const int brickCells : { 16, 32 })
  {
    const std::shared_ptr<SeriesFile> series = this->Encoded(Trilinear, n, brickCells);
    for (const int level : { 0, 1, 2 })
    {
      EXPECT_LE(MaxDifference(plain, DrawLevel(series, n, level)), OneLevel)
        << "bricks of " << brickCells << ", level " << level;
    }
  }
}

TEST_F(AnalyticLevels, LevelsOfWhatIsSmoothAreNearlyThePicture)
{
  const int n = 65;
  const std::shared_ptr<SeriesFile> series = this->Encoded(Bell, n, 16);
  const FloatImage finest = DrawLevel(series, n, 0);
  EXPECT_LE(MaxDifference(finest, DrawOn(glm::ivec3(n), Bell, 0.5)), OneLevel);
  const double first = MaxDifference(finest, DrawLevel(series, n, 1));
  EXPECT_LE(first, OneLevel);
  EXPECT_GT(MaxDifference(finest, DrawLevel(series, n, 2)), 2.0 * first) << "all levels are one";
}

} // namespace
