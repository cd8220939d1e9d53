// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Frame/DistributedFrame.h"

#include "Base/Progress.h"
#include "Base/ThreadPool.h"
#include "Base/Timer.h"
#include "Parallel/Balance/LevelZones.h"
#include "Parallel/Cells/DrawPieces.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Composite/CompositeWhileCasting.h"
#include "Render/Raycast/InterpolateSkippedPixels.h"
#include "Render/Raycast/PutBackReused.h"
#include "Render/Scene/DepthPicture.h"

#include <algorithm>
#include <iterator>
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

/// The failure of a rank is agreed upon after the last chunk.
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

/// What a place's own rank does with its picture.
/// @param reused as of PutBackReused
/// @return the part of the scene's viewport that is in the place
FloatImage Finished(
  OwnPart& own, const RayScene& scene, FloatImage picture, const PixelRect& rect, double& reused)
{
  const PhaseScope phase(Phase::Compositing);
  const Timer timer;
  FinishPicture(scene, picture);
  reused = PutBackReused(scene, picture, own.Pool);
  InterpolateSkippedPixels(scene, picture, own.Pool);
  picture = Cut(std::move(picture), rect);
  own.CompositeSeconds += timer.Seconds();
  return picture;
}

/// The scenes of one place: of all ranks, and of this one's part.
class PlaceScenes
{
public:
  /// @param goesOn whether this rank has cast for another place of the picture
  PlaceScenes(const RayScene& scene, const PicturePlace& place, const RankShare& share,
    std::size_t self, bool goesOn = false)
    : Share(share)
  {
    const PixelRect rect = WithMargin(scene, place.Rect);
    this->All = &scene;
    if (!(rect == scene.Viewport))
    {
      this->OfPlace.emplace(PartOf(scene, rect)).GoesOn = goesOn;
      this->All = &*this->OfPlace;
    }
    this->Mine = share.Regions.empty()
                   ? this->All
                   : &this->OfRegion.emplace(PartOf(*this->All, share.Regions.at(self)));
  }
  PlaceScenes(const PlaceScenes&) = delete;
  PlaceScenes& operator=(const PlaceScenes&) = delete;

  PartOfPicture Part(const std::function<void()>& afterCasting) const
  {
    return { *this->All, *this->Mine, this->Share.Zones, this->Share.Regions, afterCasting };
  }
  const RayScene& Drawn() const { return *this->All; }

private:
  const RankShare& Share;
  std::optional<RayScene> OfPlace;
  std::optional<RayScene> OfRegion;
  const RayScene* All;
  const RayScene* Mine;
};

/// What all ranks draw, and for which places.
struct DrawnPlaces
{
  const RayScene& Scene;
  const RankShare& Share;
  const std::vector<PicturePlace>& Places; ///< that show anything
  const CompositeOptions& Compositing;     ///< without what follows from a place
  std::size_t Self;

  PlaceScenes ScenesOf(const PicturePlace& place, bool goesOn = false) const
  {
    return { this->Scene, place, this->Share, this->Self, goesOn };
  }
  CompositeOptions OptionsOf(const PicturePlace& place) const
  {
    CompositeOptions options = this->Compositing;
    options.Root = place.Root;
    options.Behind = place.Behind;
    return options;
  }
};

/// Collective: casts for as many places as memory allows, one after the other, before any of them
/// is composited. So nobody waits between places for who has more to cast there.
/// @return a picture for each place; empty on ranks without it
std::vector<FloatImage> CastThenComposite(
  Communicator& communicator, OwnPart& own, const DrawnPlaces& drawn)
{
  static const std::function<void()> nothing;
  const std::size_t count = drawn.Places.size();
  std::vector<FloatImage> cast(count); // referred to
  std::vector<PictureOfRanks> pictures;
  for (std::size_t i = 0; i < count; ++i)
  {
    const PlaceScenes scenes = drawn.ScenesOf(drawn.Places[i]);
    const PartOfPicture part = scenes.Part(nothing);
    pictures.push_back({ cast[i], OrderOf(part), part.Scene.Viewport,
      CompleteOptions(drawn.OptionsOf(drawn.Places[i]), part) });
  }
  std::vector<FloatImage> composited;
  bool begun = false;
  for (std::size_t first = 0, end = 0; first < count; first = end)
  {
    end = EndOfBatch(pictures, first, drawn.Compositing.MostBytes);
    for (std::size_t i = first; i < end; ++i)
    {
      const PlaceScenes scenes = drawn.ScenesOf(drawn.Places[i], begun);
      const PartOfPicture part =
        scenes.Part(i + 1 == count ? drawn.Compositing.AfterCasting : nothing);
      cast[i] = CastOwn(own, part, CastRays);
      begun = begun || !part.Own.Viewport.Empty();
      if (own.Failure.empty())
      {
        own.Failure = ProblemOf(communicator.Rank(), communicator.Size(), cast[i],
          pictures[i].FrontToBack, pictures[i].Viewport, pictures[i].Options);
      }
    }
    ThrowTogether(communicator, own.Failure);
    const PhaseScope phase(Phase::Compositing);
    const Timer timer;
    const auto at = [&pictures](std::size_t number)
    { return std::next(pictures.begin(), static_cast<std::ptrdiff_t>(number)); };
    std::vector<FloatImage> batch =
      CompositeTogether(communicator, { at(first), at(end) }, own.Sent);
    std::move(batch.begin(), batch.end(), std::back_inserter(composited));
    std::fill(cast.begin(), cast.end(), FloatImage{});
    own.CompositeSeconds += timer.Seconds();
  }
  return composited;
}

