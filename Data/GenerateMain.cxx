#include "FlowSimulation.h"
#include "GenerateOptions.h"
#include "HotBlobs.h"
#include "ImageSeriesWriter.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Base/Timer.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>

namespace
{

constexpr double BoxEdge = 6.283185307179586;

banyan::FlowParameters ParametersFor(int size)
{
  banyan::FlowParameters parameters;
  // The finest eddies must not be finer than the grid. They shrink as Reynolds^(-3/4)
  // (Kolmogorov), so the viscosity that a grid carries goes with size^(-4/3).
  parameters.Viscosity = static_cast<float>(0.0045 * std::pow(size / 64.0, -4.0 / 3.0));
  parameters.Diffusivity = parameters.Viscosity;
  return parameters;
}

banyan::ImageArray Gather(const banyan::FlowSimulation& flow, const std::string& name)
{
  banyan::ImageArray array;
  array.Name = name;
  if (name == "temperature")
  {
    array.Values = flow.Temperature();
    return array;
  }
  const auto vectors = name == "velocity" ? flow.Velocity() : flow.Vorticity();
  array.Components = name == "velocity" ? 3 : 1;
  const std::size_t count = vectors[0].size();
  array.Values.resize(count * array.Components);
  for (std::size_t i = 0; i < count; ++i)
  {
    const float x = vectors[0][i], y = vectors[1][i], z = vectors[2][i];
    if (name == "velocity")
    {
      array.Values[3 * i] = x;
      array.Values[3 * i + 1] = y;
      array.Values[3 * i + 2] = z;
    }
    else
    {
      array.Values[i] = std::sqrt(x * x + y * y + z * z);
    }
  }
  return array;
}

void Generate(const banyan::GenerateOptions& options)
{
  banyan::ThreadPool pool(
    options.Threads > 0 ? options.Threads : banyan::ThreadPool::DefaultWidth());
  banyan::ImageSeriesWriter writer(options.Output, "flow", options.Size, BoxEdge);
  banyan::FlowSimulation flow(options.Size, ParametersFor(options.Size), pool);
  const banyan::HotBlobs blobs(options.Seed, static_cast<float>(2.0 * BoxEdge / options.Size));
  const auto still = [](float, float, float) { return 0.0f; };
  flow.SetState(
    { still, still, still }, [&](float x, float y, float z) { return blobs.Temperature(x, y, z); });

  const banyan::Timer timer;
  for (int step = 0; step < options.Steps; ++step)
  {
    const double time =
      options.Steps > 1 ? options.Duration * step / (options.Steps - 1) : options.Duration;
    flow.AdvanceTo(time);
    std::vector<banyan::ImageArray> arrays;
    for (const std::string& name : options.Arrays)
    {
      arrays.push_back(Gather(flow, name));
    }
    writer.AddStep(time, arrays);
    std::fprintf(stderr, "step %d of %d, time %.3f, %lld flow steps, %.1f s\n", step + 1,
      options.Steps, time, static_cast<long long>(flow.StepsTaken()), timer.Seconds());
  }
  writer.Finish();
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    const banyan::GenerateOptions options = banyan::ParseGenerateOptions({ argv + 1, argv + argc });
    if (options.Help)
    {
      std::fputs(banyan::GenerateHelp().c_str(), stdout);
      return EXIT_SUCCESS;
    }
    Generate(options);
    return EXIT_SUCCESS;
  }
  catch (const std::bad_alloc&)
  {
    std::fprintf(stderr, "banyan-generate: There is not enough memory for this --size.\n");
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "banyan-generate: %s\n", error.what());
  }
  return EXIT_FAILURE;
}
