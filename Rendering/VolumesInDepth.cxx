// SPDX-License-Identifier: BSD-3-Clause
#include "VolumesInDepth.h"

#include "RendererCamera.h"
#include "Surfaces/SurfaceLayers.h"
#include "VolumeFrame.h"
#include "vtkBanyanVolumeMapper.h"

#include "vtkBillboardTextActor3D.h"
#include "vtkCollection.h"
#include "vtkMath.h"
#include "vtkPropCollection.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <algorithm>
#include <array>
#include <limits>

namespace banyan
{
namespace
{

vtkBanyanVolumeMapper* MapperOf(vtkProp* prop)
{
  auto* const volume = vtkVolume::SafeDownCast(prop);
  return volume ? vtkBanyanVolumeMapper::SafeDownCast(volume->GetMapper()) : nullptr;
}

/// The bit of a prop that is drawn before our volumes, and that shows what is behind it; 0 for
/// others.
unsigned char KindOf(vtkProp* prop)
{
  if (!prop->GetVisibility() || MapperOf(prop))
  {
    return 0;
  }
  if (vtkVolume::SafeDownCast(prop))
  {
    return NotInDepth::Stranger;
  }
  // Axes with labels call themselves translucent, too.
  const bool isText = vtkBillboardTextActor3D::SafeDownCast(prop) != nullptr;
  return IsTranslucentSurface(prop)                               ? NotInDepth::Surface
         : isText && prop->HasTranslucentPolygonalGeometry() != 0 ? NotInDepth::Text
                                                                  : 0;
}

/// A box in the world around some props; empty at first.
struct PropBox
{
  glm::dvec3 Low{ std::numeric_limits<double>::infinity() };
  glm::dvec3 High{ -std::numeric_limits<double>::infinity() };

