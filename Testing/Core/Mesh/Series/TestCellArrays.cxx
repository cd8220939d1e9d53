// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Series/StoredMeshes.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Mesh/Series/AtlasValues.h"
#include "Mesh/Series/MeanOfLeaves.h"
#include "Mesh/Series/MeshFile.h"
#include "Mesh/Series/MeshLevel.h"
#include "Mesh/Series/TreeCells.h"
#include "Series/Decode/SeriesFile.h"
#include "Series/Encode/SegmentFolder.h"
#include "Series/Format/IndexText.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

using namespace banyan;

namespace
{

constexpr int Steps = 5;

/// Cells of four sizes with some holes, in any order.
meshes::OwnMesh<float> Basin()
{
  std::vector<meshes::Cube> cubes = meshes::Ball({ 3, 2, 2 }, 3);
  for (const std::size_t hole : { 200, 60, 0 })
  {
    cubes.erase(cubes.begin() + static_cast<std::ptrdiff_t>(hole));
  }
  return meshes::Make<float>(cubes, {}, glm::dvec3(10.0), 3);
}

glm::dvec3 CentreOf(const meshes::OwnMesh<float>& mesh, std::size_t cell)
{
  glm::dvec3 sum(0.0);
  for (std::size_t corner = 0; corner < 8; ++corner)
  {
    sum += glm::dvec3(mesh.Places[static_cast<std::size_t>(mesh.Ids[8 * cell + corner])]);
  }
  return sum / 8.0;
}

double EdgeOf(const meshes::OwnMesh<float>& mesh, std::size_t cell)
{
  int low = std::numeric_limits<int>::max(), high = 0;
  for (std::size_t corner = 0; corner < 8; ++corner)
  {
    const int x = mesh.Places[static_cast<std::size_t>(mesh.Ids[8 * cell + corner])].x;
    low = std::min(low, x);
    high = std::max(high, x);
  }
  return high - low;
}

/// Two components per cell; values that are none among them.
template <class T>
std::vector<T> Waves(const meshes::OwnMesh<float>& mesh, int step)
{
  std::vector<T> values;
  for (std::size_t cell = 0; cell < mesh.Ids.size() / 8; ++cell)
  {
    const glm::dvec3 p = CentreOf(mesh, cell);
    values.push_back(static_cast<T>(100.0 * std::sin(0.2 * p.x + 0.1 * step)));
    values.push_back(static_cast<T>(p.z + 10.0 * step));
  }
  if (std::is_floating_point_v<T>)
  {
    values[6] = std::numeric_limits<T>::quiet_NaN();
    values[31] = -std::numeric_limits<T>::infinity();
  }
  values[62] = T(-999);
  return values;
}

class CellArrays : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Folder = testing::TempDir() + "cell-arrays-" +
                   testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(this->Folder);
    std::filesystem::create_directories(this->Folder);
    this->Path = this->Folder + "/cells.banyan";
    this->Options.Mode = ErrorBoundMode::Absolute;
    this->Options.Quantizer.FillValues = { -999.0 };
  }
  void TearDown() override { std::filesystem::remove_all(this->Folder); }

  /// Encodes a point array "u" of the numbers of points, and Waves() of the cells as "u of cells".
  template <class T>
  SeriesIndex Encode(double bound)
  {
    const meshes::OwnMesh<float> mesh = Basin();
    const auto stored = meshes::Store(mesh.Mesh());
    this->Options.ErrorBound = bound;
    {
      SegmentFolder folder(this->Path);
      const auto plan = WriteMesh(*stored, folder);
      plan->CellArrays["u of cells"] = "u";
      this->Options.Mesh = plan;
    }
    const Grid grid = GridOfImages(*stored);
    const auto samples = static_cast<std::size_t>(grid.Extent.Count());
    SeriesEncoder encoder(this->Path, grid,
      { { "u", ScalarType::Float32, { "" }, {}, {} },
        { "u of cells", ScalarTypeOf<T>(), { "a", "b" }, {}, {} } },
      this->Options, this->Pool);
    std::vector<float> atPoints(samples);
    std::vector<T> ofCells(2 * samples);
    std::vector<float> numbers;
    for (std::int64_t i = 0; i < stored->PointCount(); ++i)
    {
      numbers.push_back(static_cast<float>(i));
    }
    for (int step = 0; step < Steps; ++step)
    {
      AtlasValues(stored).ToImage(
        ScalarType::Float32, numbers.data(), 1, {}, atPoints.data(), this->Pool);
      AtlasValues(stored, MeshValues::OfCells)
        .ToImage(ScalarTypeOf<T>(), Waves<T>(mesh, step).data(), 2,
          this->Options.Quantizer.FillValues, ofCells.data(), this->Pool);
      encoder.AddStep(step, { { atPoints.data() }, { ofCells.data() } });
    }
    return encoder.Finish();
  }

  template <class T>
  std::vector<T> Decoded(const SeriesFile& file, int step, int array, int components) const
  {
    const glm::ivec3 size = file.Index().Domain.Samples();
    std::vector<T> image(static_cast<std::size_t>(components) *
                         static_cast<std::size_t>(file.Index().Domain.Extent.Count()));
    const BrickLayout layout = file.Layout(0);
    const glm::i64vec3 stride{ components, std::int64_t{ components } * size.x,
      std::int64_t{ components } * size.x * size.y };
    for (int c = 0; c < components; ++c)
    {
      for (std::int64_t brick = 0; brick < layout.BrickCount(); ++brick)
      {
        const Box box = layout.SamplesOf(brick);
        file.DecodePart({ step, array, c, 0 }, brick, box, stride,
          image.data() + c + box.Lo.x * stride.x + box.Lo.y * stride.y + box.Lo.z * stride.z);
      }
    }
    return image;
  }

  template <class T>
  void ExpectWithin(double bound)
  {
    const SeriesIndex index = this->Encode<T>(bound);
    const meshes::OwnMesh<float> mesh = Basin();
    const auto file = SeriesFile::Open(this->Path);
    const auto back = ReadMesh(*file);
    double worst = 0.0;
    for (int step = 0; step < Steps; ++step)
    {
      const std::vector<T> wanted = Waves<T>(mesh, step);
      std::vector<T> got(wanted.size());
      const std::vector<T> image = this->Decoded<T>(*file, step, 1, 2);
      AtlasValues(back, MeshValues::OfCells)
        .FromImage(ScalarTypeOf<T>(), image.data(), 2, got.data());
      for (std::size_t i = 0; i < wanted.size(); ++i)
      {
        const auto value = static_cast<double>(wanted[i]);
        if (!std::isfinite(value) || value == -999.0 || bound == 0.0)
        {
          EXPECT_EQ(std::memcmp(&wanted[i], &got[i], sizeof(T)), 0) << i;
          continue;
        }
        worst = std::max(worst, std::abs(value - static_cast<double>(got[i])));
      }
    }
    EXPECT_LE(worst, bound);
    double measured = 0.0;
    for (const ComponentIndex& component : index.Arrays[1].Components)
    {
      // Every cell counts, and nothing else.
      EXPECT_EQ(component.FiniteCount + component.NonFiniteCount, Steps * back->CellCount());
      measured = std::max(measured, component.MeasuredMaxError);
    }
    EXPECT_EQ(measured, worst);
    EXPECT_EQ(index.Arrays[0].Components[0].FiniteCount, Steps * back->PointCount());
    EXPECT_EQ(
      index.PayloadBytesIn, static_cast<std::uint64_t>(Steps) *
                              (static_cast<std::uint64_t>(back->PointCount()) * sizeof(float) +
                                static_cast<std::uint64_t>(2 * back->CellCount()) * sizeof(T)));
  }

  std::string Folder, Path;
  EncodeOptions Options;
  ThreadPool Pool{ 2 };
};

