// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Series/StoredMeshes.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Mesh/Series/AtlasValues.h"
#include "Mesh/Series/MeshFile.h"
#include "Series/Decode/SeriesFile.h"
#include "Series/Encode/SegmentFolder.h"
#include "Series/Format/IndexText.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

using namespace banyan;

namespace
{

/// A folder of its own for each test.
class MeshSeries : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Folder = testing::TempDir() + "mesh-series-" +
                   testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(this->Folder);
    std::filesystem::create_directories(this->Folder);
    this->Path = this->Folder + "/quake.banyan";
  }
  void TearDown() override { std::filesystem::remove_all(this->Folder); }

  std::string Folder, Path;
  ThreadPool Pool{ 2 };
};

/// Waves that pass, three components; NaN, infinities and a fill value among them if wanted.
template <class T>
std::vector<T> Waves(const meshes::OwnMesh<float>& mesh, int step, bool special)
{
  std::vector<T> values;
  for (std::size_t i = 0; i < mesh.Places.size(); ++i)
  {
    const glm::dvec3 p = mesh.Places[i];
    values.push_back(static_cast<T>(100.0 * std::sin(0.2 * p.x + 0.1 * step)));
    values.push_back(static_cast<T>(100.0 * std::cos(0.1 * p.y - 0.3 * step)));
    values.push_back(static_cast<T>(p.z));
  }
  if (special)
  {
    values[3] = std::numeric_limits<T>::quiet_NaN();
    values[31] = -std::numeric_limits<T>::infinity();
    values[62] = T(-9999);
  }
  return values;
}

/// Encodes steps of an array "u" of three components and compares each value that comes back.
template <class T>
SeriesIndex ExpectWithinBound(const std::string& path, const meshes::OwnMesh<float>& mesh,
  EncodeOptions options, bool special, ThreadPool& pool)
{
  const auto stored = meshes::Store(mesh.Mesh());
  {
    SegmentFolder folder(path);
    options.Mesh = WriteMesh(*stored, folder);
  }
  const AtlasValues values(stored);
  const Grid grid = GridOfImages(*stored);
  const auto samples = static_cast<std::size_t>(grid.Extent.Count());
  constexpr int steps = 11;
  SeriesEncoder encoder(
    path, grid, { { "u", ScalarTypeOf<T>(), { "x", "y", "z" }, {}, {} } }, options, pool);
  std::vector<T> image(3 * samples);
  for (int step = 0; step < steps; ++step)
  {
    values.ToImage(ScalarTypeOf<T>(), Waves<T>(mesh, step, special).data(), 3,
      options.Quantizer.FillValues, image.data(), pool);
    encoder.AddStep(step, { { image.data() } });
  }
  const SeriesIndex index = encoder.Finish();

  const auto file = SeriesFile::Open(path);
  const auto back = ReadMesh(*file);
  EXPECT_EQ(back->SampleOfPoint, stored->SampleOfPoint);
  const AtlasValues read(back);
  double worst = 0.0;
  for (int step = 0; step < steps; ++step)
  {
    for (int c = 0; c < 3; ++c)
    {
      const BrickLayout layout = file->Layout(0);
      for (std::int64_t brick = 0; brick < layout.BrickCount(); ++brick)
      {
        const Box box = layout.SamplesOf(brick);
        const glm::ivec3 size = grid.Samples();
        const glm::i64vec3 stride{ 3, 3 * size.x, std::int64_t{ 3 } * size.x * size.y };
        file->DecodePart({ step, 0, c, 0 }, brick, box, stride,
          image.data() + c + box.Lo.x * stride.x + box.Lo.y * stride.y + box.Lo.z * stride.z);
      }
    }
    const std::vector<T> wanted = Waves<T>(mesh, step, special);
    std::vector<T> got(wanted.size());
    read.FromImage(ScalarTypeOf<T>(), image.data(), 3, got.data());
    for (std::size_t i = 0; i < got.size(); ++i)
    {
      const auto value = static_cast<double>(wanted[i]);
      if (!std::isfinite(value) || value == -9999.0 || options.ErrorBound == 0.0)
      {
        EXPECT_EQ(std::memcmp(&wanted[i], &got[i], sizeof(T)), 0) << i;
        continue;
      }
      worst = std::max(worst, std::abs(value - static_cast<double>(got[i])));
    }
  }
  EXPECT_LE(worst, options.ErrorBound);
  const std::int64_t points = stored->PointCount();
  double measured = 0.0;
  for (const ComponentIndex& component : index.Arrays[0].Components)
  {
    // Every value counts, and nothing but values.
    EXPECT_EQ(component.FiniteCount + component.NonFiniteCount, points * steps);
    measured = std::max(measured, component.MeasuredMaxError);
  }
  EXPECT_EQ(measured, worst);
  EXPECT_EQ(index.PayloadBytesIn, static_cast<std::uint64_t>(3 * points * steps) * sizeof(T));
  EXPECT_EQ(FeaturesOf(index), std::vector<std::string>{ "mesh" });
  EXPECT_EQ(index.Mesh->Points, points);
  EXPECT_EQ(index.Mesh->Cells, stored->CellCount());
  return index;
}

EncodeOptions Absolute(double bound)
{
  EncodeOptions options;
  options.Mode = ErrorBoundMode::Absolute;
  options.ErrorBound = bound;
  return options;
}

meshes::OwnMesh<float> Basin(unsigned shuffle)
{
  return meshes::Make<float>(meshes::Ball({ 3, 2, 2 }, 3), {}, glm::dvec3(10.0), shuffle);
}