/// Collective: draws pieces of a mesh.
/// @return as CastThenComposite
std::vector<FloatImage> DrawPiecesOfPlaces(
  Communicator& communicator, OwnPart& own, const DrawnPlaces& drawn)
{
  const Timer total;
  const PhaseScope phase(Phase::Casting);
  ThrowTogether(communicator, own.Failure);
  PieceStatistics statistics;
  std::vector<FloatImage> pictures;
  for (const PicturePlace& place : drawn.Places)
  {
    pictures.push_back(DrawPieces(communicator, drawn.ScenesOf(place).Drawn(), *drawn.Share.Piece,
      own.Pool, place.Root, statistics));
  }
  if (drawn.Compositing.AfterCasting)
  {
    drawn.Compositing.AfterCasting();
  }
  own.Rays = statistics.Rays;
  own.Sent.BytesSent += statistics.Sent.Bytes;
  own.Sent.MessagesSent += statistics.Sent.Messages;
  own.RenderSeconds += statistics.DrawSeconds;
  own.CompositeSeconds += total.Seconds() - statistics.DrawSeconds;
  return pictures;
}

/// Casts for the scene's segments: nothing is composited here.
/// @return pictures of nothing
std::vector<FloatImage> CastSegments(OwnPart& own, const DrawnPlaces& drawn)
{
  bool begun = false;
  for (const PicturePlace& place : drawn.Places)
  {
    const PlaceScenes scenes = drawn.ScenesOf(place, begun);
    CastOwn(own, scenes.Part(drawn.Compositing.AfterCasting), CastRays);
    begun = true;
  }
  return std::vector<FloatImage>(drawn.Places.size());
}

/// Collective.
/// @return as CastThenComposite
std::vector<FloatImage> DrawPlaces(
  Communicator& communicator, OwnPart& own, const DrawnPlaces& drawn)
{
  const bool alone = communicator.Size() == 1;
  if (drawn.Share.Piece && !alone)
  {
    return DrawPiecesOfPlaces(communicator, own, drawn);
  }
  if (drawn.Scene.Segments)
  {
    return CastSegments(own, drawn);
  }
  const bool whileCasting = drawn.Compositing.WhileCasting && communicator.SendsAtOnce();
  if (drawn.Places.size() != 1 || !(alone || whileCasting))
  {
    return CastThenComposite(communicator, own, drawn);
  }
  const PicturePlace& place = drawn.Places.front();
  const PlaceScenes scenes = drawn.ScenesOf(place);
  const PartOfPicture part = scenes.Part(drawn.Compositing.AfterCasting);
  std::vector<FloatImage> pictures;
  pictures.push_back(alone ? CastAlone(own, part)
                           : CastAndComposite(communicator, own, part, drawn.OptionsOf(place)));
  return pictures;
}

} // namespace

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
  std::vector<PicturePlace> shown;
  std::copy_if(all.begin(), all.end(), std::back_inserter(shown),
    [&](const PicturePlace& place) { return !WithMargin(scene, place.Rect).Empty(); });
  const DrawnPlaces drawn{ scene, share, shown, compositing, self };
  std::vector<FloatImage> pictures = DrawPlaces(communicator, own, drawn);
  for (std::size_t i = 0; i < shown.size(); ++i)
  {
    if (shown[i].Root == communicator.Rank() && !scene.Segments)
    {
      const PlaceScenes scenes = drawn.ScenesOf(shown[i]);
      result = Finished(own, scenes.Drawn(), std::move(pictures[i]), shown[i].Rect, reused);
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