TEST_F(CellArrays, KeepTheBound)
{
  this->ExpectWithin<float>(0.1);
}

TEST_F(CellArrays, IntegersKeepTheBound)
{
  this->ExpectWithin<std::int16_t>(2.0);
}

TEST_F(CellArrays, BoundZeroKeepsEveryBit)
{
  this->ExpectWithin<double>(0.0);
}

TEST_F(CellArrays, EachCellHasASampleOfItsOwn)
{
  const auto stored = meshes::Store(Basin().Mesh());
  std::vector<std::uint32_t> samples = stored->SampleOfCell;
  std::sort(samples.begin(), samples.end());
  EXPECT_EQ(std::adjacent_find(samples.begin(), samples.end()), samples.end());
  EXPECT_LT(samples.back(), stored->Atlas->SampleCount());
}

TEST_F(CellArrays, TheIndexSaysWhichTheyAre)
{
  const SeriesIndex index = this->Encode<float>(0.1);
  EXPECT_EQ(FeaturesOf(index), (std::vector<std::string>{ "mesh", "cell arrays" }));
  EXPECT_EQ(index.ActiveScalars, "u");
  const std::string text = IndexToText(index);
  EXPECT_EQ(text.rfind("BanyanSeries 1 ", 0), 0u);
  const SeriesIndex back = IndexFromText(text, "text");
  EXPECT_EQ(back.Arrays[0].CellArray, "");
  EXPECT_EQ(back.Arrays[1].Name, "u of cells");
  EXPECT_EQ(back.Arrays[1].CellArray, "u");
  SeriesIndex other = index;
  other.Arrays[0].CellArray = "u";
  EXPECT_THROW((void)IndexToText(other), Error);
  other = index;
  other.Arrays[1].CellArray.clear();
  EXPECT_EQ(FeaturesOf(other), std::vector<std::string>{ "mesh" });
  EXPECT_NO_THROW((void)IndexToText(other));
}

