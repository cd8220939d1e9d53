// SPDX-License-Identifier: BSD-3-Clause
// However zones are balanced, however pixels travel, and with however many threads, the picture is
// that of one rank.
#include "MpiProgram.h"

#include "Parallel/Balance/FrameBalancer.h"
#include "Parallel/Frame/DistributedFrame.h"
#include "Render/Scenes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace
{

using namespace banyan;
using namespace banyan::testing;

constexpr int Frames = 3;
constexpr int BrickCells = 8;
constexpr std::uint64_t Budget = 4u << 20;
const glm::ivec3 Samples{ 29, 23, 26 };
/// Odd, and of several chunks and strips for each rank.
const glm::ivec2 Size{ 75, 53 };

/// The whole volume, the eye near it, and a parallel camera. No ray ends early: what is left out
/// then depends on the zones.
RayScene SceneOfFrame(int frame)
{
  static const double distances[] = { 1.4, 0.5, 1.1 };
  RayScene scene = scenes::Scene(Samples, Size, glm::dmat4(1.0), distances[frame], frame == 2);
  scene.Transfer = scenes::Tabulate(scenes::Sparse);
  scene.Shading.On = frame == 1;
  return scene;
}

struct Way
{
  LoadBalancing Mode = LoadBalancing::Off;
  PixelTransport Transport = PixelTransport::Floats;
  int Threads = 1;

  std::string Name() const
  {
    return "balancing " + std::to_string(static_cast<int>(this->Mode)) + ", transport " +
           std::to_string(static_cast<int>(this->Transport)) + ", " +
           std::to_string(this->Threads) + " threads";
  }
};

/// @return on the first rank, the frames
std::vector<FloatImage> DrawFrames(
  Communicator& communicator, const std::vector<float>& values, const Way& way)
{
  ThreadPool pool(way.Threads);
  ArrayBrickSource source(
    scenes::ArrayOf(values, Samples), BrickCells, MaskRange{ 0.0, 1.0 }, pool);
  FrameBalancer balancer;
  FrameBalancer::Field field;
  field.Cells = Samples - 1;
  field.BrickCells = BrickCells;
  balancer.Start(way.Mode, field, communicator.Size());
  CompositeOptions compositing;
  compositing.Transport = way.Transport;
  std::vector<FloatImage> pictures;
  for (int frame = 0; frame < Frames; ++frame)
  {
    RayScene scene = SceneOfFrame(frame);
    balancer.BeginFrame(scene, source);
    FrameStatistics statistics;
    pictures.push_back(DrawDistributed(
      communicator, scene, { &source, balancer.Zones(), Budget, pool }, statistics, compositing));
    balancer.EndFrame(communicator);
  }
  return pictures;
}

/// @return the largest difference of two pictures; if `bytes`, once rounded, in steps of 1 / 255
double DifferenceOf(const FloatImage& a, const FloatImage& b, bool bytes)
{
  if (!(a.Rect == b.Rect) || a.Pixels.size() != b.Pixels.size())
  {
    return 1e30;
  }
  double most = 0.0;
  for (std::size_t i = 0; i < a.Pixels.size(); ++i)
  {
    for (int c = 0; c < 4; ++c)
    {
      const double x = a.Pixels[i][c];
      const double y = b.Pixels[i][c];
      const double away =
        bytes ? std::abs(std::round(255.0 * x) - std::round(255.0 * y)) : std::abs(x - y);
      most = std::max(most, std::isfinite(away) ? away : 1e30);
    }
  }
  return most;
}

/// Draws a few frames balanced or not, as floats and in few bits, with one thread per rank and with
/// several, and compares all of them with those that one rank with one thread draws: floats within
/// 1e-5, few bits within 1 of 255. Collective.
/// @return what is wrong, or an empty string; only the first rank knows, and prints what it
/// compared
std::string CheckEveryPicture(Communicator& communicator)
{
  const std::vector<float> values = scenes::Sampled<float>(scenes::Standard, Samples);
  const auto alone = MakeSelfCommunicator();
  const std::vector<FloatImage> right = DrawFrames(*alone, values, {});
  std::string wrong;
  int count = 0;
  double farthest = 0.0; ///< of floats
  const auto check = [&](const Way& way)
  {
    const std::vector<FloatImage> drawn = DrawFrames(communicator, values, way);
    for (std::size_t frame = 0; frame < drawn.size() && communicator.Rank() == 0; ++frame)
    {
      const bool floats = way.Transport == PixelTransport::Floats;
      const double away = DifferenceOf(right[frame], drawn[frame], !floats);
      ++count;
      farthest = std::max(farthest, floats ? away : 0.0);
      if (away > (floats ? 1e-5 : 1.0))
      {
        wrong += "frame " + std::to_string(frame) + " is off by " + std::to_string(away) + ": " +
                 way.Name() + "\n";
      }
    }
  };
  for (const LoadBalancing mode : { LoadBalancing::Off, LoadBalancing::MeasuredCost })
  {
    for (const PixelTransport transport : { PixelTransport::Floats, PixelTransport::WithinOne })
    {
      for (const int threads : { 1, 2, 5 })
      {
        check({ mode, transport, threads });
      }
    }
  }
  if (communicator.Rank() == 0)
  {
    std::printf(
      "%d frames on %d ranks; floats off by %g at most\n", count, communicator.Size(), farthest);
  }
  return wrong;
}

} // namespace

int main(int argc, char** argv)
{
  return RunOnMpiRanks(argc, argv, 75,
    [&](Communicator& communicator)
    {
      const std::string wrong = CheckRankCount(communicator, argc, argv);
      return wrong.empty() ? CheckEveryPicture(communicator) : wrong;
    });
}
