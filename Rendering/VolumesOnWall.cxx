// SPDX-License-Identifier: BSD-3-Clause
#include "VolumesOnWall.h"

#include "VolumesInDepth.h"
#include "VolumesPicture.h"
#include "vtkBanyanVolumeMapper.h"

#include "Base/Progress.h"
#include "Base/ThreadPool.h"
#include "Base/Timer.h"
#include "Parallel/Composite/MixVolumes.h"
#include "Parallel/Composite/PackedDepths.h"

#include "vtkRenderer.h"
#include "vtkSetGet.h"
#include "vtkVolume.h"

#include <algorithm>
#include <memory>

namespace banyan
{
namespace
{

/// Collective: where other data are in a picture, on all ranks.
/// @param own as far as this rank knows
DepthPicture DepthsOfAll(
  Communicator& communicator, const ScreenView& view, const DepthPicture& own)
{
  const auto self = static_cast<std::size_t>(communicator.Rank());
  Bytes mine;
  if (!own.Rect.Empty())
  {
    mine = PackDepths({ view.Size, own.Rect, own.Depths });
  }
  const std::uint64_t count = mine.size();
  std::vector<std::uint64_t> counts(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&count, sizeof(count), counts.data());
  DepthPicture nearest{ view.Size, {},
    {} }; // a rank may have drawn all over the wall: one at a time
  for (std::size_t rank = 0; rank < counts.size(); ++rank)
  {
    if (counts[rank] > 0)
    {
      Bytes packed = rank == self ? mine : Bytes(counts[rank]);
      communicator.Broadcast(static_cast<int>(rank), packed.data(), packed.size());
      std::vector<DepthPicture> both;
      both.push_back(std::move(nearest));
      both.push_back(UnpackDepths(packed));
      nearest = NearestOf(both);
    }
  }
  return nearest;
}

} // namespace

VolumesOnWall::VolumesOnWall(
  vtkRenderer* renderer, vtkBanyanVolumeMapper* mapper, vtkVolume* volume)
  : Renderer(renderer)
  , Called(mapper)
{
  for (vtkVolume* const shown : VolumesDrawnWith(renderer, volume))
  {
    auto* const its = vtkBanyanVolumeMapper::SafeDownCast(shown->GetMapper());
    this->Frames.emplace_back(its, *its->State, shown);
  }
}

void VolumesOnWall::Draw(
  const std::vector<WallPicture>& pictures, const std::vector<DepthPicture>& own)
{
  const auto isUpdated = [](VolumeFrame& frame)
  {
    return frame.Mapper()->Attempt(
      [&]
      {
        frame.Mapper()->UpdateField(frame.Volume());
        return true;
      });
  };
  this->Frames.erase(std::remove_if(this->Frames.begin(), this->Frames.end(),
                       [&](VolumeFrame& frame) { return !isUpdated(frame); }),
    this->Frames.end());
  std::set<VolumeFrame*> drawn;
  std::set<VolumeFrame*> failed;
  for (std::size_t number = 0; number < pictures.size(); ++number)
  {
    const VolumeFrame::OnWall wall{ pictures[number].Places, number, pictures.size() };
    this->Called->Attempt(
      [&]
      {
        this->DrawPicture(pictures[number], wall, own[number], drawn, failed);
        return true;
      });
  }
  for (VolumeFrame& frame : this->Frames)
  {
    frame.ForgetPictures(pictures.size());
    if (drawn.count(&frame) > 0 && failed.count(&frame) == 0)
    {
      frame.Finish({}, 0.0);
    }
  }
}

/// Collective.
/// @param drawn gets the frames that are in the picture
/// @param failed gets those that could not be drawn
void VolumesOnWall::DrawPicture(const WallPicture& picture, const VolumeFrame::OnWall& wall,
  const DepthPicture& own, std::set<VolumeFrame*>& drawn, std::set<VolumeFrame*>& failed)
{
  const PhaseScope beginning(Phase::Beginning);
  Communicator& communicator = *this->Called->State->Communicator;
  std::vector<VolumeFrame*> frames;
  for (VolumeFrame& frame : this->Frames)
  {
    if (frame.Mapper()->Attempt([&] { return frame.Prepare(picture.View); }))
    {
      frames.push_back(&frame);
    }
  }
  if (frames.empty())
  {
    return;
  }
  const std::vector<VolumeOnScreen> volumes = VolumesPicture::OnScreen(frames);
  const DepthOrder order = OrderInDepth(volumes, picture.View);
  const Groups groups = GroupsOf(frames, order);
  if (wall.Number == 0)
  {
    const RayCamera camera(picture.View.WorldToClip, picture.View.Size, glm::dvec3(0.0));
    VolumesPicture::WarnNotInDepth(this->Called, frames,
      FindNotInDepth(communicator, this->Renderer, camera, volumes, order, groups));
  }
  const auto place = std::find_if(picture.Places.begin(), picture.Places.end(),
    [&](const PicturePlace& its) { return its.Root == communicator.Rank(); });
  const bool shows = place != picture.Places.end();
  const DepthPicture depths = DepthsOfAll(communicator, picture.View, own);
  std::vector<std::shared_ptr<const FloatImage>> pictures(frames.size());
  for (const std::vector<int>& group : groups)
  {
    std::vector<VolumeFrame*> mixed(group.size());
    std::transform(group.begin(), group.end(), mixed.begin(),
      [&](int number) { return frames[static_cast<std::size_t>(number)]; });
    std::shared_ptr<const FloatImage>& mine = pictures[static_cast<std::size_t>(group.front())];
    mine = this->Cast(mixed, wall, depths, drawn, failed);
  }
  if (shows)
  {
    const bool single = frames.size() == 1 && pictures.front();
    const FloatImage blended =
      single ? *pictures.front() : BlendInDepth(pictures, order, place->Rect);
    Backdrop& backdrop = this->Called->State->Backdrop;
    backdrop.SetCorner(place->Rect.Lo);
    backdrop.WriteOver(this->Renderer, blended);
  }
}

/// Collective: draws a volume, or several that share space, place after place.
/// @return the picture in this rank's place
std::shared_ptr<const FloatImage> VolumesOnWall::Cast(const std::vector<VolumeFrame*>& group,
  const VolumeFrame::OnWall& wall, const DepthPicture& depths, std::set<VolumeFrame*>& drawn,
  std::set<VolumeFrame*>& failed)
{
  std::shared_ptr<const FloatImage> mine;
  const int volumes = static_cast<int>(this->Frames.size());
  const auto attempt = [&](VolumeFrame& frame, const std::function<void()>& cast)
  {
    const auto drawing = [&]
    {
      cast();
      return true;
    };
    if (failed.count(&frame) == 0)
    {
      (frame.Mapper()->Attempt(drawing) ? drawn : failed).insert(&frame);
    }
    return failed.count(&frame) == 0;
  };
  if (group.size() == 1)
  {
    attempt(*group.front(),
      [&] { mine = group.front()->CastOnWall(this->Renderer, wall, depths, volumes); });
    return mine;
  }
  const auto castBlock = [&](std::size_t volume, const PixelRect& block, SegmentPicture& segments)
  {
    float limit = 1.0f;
    const auto cast = [&]
    {
      limit =
        group[volume]->CastSegmentsOnWall(this->Renderer, wall, depths, volumes, block, segments);
    };
    if (!attempt(*group[volume], cast))
    {
      segments.Take();
    }
    return limit;
  };
  const Timer timer;
  VolumeFrame::Mixing took;
  took.Volumes = volumes;
  took.Picture = wall.Number;
  for (const PicturePlace& place : wall.Places)
  {
    std::shared_ptr<const FloatImage> picture = MixInBlocks(*this->Called->State->Communicator,
      group.size(), place.Rect, place.Root, ThreadPool::Process(), castBlock, took.Sent);
    mine = picture ? std::move(picture) : std::move(mine);
  }
  took.Seconds =
    timer.Seconds() / static_cast<double>(group.size()) * static_cast<double>(wall.Pictures);
  for (VolumeFrame* const frame : group)
  {
    attempt(*frame, [&] { frame->SegmentsTook(this->Renderer, took, /*onWall=*/true); });
    took.Sent = {}; // the first one has them all
  }
  return mine;
}

} // namespace banyan
