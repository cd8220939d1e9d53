// SPDX-License-Identifier: BSD-3-Clause
#include "VolumesOnWall.h"

#include "VolumesInDepth.h"
#include "VolumesPicture.h"
#include "vtkBanyanVolumeMapper.h"

#include "Base/Progress.h"
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

/// Copies depths into those of a larger part of the picture.
void Put(const DepthPicture& from, DepthPicture& to)
{
  const PixelRect part = Intersection(from.Rect, to.Rect);
  for (int y = part.Lo.y; y < part.Hi.y && !part.Empty(); ++y)
  {
    const auto at = [&](const DepthPicture& picture)
    {
      return std::ptrdiff_t{ y - picture.Rect.Lo.y } * picture.Rect.Size().x +
             (part.Lo.x - picture.Rect.Lo.x);
    };
    std::copy_n(from.Depths.begin() + at(from), part.Size().x, to.Depths.begin() + at(to));
  }
}

/// Collective: where other data are in all places of a picture, on all ranks.
/// @param own in this rank's place
DepthPicture DepthsOfAll(
  Communicator& communicator, const WallPicture& picture, const DepthPicture& own)
{
  std::vector<DepthPicture> all;
  PixelRect around;
  for (const PicturePlace& place : picture.Places)
  {
    Bytes packed;
    if (place.Root == communicator.Rank() && !own.Rect.Empty())
    {
      packed = PackDepths({ picture.View.Size, own.Rect, own.Depths });
    }
    std::uint64_t bytes = packed.size();
    communicator.Broadcast(place.Root, &bytes, sizeof(bytes));
    packed.resize(bytes);
    if (bytes > 0)
    {
      communicator.Broadcast(place.Root, packed.data(), packed.size());
      all.push_back(UnpackDepths(packed));
      around = Union(around, all.back().Rect);
    }
  }
  DepthPicture united{ picture.View.Size, around, {} };
  united.Depths.assign(static_cast<std::size_t>(around.Count()), 1.0f);
  for (const DepthPicture& part : all)
  {
    Put(part, united);
  }
  return united;
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

void VolumesOnWall::Draw(const std::vector<WallPicture>& pictures, const DepthPicture& own)
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
        this->DrawPicture(pictures[number], wall, own, drawn, failed);
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
  if (wall.Number == 0)
  {
    const RayCamera camera(picture.View.WorldToClip, picture.View.Size, glm::dvec3(0.0));
    VolumesPicture::WarnNotInDepth(this->Called, this->Renderer, camera, frames, volumes, order);
  }
  const auto place = std::find_if(picture.Places.begin(), picture.Places.end(),
    [&](const PicturePlace& its) { return its.Root == communicator.Rank(); });
  const bool shows = place != picture.Places.end();
  const DepthPicture depths = DepthsOfAll(communicator, picture, shows ? own : DepthPicture{});
  std::vector<std::shared_ptr<const FloatImage>> pictures(frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i)
  {
    const auto cast = [&]
    {
      pictures[i] =
        frames[i]->CastOnWall(this->Renderer, wall, depths, static_cast<int>(frames.size()));
      return true;
    };
    (frames[i]->Mapper()->Attempt(cast) ? drawn : failed).insert(frames[i]);
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

} // namespace banyan