TEST_F(MeshSeries, FloatsKeepTheBound)
{
  const SeriesIndex index =
    ExpectWithinBound<float>(this->Path, Basin(3), Absolute(0.1), false, this->Pool);
  EXPECT_NEAR(index.Arrays[0].Components[2].Range.High, 16.0, 0.1);
  EXPECT_EQ(index.Statistics.ExceptionVoxels, 0);
}

TEST_F(MeshSeries, SpecialValuesComeBack)
{
  EncodeOptions options = Absolute(0.1);
  options.Quantizer.FillValues = { -9999.0 };
  const SeriesIndex index =
    ExpectWithinBound<double>(this->Path, Basin(0), options, true, this->Pool);
  EXPECT_EQ(index.Arrays[0].Components[0].NonFiniteCount, 11);
  EXPECT_EQ(index.Arrays[0].Components[1].NonFiniteCount, 11);
  EXPECT_EQ(index.Arrays[0].Components[2].FillCount, 11);
  // At each step: those three, each on the planes that it is on.
  EXPECT_EQ(index.Statistics.ExceptionVoxels, 33);
}

TEST_F(MeshSeries, Integers)
{
  ExpectWithinBound<std::int16_t>(this->Path, Basin(2), Absolute(2.0), false, this->Pool);
}

TEST_F(MeshSeries, BoundZeroKeepsEveryBit)
{
  ExpectWithinBound<float>(this->Path, Basin(1), Absolute(0.0), true, this->Pool);
}

TEST_F(MeshSeries, PointsThatCoincideKeepTheirOwnValues)
{
  auto mesh = meshes::Separated(Basin(4));
  meshes::AddLoosePoints(mesh);
  for (std::size_t i = 0; i < mesh.Places.size(); ++i)
  {
    mesh.Places[i].x += static_cast<int>(i % 7); // values differ where points do not
  }
  const auto places = mesh.Places;
  ExpectWithinBound<float>(this->Path, mesh, Absolute(0.5), false, this->Pool);
}

TEST_F(MeshSeries, FreeSamplesLieBetweenTheOthers)
{
  const auto mesh = Basin(0);
  const auto stored = meshes::Store(mesh.Mesh());
  const AtlasValues values(stored);
  std::vector<float> image(static_cast<std::size_t>(stored->Atlas->SampleCount()));
  const auto wanted = mesh.Sampled<float>([](const glm::dvec3& p) { return 3.0 + p.x - p.y; });
  values.ToImage(ScalarType::Float32, wanted.data(), 1, {}, image.data(), this->Pool);
  const auto wantedRange = std::minmax_element(wanted.begin(), wanted.end());
  const auto range = std::minmax_element(image.begin(), image.end());
  EXPECT_EQ(*range.first, *wantedRange.first);
  EXPECT_EQ(*range.second, *wantedRange.second);
}

TEST_F(MeshSeries, AMeshOfAnotherSeriesIsRefused)
{
  ExpectWithinBound<float>(this->Path, Basin(3), Absolute(1.0), false, this->Pool);
  const auto file = SeriesFile::Open(this->Path);
  const std::string mesh = this->Path + ".d/" + file->Index().Mesh->File;
  std::string content;
  {
    std::ifstream stream(mesh, std::ios::binary);
    content.assign(std::istreambuf_iterator<char>(stream), {});
  }
  for (const std::size_t at : { std::size_t{ 0 }, content.size() / 2, content.size() - 1 })
  {
    std::string bad = content;
    bad[at] = static_cast<char>(bad[at] ^ 4);
    std::ofstream(mesh, std::ios::binary) << bad;
    EXPECT_THROW((void)ReadMesh(*file), Error);
  }
  std::ofstream(mesh, std::ios::binary) << content.substr(1);
  EXPECT_THROW((void)ReadMesh(*file), Error);
  std::filesystem::remove(mesh);
  EXPECT_THROW((void)ReadMesh(*file), Error);
}

TEST_F(MeshSeries, TheIndexSaysThatItIsAMesh)
{
  const SeriesIndex index =
    ExpectWithinBound<float>(this->Path, Basin(3), Absolute(1.0), false, this->Pool);
  const std::string text = IndexToText(index);
  EXPECT_EQ(text.rfind("BanyanSeries 1 ", 0), 0u);
  EXPECT_NE(text.find("\"mesh\""), std::string::npos);
  SeriesIndex other = index;
  other.Mesh.reset();
  EXPECT_EQ(FeaturesOf(other), std::vector<std::string>{});
  other = index;
  other.Mesh->File = "../mesh";
  EXPECT_THROW((void)IndexToText(other), Error);
  other = index;
  other.Mesh->Points = index.Domain.Extent.Count() + 1;
  EXPECT_THROW((void)IndexToText(other), Error);
}

TEST_F(MeshSeries, AnotherSeriesTakesItsPlace)
{
  ExpectWithinBound<float>(this->Path, Basin(3), Absolute(1.0), false, this->Pool);
  const std::string before = SeriesFile::Open(this->Path)->Index().Mesh->File;
  ExpectWithinBound<float>(this->Path, Basin(0), Absolute(1.0), false, this->Pool);
  const std::string now = SeriesFile::Open(this->Path)->Index().Mesh->File;
  EXPECT_NE(before, now);
  EXPECT_FALSE(std::filesystem::exists(this->Path + ".d/" + before));
  EXPECT_TRUE(std::filesystem::exists(this->Path + ".d/" + now));
}

} // namespace
