// SPDX-License-Identifier: BSD-3-Clause
// The ground and the fault of the series "earthquake", its mesh, and the series itself.
#include "EarthquakeMesh.h"
#include "NorthridgeModel.h"
#include "SeriesCatalog.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using banyan::EarthquakeMesh;
using banyan::MomentPoint;
using banyan::NorthridgeModel;
using banyan::OctreeMesh;
using banyan::ThreadPool;

namespace
{

constexpr double Pi = 3.141592653589793;

banyan::GenerateOptions Options(std::vector<std::string> more)
{
  more.insert(more.begin(), { "--series", "earthquake", "--output", "o" });
  return banyan::ParseGenerateOptions(more);
}

struct Series
{
  std::vector<double> Times;
  std::vector<std::vector<float>> Velocity, Displacement;
  std::size_t Nodes = 0;
};

Series Make(const std::vector<std::string>& options, int threads)
{
  ThreadPool pool(threads);
  Series series;
  banyan::FindSeriesKind("earthquake")
    .GenerateMesh(Options(options), pool,
      [&](const banyan::MeshStep& step)
      {
        ASSERT_EQ(step.Arrays.size(), 2u);
        EXPECT_EQ(step.Arrays[0].Name, "velocity");
        EXPECT_EQ(step.Arrays[1].Name, "ground_displacement");
        series.Times.push_back(step.Time);
        series.Velocity.push_back(*step.Arrays[0].Values);
        series.Displacement.push_back(*step.Arrays[1].Values);
        series.Nodes = step.Mesh.NodeCount();
      });
  return series;
}

} // namespace

TEST(Earthquake, TheGroundIsSoftInTheBasinsAndHardensWithDepth)
{
  const NorthridgeModel ground(1, 500.0), same(1, 500.0), other(2, 500.0);
  std::mt19937 random(1);
  bool differs = false;
  for (int column = 0; column < 300; ++column)
  {
    const double x = random() % 80000, y = random() % 80000;
    float last = 0.0f;
    for (double z = 0.0; z >= -30000.0; z -= 150.0)
    {
      const auto m = ground.At({ x, y, z });
      ASSERT_GE(m.ShearSpeed, last) << x << " " << y << " " << z;
      ASSERT_GT(m.PressureSpeed, 1.5f * m.ShearSpeed);
      ASSERT_GT(m.Density, 1900.0f);
      ASSERT_LT(m.Density, 3000.0f);
      last = m.ShearSpeed;
      ASSERT_EQ(m.ShearSpeed, same.At({ x, y, z }).ShearSpeed);
      differs = differs || m.ShearSpeed != other.At({ x, y, z }).ShearSpeed;
    }
    EXPECT_NEAR(last, 3800.0f, 1.0f);
  }
  EXPECT_TRUE(differs);
  // Valley, basin, and rock outside.
  EXPECT_EQ(ground.At({ 29000.0, 51000.0, 0.0 }).ShearSpeed, 500.0f);
  EXPECT_EQ(ground.At({ 51000.0, 27000.0, 0.0 }).ShearSpeed, 500.0f);
  EXPECT_EQ(ground.At({ 5000.0, 5000.0, 0.0 }).ShearSpeed, 1800.0f);
  EXPECT_EQ(NorthridgeModel(1, 900.0).At({ 51000.0, 27000.0, 0.0 }).ShearSpeed, 900.0f);
  EXPECT_THROW(NorthridgeModel(1, 99.0), banyan::Error);
  EXPECT_THROW(NorthridgeModel(1, NAN), banyan::Error);
}

