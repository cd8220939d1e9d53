#include "Parallel/DistributedFrame.h"

#include "Base/ThreadPool.h"
#include "Base/Timer.h"
#include "Parallel/Zones.h"
#include "Render/Viewpoint.h"

#include <algorithm>

namespace banyan
{
namespace
{

/// Casts this rank's rays; a failure becomes a sentence for the others.
FloatImage CastOwnZone(const RayScene& scene, BrickSource* source, const Box& zone,
  std::uint64_t budgetBytes, ThreadPool& pool, RayStatistics& statistics, std::string& failure)
{
  if (!failure.empty() || source == nullptr || zone.Empty())
  {
    return {};
  }
  try
  {
    return CastRays(scene, *source, zone, budgetBytes, pool, statistics);
  }
  catch (const std::exception& error)
  {
    failure = error.what();
    return {};
  }
}

/// Slowest over mean of the ranks' seconds.
double ImbalanceOf(const std::vector<double>& seconds)
{
  double sum = 0.0;
  double largest = 0.0;
  for (const double value : seconds)
  {
    sum += value;
    largest = std::max(largest, value);
  }
  return sum > 0.0 ? largest * static_cast<double>(seconds.size()) / sum : 1.0;
}

/// What compositing needs to know of the scene.
CompositeOptions CompleteOptions(
  CompositeOptions options, const RayScene& scene, const std::vector<Box>& zones)
{
  options.Combine = CombinationOf(scene.Blend);
  options.Footprints = FootprintsOfZones(scene.Camera, scene.IndexToWorld, zones, scene.Viewport);
  if (scene.Shading.On)
  {
    options.Brightest = std::max(
      options.Brightest, scene.Shading.Ambient + scene.Shading.Diffuse + scene.Shading.Specular);
  }
  return options;
}

} // namespace

FloatImage DrawDistributed(Communicator& communicator, const RayScene& scene, BrickSource* source,
  const std::vector<Box>& zones, std::uint64_t budgetBytes, ThreadPool& pool,
  const std::string& localError, FrameStatistics& statistics, const CompositeOptions& compositing)
{
  const Timer total;
  const Timer render;
  RayStatistics rays;
  std::string failure = localError;
  const Box zone = zones.at(static_cast<std::size_t>(communicator.Rank()));
  const FloatImage mine = CastOwnZone(scene, source, zone, budgetBytes, pool, rays, failure);
  const double renderSeconds = render.Seconds();

  // The order and the footprints depend on what all ranks have alike: no rank fails here alone.
  const std::vector<int> order = FrontToBack(InIndexSpace(scene.Camera, scene.IndexToWorld), zones);
  CompositeOptions options = CompleteOptions(compositing, scene, zones);
  if (failure.empty())
  {
    failure =
      ProblemOf(communicator.Rank(), communicator.Size(), mine, order, scene.Viewport, options);
  }
  const std::string agreed = AgreeOnError(communicator, failure);
  if (!agreed.empty())
  {
    throw Error(agreed);
  }

  const Timer composite;
  CompositeStatistics sent;
  options.Agreed = true;
  FloatImage picture = Composite(communicator, mine, order, scene.Viewport, options, sent);
  FinishPicture(scene, picture);
  const double compositeSeconds = composite.Seconds();

  const std::vector<double> allRender = AllGatherValues(communicator, renderSeconds);
  statistics.RenderSeconds = *std::max_element(allRender.begin(), allRender.end());
  statistics.Imbalance = ImbalanceOf(allRender);
  statistics.CompositeSeconds = AllMax(communicator, compositeSeconds);
  statistics.TotalSeconds = AllMax(communicator, total.Seconds());
  const auto sum = [&communicator](auto value)
  { return static_cast<decltype(value)>(AllSum(communicator, static_cast<double>(value))); };
  statistics.SamplesTaken = sum(rays.SamplesTaken);
  statistics.BricksDrawn = sum(rays.BricksDrawn);
  statistics.BricksUniform = sum(rays.BricksUniform);
  statistics.BricksSkipped = sum(rays.BricksSkipped);
  statistics.BytesComposited = sum(sent.BytesSent);
  statistics.MessagesComposited = sum(sent.MessagesSent);
  return picture;
}

} // namespace banyan