/// Means of merged cells by a search through all cells of the mesh, for the middles of coarse ones.
TEST_F(CellArrays, CoarserLevelsHaveMeansByVolume)
{
  const meshes::OwnMesh<float> mesh = Basin();
  const auto stored = meshes::Store(mesh.Mesh());
  std::vector<double> values = Waves<double>(mesh, 1);
  const std::vector<double> fills{ -999.0 };
  std::vector<double> image(2 * static_cast<std::size_t>(stored->Atlas->SampleCount()));
  AtlasValues(stored, MeshValues::OfCells)
    .ToImage(ScalarType::Float64, values.data(), 2, fills, image.data(), this->Pool);
  const FillSet<double> set(fills);
  for (int level = 1; level <= 3; ++level)
  {
    const MeshCells coarse = CoarserCells(*stored, level);
    ASSERT_EQ(coarse.FirstLeaf.size(), static_cast<std::size_t>(coarse.Count()));
    const TreeCells trees = TreeCellsOf(*stored, level);
    ASSERT_EQ(trees.FirstCell.size(), coarse.FirstLeaf.size() + 1);
    int merged = 0, nans = 0, filled = 0;
    for (std::size_t i = 0; i < coarse.FirstLeaf.size(); ++i)
    {
      const auto place = [&](std::size_t corner) {
        return glm::dvec3(
          mesh.Places[static_cast<std::size_t>(coarse.Connectivity[8 * i + corner])]);
      };
      const glm::dvec3 low = place(0), high = place(7);
      for (int c = 0; c < 2; ++c)
      {
        double sum = 0.0, volume = 0.0;
        bool fill = false;
        int found = 0;
        for (std::size_t cell = 0; cell < mesh.Ids.size() / 8; ++cell)
        {
          const glm::dvec3 at = CentreOf(mesh, cell);
          if (at.x > low.x && at.y > low.y && at.z > low.z && at.x < high.x && at.y < high.y &&
              at.z < high.z)
          {
            const double value = values[2 * cell + static_cast<std::size_t>(c)];
            const double size = std::pow(EdgeOf(mesh, cell), 3.0);
            fill = fill || value == -999.0;
            sum += size * value;
            volume += size;
            ++found;
          }
        }
        ASSERT_GE(found, 1);
        merged += found > 1 ? 1 : 0;
        const std::size_t first = coarse.FirstLeaf[i];
        const std::size_t end =
          i + 1 < coarse.FirstLeaf.size() ? coarse.FirstLeaf[i + 1] : stored->Leaves.Keys.size();
        EXPECT_EQ(trees.FirstCell[i], first);
        EXPECT_EQ(trees.FirstCell[i + 1], end);
        const auto got = MeanOfLeaves<double>(*stored, image.data(), 2, c, first, end, set);
        if (fill)
        {
          EXPECT_EQ(got, -999.0);
          ++filled;
        }
        else if (std::isnan(sum))
        {
          EXPECT_TRUE(std::isnan(got));
          ++nans;
        }
        else if (std::isinf(sum))
        {
          EXPECT_EQ(got, sum);
        }
        else
        {
          EXPECT_NEAR(got, sum / volume, 1e-10);
        }
      }
    }
    EXPECT_GT(merged, 0);
    EXPECT_EQ(nans, 1);
    EXPECT_EQ(filled, 1);
  }
}

TEST_F(CellArrays, MeansOfTheLargestNumbersAreFinite)
{
  const meshes::OwnMesh<float> mesh = Basin();
  const auto stored = meshes::Store(mesh.Mesh());
  const double most = std::numeric_limits<double>::max();
  const std::vector<double> image(static_cast<std::size_t>(stored->Atlas->SampleCount()), most);
  for (int level = 1; level <= 3; ++level)
  {
    const TreeCells trees = TreeCellsOf(*stored, level);
    for (std::size_t i = 0; i + 1 < trees.FirstCell.size(); ++i)
    {
      EXPECT_EQ(MeanOfLeaves<double>(*stored, image.data(), 1, 0, trees.FirstCell[i],
                  trees.FirstCell[i + 1], FillSet<double>({})),
        most);
    }
  }
}

TEST_F(CellArrays, MeansOfIntegersAreRounded)
{
  const auto mesh =
    meshes::Make<float>(meshes::Leaves({ 1, 1, 1 }, 1, [](const auto&) { return true; }));
  const auto stored = meshes::Store(mesh.Mesh());
  const std::vector<std::uint8_t> values{ 255, 255, 255, 255, 255, 255, 255, 251 };
  std::vector<std::uint8_t> image(static_cast<std::size_t>(stored->Atlas->SampleCount()));
  AtlasValues(stored, MeshValues::OfCells)
    .ToImage(ScalarType::UInt8, values.data(), 1, {}, image.data(), this->Pool);
  const FillSet<std::uint8_t> none({});
  EXPECT_EQ(MeanOfLeaves<std::uint8_t>(*stored, image.data(), 1, 0, 0, 8, none), 254);
  EXPECT_EQ(MeanOfLeaves<double>(*stored, image.data(), 1, 0, 0, 8, none), 254.5);
}

} // namespace
