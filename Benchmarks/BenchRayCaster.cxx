// SPDX-License-Identifier: BSD-3-Clause
// Milliseconds per frame of the ray caster on the project's standard scenes, as CSV.
//
//   BanyanBenchRayCaster [N [PICTURE [THREADS [REPETITIONS]]]]
//
// N^3 samples (default 256) of the standard field, PICTURE^2 pixels (default 1024), unit spacing,
// one sample per voxel. Processor time says more than the clock on a machine that others use. S1:
// everything is faintly visible; S2: nine voxels in ten are invisible. Then S1 with nearest
// interpolation, and its maximum and average along rays. The rows `flat` are of a field whose lower
// values are all the same, so that many bricks are of one value (macro voxels, column
// bricks_uniform); those of `flat-sampled` take samples there all the same.
#include "Base/Timer.h"
#include "Render/Scenes.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

namespace
{

using namespace banyan;

constexpr float FlatBelow = 0.3f;

TransferFunction StandardFunction(bool sparse)
{
  constexpr int entries = 256;
  const double pi = std::acos(-1.0);
  TransferFunction function;
  for (int i = 0; i < entries; ++i)
  {
    const double x = i / (entries - 1.0);
    const double threshold = 64.0 / (entries - 1.0);
    const double faint = 0.001 + 0.019 * x;
    const double strong = i < 64 ? 0.0 : 0.02 + 0.28 * (x - threshold) / (1.0 - threshold);
    function.Entries.emplace_back(0.5 + 0.5 * std::cos(2 * pi * (0.9 * x)),
      0.5 + 0.5 * std::cos(2 * pi * (0.9 * x + 0.33)),
      0.5 + 0.5 * std::cos(2 * pi * (0.9 * x + 0.67)), sparse ? strong : faint);
  }
  return function;
}

RayScene StandardScene(int n, int picture, bool sparse)
{
  const double length = n - 1.0;
  const glm::dvec3 centre(0.5 * length);
  const glm::dvec3 eye = centre + 1.9 * length * glm::dvec3(0.48, 0.36, 0.80);
  const glm::dmat4 view = glm::lookAt(eye, centre, glm::dvec3(0, 1, 0));
  const glm::dmat4 projection =
    glm::perspective(std::acos(-1.0) / 4.0, 1.0, 0.5 * length, 4.0 * length);
  RayScene scene{ RayCamera(projection * view, glm::ivec2(picture), centre),
    { { 0, 0 }, glm::ivec2(picture) }, glm::dmat4(1.0), { glm::ivec3(0), glm::ivec3(n - 1) },
    StandardFunction(sparse), 1.0, 0.99f, {} };
  scene.Transfer.UnitDistance = length / 255.0;
  return scene;
}

constexpr const char* Scenes[] = { "S1", "S2", "nearest", "maximum", "average" };

RayScene NamedScene(const std::string& name, int n, int picture)
{
  RayScene scene = StandardScene(n, picture, name == "S2");
  scene.Interpolation =
    name == "nearest" ? SampleInterpolation::Nearest : SampleInterpolation::Linear;
  scene.Blend.Mode = name == "maximum"   ? BlendMode::Maximum
                     : name == "average" ? BlendMode::Average
                                         : BlendMode::Composite;
  return scene;
}

/// Takes samples in bricks of one value, too.
class SampledSource : public ArrayBrickSource
{
public:
  using ArrayBrickSource::ArrayBrickSource;
  std::optional<UniformValue> UniformValueOf(std::int64_t) const override { return std::nullopt; }
};

template <class Source = ArrayBrickSource, class T>
void Measure(const char* type, const std::vector<T>& values, int n, double high,
  const std::vector<int>& options, ThreadPool& pool)
{
  const glm::ivec3 samples(n);
  for (const int brickCells : { 16, 32 })
  {
    Timer timer;
    Source source(scenes::ArrayOf(values, samples), brickCells, { 0.0, high }, pool);
    const double setUp = timer.Seconds();
    for (const char* name : Scenes)
    {
      RayScene scene = NamedScene(name, n, options[1]);
      scene.Transfer.High = high;
      std::vector<double> seconds;
      std::vector<double> cpuSeconds;
      RayStatistics statistics;
      for (int i = 0; i < options[3]; ++i)
      {
        statistics = {};
        timer.Restart();
        const std::clock_t cpu = std::clock();
        CastRays(scene, source, scene.DomainCells, ~std::uint64_t{ 0 }, pool, statistics);
        seconds.push_back(timer.Seconds());
        cpuSeconds.push_back(static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC);
      }
      std::sort(cpuSeconds.begin(), cpuSeconds.end());
      std::sort(seconds.begin(), seconds.end());
      const double median = seconds[seconds.size() / 2];
      const auto taken = static_cast<double>(statistics.SamplesTaken);
      std::printf("%s,%d,%d,%s,%d,%.1f,%.1f,%.1f,%.2f,%.1f,%lld,%lld,%lld\n", type, n, brickCells,
        name, pool.Width(), 1e3 * setUp, 1e3 * median, 1e3 * seconds.front(),
        1e9 * cpuSeconds[cpuSeconds.size() / 2] / taken, 1e-6 * taken,
        static_cast<long long>(statistics.BricksDrawn),
        static_cast<long long>(statistics.BricksSkipped),
        static_cast<long long>(statistics.BricksUniform));
    }
  }
}

} // namespace

int main(int argc, char** argv)
{
  std::vector<int> options = { 256, 1024, ThreadPool::DefaultWidth(), 9 };
  for (int i = 1; i < argc && i <= 4; ++i)
  {
    options[i - 1] = std::max(1, std::atoi(argv[i]));
  }
  const int n = std::max(2, options[0]);
  ThreadPool pool(options[2]);
  std::vector<float> values(static_cast<std::size_t>(n) * n * n);
  pool.ParallelFor(n,
    [&](std::int64_t z)
    {
      for (int y = 0; y < n; ++y)
      {
        for (int x = 0; x < n; ++x)
        {
          values[x + n * (y + n * static_cast<std::size_t>(z))] =
            static_cast<float>(scenes::Standard(glm::dvec3(x, y, z) / (n - 1.0)));
        }
      }
    });
  std::printf("type,n,brick_cells,scene,threads,set_up_ms,median_ms,best_ms,"
              "cpu_ns_per_sample,million_samples,bricks_drawn,bricks_skipped,bricks_uniform\n");
  Measure("float32", values, n, 1.0, options, pool);
  std::vector<float> flat(values.size());
  std::transform(values.begin(), values.end(), flat.begin(),
    [](float value) { return std::max(value, FlatBelow); });
  Measure("flat", flat, n, 1.0, options, pool);
  Measure<SampledSource>("flat-sampled", flat, n, 1.0, options, pool);
  std::vector<std::uint8_t> bytes(values.size());
  std::transform(values.begin(), values.end(), bytes.begin(),
    [](float value) { return static_cast<std::uint8_t>(value * 255.0f + 0.5f); });
  Measure("uint8", bytes, n, 255.0, options, pool);
  return 0;
}