  bool Empty() const { return this->Low.x > this->High.x; }
  void Add(const PropBox& other)
  {
    this->Low = glm::min(this->Low, other.Low);
    this->High = glm::max(this->High, other.High);
  }
};

PropBox BoxOf(vtkProp* prop)
{
  const double* const bounds = prop->GetBounds();
  if (bounds == nullptr || !vtkMath::AreBoundsInitialized(bounds))
  {
    return {};
  }
  return { { bounds[0], bounds[2], bounds[4] }, { bounds[1], bounds[3], bounds[5] } };
}

/// Whether something in a box may show at pixels of a volume, and is not behind it.
bool IsNotBehind(const PropBox& box, const VolumeOnScreen& volume, const RayCamera& camera)
{
  if (box.Empty() || Intersection(camera.Footprint(box.Low, box.High), volume.Viewport).Empty())
  {
    return false;
  }
  const DepthRelation relation =
    RelationInDepth(volume.Body, { PlaceBox(box.Low, box.High, glm::dmat4(1.0)) }, camera);
  return relation == DepthRelation::SecondNearer || relation == DepthRelation::Unknown;
}

std::vector<unsigned char> UnitedOverRanks(
  Communicator& communicator, const std::vector<unsigned char>& mine)
{
  std::vector<unsigned char> all(mine.size() * static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(mine.data(), mine.size(), all.data());
  std::vector<unsigned char> united(mine.size(), 0);
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    united[i % mine.size()] |= all[i];
  }
  return united;
}

/// The box around what all ranks have: pieces of a surface may lie on any of them, and the picture
/// must not depend on how they are dealt.
PropBox UnitedOverRanks(Communicator& communicator, const PropBox& mine)
{
  std::vector<PropBox> all(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&mine, sizeof(mine), all.data());
  PropBox united;
  for (const PropBox& box : all)
  {
    united.Add(box);
  }
  return united;
}

} // namespace

std::vector<vtkVolume*> VolumesDrawnWith(vtkRenderer* renderer, vtkVolume* self)
{
  vtkBanyanVolumeMapper* const mine = MapperOf(self);
  std::vector<vtkVolume*> volumes;
  vtkPropCollection* const props = renderer->GetViewProps();
  vtkCollectionSimpleIterator at;
  props->InitTraversal(at);
  while (vtkProp* const prop = props->GetNextProp(at))
  {
    vtkBanyanVolumeMapper* const mapper = MapperOf(prop);
    if (prop == self || (mine && mapper && prop->GetVisibility() &&
                          mapper->GetController() == mine->GetController()))
    {
      volumes.push_back(static_cast<vtkVolume*>(prop));
    }
  }
  const bool found = std::find(volumes.begin(), volumes.end(), self) != volumes.end();
  return found ? volumes : std::vector<vtkVolume*>{ self };
}

PlacedBody BodyOf(vtkVolume* volume, vtkVolumeMapper* mapper, const std::array<double, 6>& bounds,
  const RayScene& scene)
{
  const glm::dmat4 toWorld = ToGlm(volume->GetMatrix());
  const Box& cells = scene.DomainCells;
  glm::dvec3 low(bounds[0], bounds[2], bounds[4]);
  glm::dvec3 high(bounds[1], bounds[3], bounds[5]);
  if (mapper->GetCropping())
  {
    const double* box = mapper->GetCroppingRegionPlanes();
    low = glm::max(low, glm::min(glm::dvec3(box[0], box[2], box[4]), high));
    high = glm::min(high, glm::max(glm::dvec3(box[1], box[3], box[5]), low));
  }
  return { PlaceBox(low, high, toWorld),
    PlaceBox(glm::dvec3(cells.Lo), glm::dvec3(cells.Hi), toWorld * scene.IndexToWorld) };
}

bool CanMix(const VolumeFrame& frame)
{
  return frame.Scene().Blend.Mode == BlendMode::Composite && frame.Mapper()->GetMixVolumes();
}

Groups GroupsOf(const std::vector<VolumeFrame*>& frames, const DepthOrder& order)
{
  std::vector<bool> mixes(frames.size());
  std::transform(frames.begin(), frames.end(), mixes.begin(),
    [](const VolumeFrame* frame) { return CanMix(*frame); });
  return GroupsThatMix(order, mixes);
}

std::vector<unsigned char> FindNotInDepth(Communicator& communicator, vtkRenderer* renderer,
  const RayCamera& camera, const std::vector<VolumeOnScreen>& volumes, const DepthOrder& order,
  const Groups& groups)
{
  std::vector<unsigned char> bits(volumes.size(), 0);
  for (const std::array<int, 2>& pair : order.Unknown())
  {
    const auto hasBoth = [&](const std::vector<int>& group)
    {
      return std::binary_search(group.begin(), group.end(), pair[0]) &&
             std::binary_search(group.begin(), group.end(), pair[1]);
    };
    if (std::none_of(groups.begin(), groups.end(), hasBoth))
    {
      bits[static_cast<std::size_t>(pair[0])] |= NotInDepth::SharedSpace;
      bits[static_cast<std::size_t>(pair[1])] |= NotInDepth::SharedSpace;
    }
  }
  const auto add = [&](unsigned char kind, const PropBox& box)
  {
    for (std::size_t i = 0; i < volumes.size(); ++i)
    {
      bits[i] |= IsNotBehind(box, volumes[i], camera) ? kind : 0;
    }
  };
  PropBox surfaces;
  vtkPropCollection* const props = renderer->GetViewProps();
  vtkCollectionSimpleIterator at;
  props->InitTraversal(at);
  while (vtkProp* const prop = props->GetNextProp(at))
  {
    const unsigned char kind = KindOf(prop);
    if (kind == NotInDepth::Surface)
    {
      surfaces.Add(BoxOf(prop));
    }
    else if (kind != 0)
    {
      add(kind, BoxOf(prop));
    }
  }
  add(NotInDepth::Surface, UnitedOverRanks(communicator, surfaces));
  return UnitedOverRanks(communicator, bits);
}

unsigned char NotToldYet(unsigned char bits, unsigned char& told)
{
  const auto fresh = static_cast<unsigned char>(bits & ~told);
  told = static_cast<unsigned char>(told | bits);
  return fresh;
}

std::string TellNotInDepth(unsigned char bits)
{
  std::string text;
  const auto tell = [&](unsigned char bit, const char* sentences)
  {
    if ((bits & bit) != 0)
    {
      text += text.empty() ? sentences : std::string(" ") + sentences;
    }
  };
  tell(NotInDepth::SharedSpace,
    "Banyan Volumes share a part of space and are not mixed: the one whose middle is nearer is "
    "drawn before the whole of the other one, so the picture is not exact where they meet. Switch "
    "MixVolumes of both on. Where one is a projection, move, crop or hide it.");
  tell(NotInDepth::Surface,
    "A translucent surface is before a Banyan Volume or inside it, and is drawn as if it were "
    "behind the volume: the picture is not exact there. Switch MixVolumes of the volume on, or "
    "make the surface opaque, move or hide it. Projections, walls of displays, windows of clients "
    "and views with other kinds of volumes have no such surfaces.");
  tell(NotInDepth::Text,
    "A text in space is before a Banyan Volume or inside it, and is drawn as if it were behind the "
    "volume: the picture is not exact there. Move or hide it, or show the volume as 'Volume'.");
  tell(NotInDepth::Layers,
    "A translucent surface has more than 64 layers one behind the other: those behind these are "
    "left out where a Banyan Volume is. Make the surface opaque, or show less of it.");
  tell(NotInDepth::Stranger,
    "Another kind of volume is before a Banyan Volume or inside it, and is drawn as if it were "
    "behind "
    "that: the picture is not exact there. Show both as 'Banyan Volume', or both as 'Volume'.");
  return text;
}

} // namespace banyan
