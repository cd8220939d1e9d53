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
#include "Render/Scene/DepthPicture.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

namespace banyan
{
namespace
{

/// A rank's own part of a frame.
struct OwnPart
{
  BrickSource* Source;
  Box Zone;
  std::uint64_t BudgetBytes;
  ThreadPool& Pool;
  std::string Failure; ///< empty if all is well

  RayStatistics Rays;
  CompositeStatistics Sent;
  double RenderSeconds = 0;
  double CompositeSeconds = 0;
};

/// What all ranks draw for one place.
struct PartOfPicture
{
  const RayScene& Scene; ///< its viewport is that of the place
  const RayScene& Own;   ///< what this rank draws of it
  const std::vector<Box>& Zones;
  const std::vector<PixelRect>& Regions; ///< none where zones divide the picture
  const std::function<void()>& AfterCasting;
};

/// A scene of a part of its viewport.
RayScene PartOf(const RayScene& scene, const PixelRect& rect)
{
  RayScene part = scene;
  part.Viewport = Intersection(scene.Viewport, rect);
  if (!scene.Depth.empty())
  {
    part.Depth = DepthPicture{ {}, scene.Viewport, scene.Depth }.In(part.Viewport);
  }
  return part;
}

/// Casts this rank's rays; a failure becomes a sentence for the others.
/// @param cast CastRays, say: it is given all but the watcher
template <class Function>
FloatImage CastOwn(OwnPart& own, const PartOfPicture& part, const Function& cast)
{
  const Timer timer;
  FloatImage mine;
  if (own.Failure.empty() && own.Source && !own.Zone.Empty() && !part.Own.Viewport.Empty())
  {
    Attempt(own.Failure,
      [&]
      {
        const PhaseScope phase(Phase::Casting);
        mine = cast(part.Own, *own.Source, own.Zone, own.BudgetBytes, own.Pool, own.Rays);
      });
  }
  own.RenderSeconds += timer.Seconds();
  if (part.AfterCasting)
  {
    part.AfterCasting();
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
/// @param root a rank that has pixels
void Publish(Communicator& communicator, const Report& mine, int root, FrameStatistics& statistics)
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
  statistics.ReusedFraction = all[static_cast<std::size_t>(root)].ReusedFraction;
  statistics.BytesComposited = static_cast<std::uint64_t>(sum(&Report::BytesComposited));
  statistics.MessagesComposited = static_cast<std::uint64_t>(sum(&Report::MessagesComposited));
}

/// The order in which pixels of ranks are blended.
std::vector<int> OrderOf(const PartOfPicture& part)
{
  if (part.Regions.empty())
  {
    return OrderAsDrawn(part.Scene, part.Zones);
  }
  std::vector<int> order(part.Regions.size()); // no two ranks have a pixel in common
  std::iota(order.begin(), order.end(), 0);
  return order;
}

/// Completes the options with what compositing needs to know of the picture.
CompositeOptions CompleteOptions(CompositeOptions options, const PartOfPicture& part)
{
  const RayScene& scene = part.Scene;
  options.Combine = CombinationOf(scene.Blend);
  if (part.Regions.empty())
  {
    options.Footprints = FootprintsOfZones(
      scene.Camera, scene.IndexToWorld, ZonesAsDrawn(scene, part.Zones), scene.Viewport);
  }
  else
  {
    options.Footprints.clear();
    for (const PixelRect& region : part.Regions)
    {
      options.Footprints.push_back(
        FootprintOf(Intersection(region, scene.Viewport), scene.Viewport));
    }
  }
  if (scene.Shading.On)
  {
    options.Brightest = std::max(
      options.Brightest, scene.Shading.Ambient + scene.Shading.Diffuse + scene.Shading.Specular);
  }
  return options;
}

/// A rank alone has nothing to composite.
FloatImage CastAlone(OwnPart& own, const PartOfPicture& part)
{
  FloatImage picture = CastOwn(own, part, CastViewport);
  if (picture.Rect.Empty())
  {
    picture.Rect = part.Scene.Viewport;
    picture.Pixels.assign(static_cast<std::size_t>(picture.Rect.Count()), glm::vec4(0.0f));
  }
  return picture;
}

/// @param compositing without what follows from the picture
FloatImage CastThenComposite(Communicator& communicator, OwnPart& own, const PartOfPicture& part,
  const CompositeOptions& compositing)
{
  const RayScene& scene = part.Scene;
  const FloatImage mine = CastOwn(own, part, CastRays);
  const PhaseScope phase(Phase::Compositing);
  // The order and the footprints depend on what all ranks have alike: no rank fails here alone.
  const std::vector<int> order = OrderOf(part);
  CompositeOptions options = CompleteOptions(compositing, part);
  if (own.Failure.empty())
  {
    own.Failure =
      ProblemOf(communicator.Rank(), communicator.Size(), mine, order, scene.Viewport, options);
  }
  ThrowTogether(communicator, own.Failure);
  const Timer timer;
  options.Agreed = true;
  FloatImage picture = Composite(communicator, mine, order, scene.Viewport, options, own.Sent);
  own.CompositeSeconds += timer.Seconds();
  return picture;
}

/// The failure of a rank is agreed upon after the last part.
FloatImage CastAndComposite(Communicator& communicator, OwnPart& own, const PartOfPicture& part,
  const CompositeOptions& compositing)
{
  const RayScene& scene = part.Scene;
  const std::vector<int> order = OrderOf(part);
  const CompositeOptions options = CompleteOptions(compositing, part);
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
  const FloatImage mine = CastOwn(
    own, part, [&](auto&&... arguments) { return CastRaysWatched(arguments..., compositor); });
  const PhaseScope phase(Phase::Compositing);
  const Timer timer;
  if (own.Failure.empty())
  {
    own.Failure = problemOf(mine);
  }
  FloatImage picture = compositor.Finish(own.Failure.empty() ? &mine : nullptr);
  own.CompositeSeconds += timer.Seconds();
  return picture;
}

/// The part of a picture that has a place.
FloatImage Cut(FloatImage picture, const PixelRect& rect)
{
  const PixelRect wanted = Intersection(picture.Rect, rect);
  if (wanted == picture.Rect)
  {
    return picture;
  }
  FloatImage cut{ wanted, PixelVector(static_cast<std::size_t>(wanted.Count())) };
  for (int y = wanted.Lo.y; y < wanted.Hi.y && !wanted.Empty(); ++y)
  {
    std::copy_n(&picture.At(wanted.Lo.x, y), wanted.Size().x, &cut.At(wanted.Lo.x, y));
  }
  return cut;
}

/// What has to be drawn for a place: pixels without rays are made from those around them.
PixelRect WithMargin(const RayScene& scene, const PixelRect& rect)
{
  const int margin = scene.Samplings ? RaySampling::LargestStride : 0;
  return Intersection(scene.Viewport, { rect.Lo - margin, rect.Hi + margin });
}

/// A picture of one place.
/// @param reused on its root, as of PutBackReused
/// @return on its root the part of the scene's viewport that is in the place
FloatImage DrawPlace(Communicator& communicator, OwnPart& own, const PartOfPicture& part,
  const PicturePlace& place, CompositeOptions options, double& reused)
{
  options.Root = place.Root;
  options.Behind = place.Behind;
  const bool whileCasting = options.WhileCasting && communicator.SendsAtOnce();
  FloatImage picture = communicator.Size() == 1 ? CastAlone(own, part)
                       : whileCasting           ? CastAndComposite(communicator, own, part, options)
                                      : CastThenComposite(communicator, own, part, options);
  if (place.Root != communicator.Rank())
  {
    return {};
  }
  const PhaseScope phase(Phase::Compositing);
  const Timer timer;
  FinishPicture(part.Scene, picture);
  reused = PutBackReused(part.Scene, picture, own.Pool);
  InterpolateSkippedPixels(part.Scene, picture, own.Pool);
  picture = Cut(std::move(picture), place.Rect);
  own.CompositeSeconds += timer.Seconds();
  return picture;
}

} // namespace

void FrameStatistics::Add(const FrameStatistics& other)
{
  this->TotalSeconds += other.TotalSeconds;
  this->RenderSeconds += other.RenderSeconds;
  this->CompositeSeconds += other.CompositeSeconds;
  this->ProbeSeconds += other.ProbeSeconds;
  this->StrideSeconds += other.StrideSeconds;
  this->Probes += other.Probes;
  this->Imbalance = std::max(this->Imbalance, other.Imbalance);
  this->SamplesTaken += other.SamplesTaken;
  this->BricksDrawn += other.BricksDrawn;
  this->BricksUniform += other.BricksUniform;
  this->BricksSkipped += other.BricksSkipped;
  this->ReusedFraction = std::min(this->ReusedFraction, other.ReusedFraction);
  this->BytesComposited += other.BytesComposited;
  this->MessagesComposited += other.MessagesComposited;
}

FloatImage DrawDistributed(Communicator& communicator, const RayScene& scene,
  const RankShare& share, FrameStatistics& statistics, const CompositeOptions& compositing,
  const std::vector<PicturePlace>& places)
{
  const Timer total;
  const auto self = static_cast<std::size_t>(communicator.Rank());
  const bool byPicture = !share.Regions.empty();
  OwnPart own{ share.Source, byPicture ? scene.DomainCells : share.Zones.at(self),
    share.BudgetBytes, share.Pool, share.Failure, {}, {} };
  const std::vector<PicturePlace> all =
    places.empty() ? std::vector<PicturePlace>{ { scene.Viewport, 0, compositing.Behind } }
                   : places;
  FloatImage result;
  double reused = 0.0;
  std::vector<const PicturePlace*> shown;
  for (const PicturePlace& place : all)
  {
    if (!WithMargin(scene, place.Rect).Empty())
    {
      shown.push_back(&place);
    }
  }
  bool begun = false; // whether this rank has cast a part
  for (const PicturePlace* const at : shown)
  {
    const PicturePlace& place = *at;
    const PixelRect rect = WithMargin(scene, place.Rect);
    std::optional<RayScene> ofPlace;
    std::optional<RayScene> ofRegion;
    const RayScene& drawn = rect == scene.Viewport ? scene : ofPlace.emplace(PartOf(scene, rect));
    if (ofPlace)
    {
      ofPlace->GoesOn = begun;
    }
    const RayScene& mine =
      byPicture ? ofRegion.emplace(PartOf(drawn, share.Regions.at(self))) : drawn;
    static const std::function<void()> nothing;
    begun = begun || !mine.Viewport.Empty();
    const PartOfPicture part{ drawn, mine, share.Zones, share.Regions,
      at == shown.back() ? compositing.AfterCasting : nothing };
    FloatImage picture = DrawPlace(communicator, own, part, place, compositing, reused);
    if (place.Root == communicator.Rank())
    {
      result = std::move(picture);
    }
  }
  ThrowTogether(communicator, own.Failure);

  const auto number = [](auto value) { return static_cast<double>(value); };
  const RayStatistics& rays = own.Rays;
  Publish(communicator,
    { own.RenderSeconds, own.CompositeSeconds, total.Seconds(), number(rays.SamplesTaken),
      number(rays.BricksDrawn), number(rays.BricksUniform), number(rays.BricksSkipped), reused,
      number(own.Sent.BytesSent), number(own.Sent.MessagesSent) },
    all.front().Root, statistics);
  return result;
}

} // namespace banyan
