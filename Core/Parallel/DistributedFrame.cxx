#include "Parallel/DistributedFrame.h"

#include "Base/Progress.h"
#include "Base/ThreadPool.h"
#include "Base/Timer.h"
#include "Parallel/LevelZones.h"
#include "Parallel/Rebalance.h"
#include "Render/PixelsBetween.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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
    const PhaseScope phase(Phase::Casting);
    return CastRays(scene, *source, zone, budgetBytes, pool, statistics);
  }
  catch (const std::exception& error)
  {
    failure = error.what();
    return {};
  }
}

/// What a rank tells the others of a frame. Plain numbers: all are sent in one message.
struct Report
{
  double RenderSeconds;
  double CompositeSeconds;
  double TotalSeconds;
  double SamplesTaken;
  double BricksDrawn;
  double BricksUniform;
  double BricksSkipped;
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
  statistics.BytesComposited = static_cast<std::uint64_t>(sum(&Report::BytesComposited));
  statistics.MessagesComposited = static_cast<std::uint64_t>(sum(&Report::MessagesComposited));
}

/// What compositing needs to know of the scene.
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
  if (compositing.AfterCasting)
  {
    compositing.AfterCasting();
  }

  const PhaseScope phase(Phase::Compositing);
  // The order and the footprints depend on what all ranks have alike: no rank fails here alone.
  const std::vector<int> order = OrderAsDrawn(scene, zones);
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
  FillBetweenRays(scene, picture, pool);
  const double compositeSeconds = composite.Seconds();

  const auto number = [](auto value) { return static_cast<double>(value); };
  Publish(communicator,
    { renderSeconds, compositeSeconds, total.Seconds(), number(rays.SamplesTaken),
      number(rays.BricksDrawn), number(rays.BricksUniform), number(rays.BricksSkipped),
      number(sent.BytesSent), number(sent.MessagesSent) },
    statistics);
  return picture;
}

} // namespace banyan
