// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Frame/DistributedFrame.h"

#include "Base/Progress.h"
#include "Base/ThreadPool.h"
#include "Base/Timer.h"
#include "Parallel/Balance/LevelZones.h"
#include "Parallel/Balance/Rebalance.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Composite/CompositeWhileCasting.h"
#include "Render/Raycast/InterpolateSkippedPixels.h"
#include "Render/Raycast/PutBackReused.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace banyan
{
namespace
{

/// A rank's own part of a frame.
struct OwnPart
{
  const RayScene& Scene;
  BrickSource* Source;
  Box Zone;
  std::uint64_t BudgetBytes;
  ThreadPool& Pool;
  std::string Failure; ///< empty if all is well
  const std::function<void()>& AfterCasting;

  RayStatistics Rays;
  CompositeStatistics Sent;
  double RenderSeconds = 0;
  double CompositeSeconds = 0;
};

/// Casts this rank's rays; a failure becomes a sentence for the others.
/// @param cast CastRays, say: it is given all but the watcher
template <class Function>
FloatImage CastOwnZone(OwnPart& own, const Function& cast)
{
  const Timer timer;
  FloatImage mine;
  Attempt(own.Failure,
    [&]
    {
      if (own.Source && !own.Zone.Empty())
      {
        const PhaseScope phase(Phase::Casting);
        mine = cast(own.Scene, *own.Source, own.Zone, own.BudgetBytes, own.Pool, own.Rays);
      }
    });
  own.RenderSeconds = timer.Seconds();
  if (own.AfterCasting)
  {
    own.AfterCasting();
  }
  return mine;
}

/// Is told by a rank to the others about a frame. It has plain numbers: all are sent in one
/// message.
struct Report
{
  double RenderSeconds;
  double CompositeSeconds;
  double TotalSeconds;
  double SamplesTaken;
  double BricksDrawn;
  double BricksUniform;
  double BricksSkipped;
  double ReusedFraction;
  double BytesComposited;
  double MessagesComposited;
};

/// Collective.
void Publish(Communicator& communicator, const Report& mine, FrameStatistics& statistics)
{
  std::vector<Report> all(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&mine, sizeof(mine), all.data());
  const auto values = [&all](double Report::*of)
  {
    std::vector<double> list;
    list.reserve(all.size());
    for (const Report& report : all)
    {
      list.push_back(report.*of);
    }
    return list;
  };
  const auto largest = [&values](double Report::*of)
  {
    const std::vector<double> list = values(of);
    return *std::max_element(list.begin(), list.end());
  };
  const auto sum = [&values](double Report::*of)
  {
    const std::vector<double> list = values(of);
    return std::llround(std::accumulate(list.begin(), list.end(), 0.0));
  };
  statistics.RenderSeconds = largest(&Report::RenderSeconds);
  statistics.Imbalance = ImbalanceOf(values(&Report::RenderSeconds));
  statistics.CompositeSeconds = largest(&Report::CompositeSeconds);
  statistics.TotalSeconds = largest(&Report::TotalSeconds);
  statistics.SamplesTaken = sum(&Report::SamplesTaken);
  statistics.BricksDrawn = sum(&Report::BricksDrawn);
  statistics.BricksUniform = sum(&Report::BricksUniform);
  statistics.BricksSkipped = sum(&Report::BricksSkipped);
  statistics.ReusedFraction = all.front().ReusedFraction;
  statistics.BytesComposited = static_cast<std::uint64_t>(sum(&Report::BytesComposited));
  statistics.MessagesComposited = static_cast<std::uint64_t>(sum(&Report::MessagesComposited));
}

/// Completes the options with what compositing needs to know of the scene.
CompositeOptions CompleteOptions(
  CompositeOptions options, const RayScene& scene, const std::vector<Box>& zones)
{
  options.Combine = CombinationOf(scene.Blend);
  options.Footprints =
    FootprintsOfZones(scene.Camera, scene.IndexToWorld, ZonesAsDrawn(scene, zones), scene.Viewport);
  if (scene.Shading.On)
  {
    options.Brightest = std::max(
      options.Brightest, scene.Shading.Ambient + scene.Shading.Diffuse + scene.Shading.Specular);
  }
  return options;
}

/// A rank alone has nothing to composite.
FloatImage CastAlone(Communicator& communicator, OwnPart& own)
{
  FloatImage picture = CastOwnZone(own, CastViewport);
  ThrowTogether(communicator, own.Failure);
  if (picture.Rect.Empty())
  {
    picture.Rect = own.Scene.Viewport;
    picture.Pixels.assign(static_cast<std::size_t>(picture.Rect.Count()), glm::vec4(0.0f));
  }
  return picture;
}

/// @param compositing without what follows from the scene and the zones
FloatImage CastThenComposite(Communicator& communicator, OwnPart& own,
  const std::vector<Box>& zones, const CompositeOptions& compositing)
{
  const RayScene& scene = own.Scene;
  const FloatImage mine = CastOwnZone(own, CastRays);
  const PhaseScope phase(Phase::Compositing);
  // The order and the footprints depend on what all ranks have alike: no rank fails here alone.
  const std::vector<int> order = OrderAsDrawn(scene, zones);
  CompositeOptions options = CompleteOptions(compositing, scene, zones);
  if (own.Failure.empty())
  {
    own.Failure =
      ProblemOf(communicator.Rank(), communicator.Size(), mine, order, scene.Viewport, options);
  }
  ThrowTogether(communicator, own.Failure);
  const Timer timer;
  options.Agreed = true;
  FloatImage picture = Composite(communicator, mine, order, scene.Viewport, options, own.Sent);
  own.CompositeSeconds = timer.Seconds();
  return picture;
}

FloatImage CastAndComposite(Communicator& communicator, OwnPart& own, const std::vector<Box>& zones,
  const CompositeOptions& compositing)
{
  const RayScene& scene = own.Scene;
  const std::vector<int> order = OrderAsDrawn(scene, zones);
  const CompositeOptions options = CompleteOptions(compositing, scene, zones);
  const auto problemOf = [&](const FloatImage& image)
  {
    return ProblemOf(
      communicator.Rank(), communicator.Size(), image, order, scene.Viewport, options);
  };
  // All ranks have this alike, so that all are here or none is.
  const std::string problem = problemOf({});
  if (!problem.empty())
  {
    ThrowTogether(communicator, problem);
  }
  CompositeWhileCasting compositor(communicator, order, scene.Viewport, options, own.Sent);
  const FloatImage mine = CastOwnZone(
    own, [&](auto&&... arguments) { return CastRaysWatched(arguments..., compositor); });
  const PhaseScope phase(Phase::Compositing);
  const Timer timer;
  if (own.Failure.empty())
  {
    own.Failure = problemOf(mine);
  }
  FloatImage picture = compositor.Finish(own.Failure.empty() ? &mine : nullptr);
  ThrowTogether(communicator, own.Failure);
  own.CompositeSeconds = timer.Seconds();
  return picture;
}

} // namespace

FloatImage DrawDistributed(Communicator& communicator, const RayScene& scene,
  const RankShare& share, FrameStatistics& statistics, const CompositeOptions& compositing)
{
  const Timer total;
  const std::vector<Box>& zones = share.Zones;
  OwnPart own{ scene, share.Source, zones.at(static_cast<std::size_t>(communicator.Rank())),
    share.BudgetBytes, share.Pool, share.Failure, compositing.AfterCasting, {}, {} };
  FloatImage picture = communicator.Size() == 1 ? CastAlone(communicator, own)
                       : compositing.WhileCasting && communicator.SendsAtOnce()
                         ? CastAndComposite(communicator, own, zones, compositing)
                         : CastThenComposite(communicator, own, zones, compositing);
  const PhaseScope phase(Phase::Compositing);
  const Timer finish;
  FinishPicture(scene, picture);
  const double reused = PutBackReused(scene, picture, share.Pool);
  InterpolateSkippedPixels(scene, picture, share.Pool);
  own.CompositeSeconds += finish.Seconds();

  const auto number = [](auto value) { return static_cast<double>(value); };
  const RayStatistics& rays = own.Rays;
  Publish(communicator,
    { own.RenderSeconds, own.CompositeSeconds, total.Seconds(), number(rays.SamplesTaken),
      number(rays.BricksDrawn), number(rays.BricksUniform), number(rays.BricksSkipped), reused,
      number(own.Sent.BytesSent), number(own.Sent.MessagesSent) },
    statistics);
  return picture;
}

} // namespace banyan