TEST(Earthquake, TheFaultIsADoubleCoupleOfMagnitudeSixPointSeven)
{
  const NorthridgeModel ground(1, 500.0);
  const auto fault = ground.Fault(0.7);
  std::array<double, 6> moment{};
  double first = HUGE_VAL;
  for (const MomentPoint& point : fault)
  {
    EXPECT_GT(-point.Place[2], 5000.0);
    EXPECT_LT(-point.Place[2], 18500.0);
    EXPECT_GT(point.Place[0], 10000.0);
    EXPECT_LT(point.Place[0], 60000.0);
    EXPECT_GT(point.Delay, 3.0 * 0.7 - 1e-9);
    first = std::min(first, point.Delay);
    // Long after the slip its share is the integral of the rate.
    EXPECT_NEAR(point.Share(100.0), 0.7 * std::sqrt(Pi), 1e-9);
    for (int c = 0; c < 6; ++c)
    {
      moment[c] += point.Moment[c] * point.Share(100.0);
    }
  }
  EXPECT_LT(first, 3.0 * 0.7 + 0.5);
  // A double couple: no explosion (trace), no axis without force (determinant), and the norm of the
  // moment is the square root of two times 1.3e19 N m.
  const auto& m = moment;
  EXPECT_NEAR((m[0] + m[1] + m[2]) / 1e19, 0.0, 1e-9);
  const double determinant = m[0] * (m[1] * m[2] - m[5] * m[5]) -
                             m[3] * (m[3] * m[2] - m[5] * m[4]) +
                             m[4] * (m[3] * m[5] - m[1] * m[4]);
  EXPECT_NEAR(determinant / 1e57, 0.0, 1e-9);
  const double norm = std::sqrt(
    m[0] * m[0] + m[1] * m[1] + m[2] * m[2] + 2.0 * (m[3] * m[3] + m[4] * m[4] + m[5] * m[5]));
  EXPECT_NEAR(norm / std::sqrt(2.0), 1.3e19, 1e15);
  // A thrust: what lies above moves up and north, so that the ground is compressed that way.
  EXPECT_GT(m[2], 0.0);
  EXPECT_LT(m[1], 0.0);
  EXPECT_NEAR(2.0 / 3.0 * (std::log10(norm / std::sqrt(2.0)) - 9.1), 6.7, 0.05);
}

TEST(Earthquake, CellsFollowTheWaves)
{
  ThreadPool pool(2);
  const NorthridgeModel ground(1, 500.0);
  for (const double wanted : { 5000.0, 20000.0, 60000.0 })
  {
    const double hertz = EarthquakeMesh::FrequencyForCells(ground, wanted, pool);
    const OctreeMesh mesh = EarthquakeMesh::ForFrequency(ground, hertz, pool);
    const double found = static_cast<double>(mesh.CellCount());
    EXPECT_LT(std::abs(std::log(found / wanted)), std::log(1.3)) << wanted << " " << found;
    std::size_t smaller = 0;
    for (std::size_t i = 0; i < mesh.CellCount(); ++i)
    {
      const double edge = mesh.EdgeOfLevel(mesh.Cell(i).Level);
      const auto low = mesh.CornerPoint(mesh.Cell(i));
      for (int corner = 0; corner < 4; ++corner)
      {
        const auto m =
          ground.At({ low[0] + (corner & 1) * edge, low[1] + (corner >> 1) * edge, low[2] + edge });
        ASSERT_LE(edge, m.ShearSpeed / (EarthquakeMesh::CellsPerWave * hertz));
      }
      // A cell is not needed when even eight of it together would do.
      std::array<double, 3> parent = low;
      for (int axis = 0; axis < 3; ++axis)
      {
        parent[axis] = 2.0 * edge * std::floor(low[axis] / (2.0 * edge));
      }
      smaller +=
        2.0 * edge * EarthquakeMesh::CellsPerWave * hertz <= ground.SlowestIn(parent, 2.0 * edge);
    }
    // Balance needs a few.
    EXPECT_LT(static_cast<double>(smaller), 0.05 * found) << wanted;
  }
}

