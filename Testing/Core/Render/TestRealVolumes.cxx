// SPDX-License-Identifier: BSD-3-Clause
// Estimates of errors in pictures of real data: by sampling, and by encoding.
#include "Render/Raycast/InterpolateSkippedPixels.h"
#include "Render/Sampling/SamplingPlan.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <optional>
#include <random>
#include <string>

namespace
{

using namespace banyan;

const glm::ivec2 Size{ 200, 150 };

struct Volume
{
  std::string Name;
  glm::ivec3 Samples{ 64 };
  glm::dvec3 Spacing{ 1.0 };
  std::vector<float> Values{};
  double Low = 0.0;
  double High = 1.0;
};

struct Function
{
  const char* Name;
  glm::dvec4 (*Of)(double); ///< over [0, 1]
  bool Steady;              ///< it has no jump, and its opacity does not reach 1
};

glm::dvec4 Ramp(double x)
{
  return { 0.2 + 0.5 * x, 0.3 + 0.5 * std::sin(3.0 * x), 0.8 - 0.7 * x, x };
}

glm::dvec4 BelowOne(double x)
{
  return glm::dvec4(glm::dvec3(Ramp(x)), 0.99 * x);
}

glm::dvec4 Steep(double x)
{
  return { x, 1.0 - x, 0.4, std::fmin(0.8, std::fmax(0.0, 4.0 * (x - 0.2))) };
}

glm::dvec4 Jump(double x)
{
  return { 0.9, 0.8, 0.6, x < 0.3 ? 0.0 : 0.9 };
}

const Function Functions[] = { { "ramp to 1", Ramp, false }, { "ramp to 0.99", BelowOne, true },
  { "steep", Steep, true }, { "jump", Jump, false } };

template <class T>
std::optional<Volume> Read(Volume volume, const std::string& file)
{
  const char* const folder = std::getenv("BANYAN_DATA_DIR");
  std::ifstream in(std::string(folder ? folder : "/") + "/" + file, std::ios::binary);
  const glm::ivec3 n = volume.Samples;
  std::vector<T> values(static_cast<std::size_t>(n.x) * n.y * n.z);
  in.read(reinterpret_cast<char*>(values.data()),
    static_cast<std::streamsize>(values.size() * sizeof(T)));
  if (!folder || !in)
  {
    return std::nullopt;
  }
  volume.Values.assign(values.begin(), values.end());
  volume.Low = *std::min_element(volume.Values.begin(), volume.Values.end());
  volume.High = *std::max_element(volume.Values.begin(), volume.Values.end());
  return volume;
}

std::optional<Volume> Real(int number)
{
  const glm::ivec3 head(64, 64, 93);
  return number == 0   ? Read<std::uint8_t>({ "fuel" }, "fuel/fuel.raw")
         : number == 1 ? Read<std::uint16_t>({ "headsq", head, { 3.2, 3.2, 1.5 } },
                           "headsq_quarter/headsq_quarter.raw")
                       : Read<float>({ "fingers" }, "viscous_fingers_run01/density_025.raw");
}

RayScene SceneOf(const Volume& volume, const Function& function, double cells)
{
  glm::dmat4 toWorld(1.0);
  for (int axis = 0; axis < 3; ++axis)
  {
    toWorld[axis][axis] = volume.Spacing[axis];
  }
  const double cell = std::min({ volume.Spacing.x, volume.Spacing.y, volume.Spacing.z });
  RayScene scene = scenes::Scene(volume.Samples, Size, toWorld);
  scene.Transfer = scenes::Tabulate(function.Of);
  scene.Transfer.Low = volume.Low;
  scene.Transfer.High = volume.High;
  scene.Transfer.UnitDistance = 1.73 * cell;
  scene.SampleDistance = cells * cell;
  return scene;
}

/// Draws values of a volume's scene.
class Drawing
{
public:
  explicit Drawing(const Volume& volume, const std::vector<float>& values)
    : Source(scenes::ArrayOf(values, volume.Samples), 32, { volume.Low - 1, volume.High + 1 }, Pool)
  {
  }
  FloatImage operator()(const RayScene& scene)
  {
    RayStatistics statistics;
    return CastRays(
      scene, this->Source, scene.DomainCells, std::uint64_t{ 1 } << 30, this->Pool, statistics);
  }

private:
  ThreadPool Pool{ 1 };
  ArrayBrickSource Source;
};

/// How far pixels of a picture are off, in 1/255, where one of both has something.
std::vector<double> ErrorsOf(const FloatImage& image, const FloatImage& truth, int every = 1)
{
  const auto at = [](const FloatImage& of, int x, int y)
  {
    const PixelRect pixel{ { x, y }, { x + 1, y + 1 } };
    return Intersection(of.Rect, pixel).Empty() ? glm::vec4(0.0f) : of.At(x, y);
  };
  std::vector<double> errors;
  for (int y = 0; y < Size.y; y += every)
  {
    for (int x = 0; x < Size.x; x += every)
    {
      const glm::vec4 off = 255.0f * glm::abs(at(image, x, y) - at(truth, x, y));
      if (at(image, x, y).a > 0.0f || at(truth, x, y).a > 0.0f)
      {
        errors.push_back(std::max({ off.r, off.g, off.b, off.a }));
      }
    }
  }
  return errors;
}

double Largest(const std::vector<double>& errors)
{
  return errors.empty() ? 0.0 : *std::max_element(errors.begin(), errors.end());
}

double Rms(const std::vector<double>& errors)
{
  double sum = 0.0;
  for (const double error : errors)
  {
    sum += error * error;
  }
  return std::sqrt(sum / std::fmax(1.0, static_cast<double>(errors.size())));
}

class RealVolumes : public testing::TestWithParam<int>
{
};

/// Either the tolerance is kept, or the plan says what keeps it from that. True errors are below
/// the estimate, but for single pixels where the function jumps or its opacity reaches 1.
TEST_P(RealVolumes, KeepTheToleranceOrSayWhatLimitsIt)
{
  const std::optional<Volume> volume = Real(GetParam());
  if (!volume)
  {
    GTEST_SKIP() << "BANYAN_DATA_DIR has no such volume";
  }
  Drawing draw(*volume, volume->Values);
  ThreadPool pool(1);
  for (const Function& function : Functions)
  {
    const RayScene scene = SceneOf(*volume, function, 1.0);
    RayScene fine = scene;
    fine.SampleDistance /= 64.0;
    const FloatImage truth = draw(fine);
    for (const double tolerance : { 0.05, 0.5, 1.0, 4.0 })
    {
      double closest = scene.SampleDistance;
      const SamplingPlan plan = PlanSamplings(scene, { tolerance, scene.SampleDistance },
        [&](const RayScene& probe)
        {
          closest = std::min(closest, probe.Samplings->Samplings().front().Distance);
          return draw(probe);
        });
      RayScene planned = scene;
      planned.Samplings = plan.Samplings;
      planned.OpacityLimit = plan.OpacityLimit;
      FloatImage picture = draw(planned);
      InterpolateSkippedPixels(planned, picture, pool);
      const std::vector<double> errors = ErrorsOf(picture, truth);
      const auto beyond = std::count_if(
        errors.begin(), errors.end(), [&](double error) { return error > plan.EstimatedError; });
      std::printf("%s, %s: tolerance %.2f, estimated %.2f, largest %.2f, beyond %d of %d pixels\n",
        volume->Name.c_str(), function.Name, tolerance, plan.EstimatedError, Largest(errors),
        static_cast<int>(beyond), static_cast<int>(errors.size()));
      EXPECT_EQ(plan.Limit == SamplingLimit::None, plan.EstimatedError <= tolerance);
      if (plan.Limit != SamplingLimit::None)
      {
        EXPECT_EQ(plan.Limit, SamplingLimit::Distance);
        EXPECT_EQ(closest, scene.SampleDistance / 8.0);
      }
      const double single = 0.002 * static_cast<double>(errors.size());
      EXPECT_LE(static_cast<double>(beyond), function.Steady ? 0.0 : single) << function.Name;
    }
  }
}

/// Noise within the bound stands for the error of encoding. Its effect on a picture is not told
/// by drawing probes with all values moved by the bound: that is several times too much in smooth
/// scenes, and much too little where the function jumps.
TEST_P(RealVolumes, ErrorsOfValuesAreNotToldByMovingThemAll)
{
  const std::optional<Volume> volume = Real(GetParam());
  if (!volume)
  {
    GTEST_SKIP() << "BANYAN_DATA_DIR has no such volume";
  }
  for (const Function& function : Functions)
  {
    const RayScene scene = SceneOf(*volume, function, 0.25);
    const FloatImage picture = Drawing(*volume, volume->Values)(scene);
    for (const double part : { 1.0 / 512.0, 1.0 / 4096.0 })
    {
      const double bound = part * (volume->High - volume->Low);
      std::mt19937 random(1);
      std::vector<float> values = volume->Values;
      for (float& value : values)
      {
        value += static_cast<float>(bound * (2.0 * (random() / 4294967296.0) - 1.0));
      }
      const std::vector<double> errors = ErrorsOf(Drawing(*volume, values)(scene), picture);
      RayScene moved = scene;
      moved.Transfer.Low += bound;
      moved.Transfer.High += bound;
      const FloatImage shifted = Drawing(*volume, volume->Values)(moved);
      const double estimate = Largest(ErrorsOf(shifted, picture, 8));
      std::printf("%s, %s: bound 1/%.0f, largest %.2f, RMS %.3f, estimated by moving %.2f\n",
        volume->Name.c_str(), function.Name, 1.0 / part, Largest(errors), Rms(errors), estimate);
      if (function.Steady)
      {
        EXPECT_LE(Largest(errors), 4096.0 * part);
        EXPECT_LE(Rms(errors), 1024.0 * part);
        EXPECT_GT(estimate, Largest(errors));
      }
      else if (function.Of == Jump)
      {
        EXPECT_GT(Largest(errors), 2.0 * estimate);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Data, RealVolumes, testing::Values(0, 1, 2));

} // namespace