TEST(Earthquake, DurationAndFrequencyFitTheSpectrum)
{
  const double hertz = 0.7, duration = EarthquakeMesh::HalfDuration(hertz);
  const auto spectrum = [&](double f)
  {
    // Of exp(-(t / duration)^2), by the sum that stands for the integral.
    double sum = 0.0;
    const double step = 0.001;
    for (double t = -10.0; t < 10.0; t += step)
    {
      sum += step * std::exp(-t * t / (duration * duration)) * std::cos(2.0 * Pi * f * t);
    }
    return sum;
  };
  EXPECT_NEAR(spectrum(hertz) / spectrum(0.0), 0.1, 1e-4);
  const double strongest = EarthquakeMesh::StrongestHertz(duration);
  EXPECT_GT(strongest * spectrum(strongest), 1.01 * strongest * spectrum(1.2 * strongest) * 1.2);
  EXPECT_GT(strongest * spectrum(strongest), 1.01 * strongest * spectrum(0.8 * strongest) * 0.8);
  EXPECT_LT(2.0 * strongest, hertz);
}

TEST(Earthquake, EqualSeedsGiveEqualBytesWithAnyNumberOfThreads)
{
  const std::vector<std::string> options = { "--cells", "4000", "--steps", "3", "--duration",
    "48" };
  std::vector<std::string> otherSeed = options;
  otherSeed.insert(otherSeed.end(), { "--seed", "2" });
  const Series one = Make(options, 1), three = Make(options, 3), other = Make(otherSeed, 2);
  EXPECT_EQ(one.Times, (std::vector<double>{ 0.0, 24.0, 48.0 }));
  ASSERT_EQ(one.Velocity.size(), 3u);
  EXPECT_EQ(one.Velocity[2].size(), 3 * one.Nodes);
  EXPECT_TRUE(one.Velocity == three.Velocity);
  EXPECT_TRUE(one.Displacement == three.Displacement);
  EXPECT_FALSE(one.Velocity == other.Velocity);
  const auto largest = [](const std::vector<float>& values)
  {
    float most = 0.0f;
    for (const float value : values)
    {
      most = std::max(most, std::abs(value));
    }
    return most;
  };
  EXPECT_EQ(largest(one.Velocity[0]), 0.0f);
  EXPECT_EQ(largest(one.Displacement[0]), 0.0f);
  // Metres per second and metres, as people have felt it.
  EXPECT_GT(largest(one.Velocity[1]), 0.02f);
  EXPECT_LT(largest(one.Velocity[1]), 2.0f);
  EXPECT_GT(largest(one.Displacement[2]), 0.1f);
  EXPECT_LT(largest(one.Displacement[2]), 5.0f);
}

TEST(Earthquake, OptionsOfMeshesAreChecked)
{
  const auto errorOf = [](const std::vector<std::string>& more)
  {
    try
    {
      Options(more);
    }
    catch (const banyan::Error& error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto options = Options({});
  EXPECT_EQ(options.Cells, 20000);
  EXPECT_EQ(options.Slowest, 500.0);
  EXPECT_EQ(options.Format, "exodus");
  EXPECT_EQ(options.Arrays, (std::vector<std::string>{ "velocity", "ground_displacement" }));
  EXPECT_EQ(Options({ "--voxels" }).Format, "vtu");
  EXPECT_EQ(Options({ "--cells", "12345", "--slowest", "800" }).Cells, 12345);
  EXPECT_NE(errorOf({ "--size", "64" }).find("--cells"), std::string::npos);
  EXPECT_NE(errorOf({ "--cells", "999" }).find("1000"), std::string::npos);
  EXPECT_NE(errorOf({ "--slowest", "50" }).find("100"), std::string::npos);
  EXPECT_NE(errorOf({ "--format", "obj" }).find("obj"), std::string::npos);
  EXPECT_NE(errorOf({ "--format", "exodus", "--voxels" }).find("voxels"), std::string::npos);
  EXPECT_NE(errorOf({ "--arrays", "speed" }).find("ground_displacement"), std::string::npos);
  EXPECT_THROW(
    banyan::ParseGenerateOptions({ "--series", "jet", "--output", "o", "--cells", "20000" }),
    banyan::Error);
}
