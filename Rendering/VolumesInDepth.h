// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_VolumesInDepth_h
#define banyan_Rendering_VolumesInDepth_h

#include "Parallel/Communicate/Communicator.h"
#include "Render/Levels/RayCaster.h"
#include "Render/Raycast/DepthOrder.h"

#include <array>
#include <string>
#include <vector>

class vtkRenderer;
class vtkVolume;
class vtkVolumeMapper;

namespace banyan
{

class VolumeFrame;

/// Visible volumes of a renderer that vtkBanyanVolumeMapper draws on the same ranks as `self`, in
/// the order in which they were added: the same list on all ranks. `self` alone where it stands in
/// an assembly.
std::vector<vtkVolume*> VolumesDrawnWith(vtkRenderer* renderer, vtkVolume* self);

/// Where a volume may show something, in world space: in its grid, its bounds and its cropping box.
/// @param bounds of the field, in physical space; not empty
PlacedBody BodyOf(vtkVolume* volume, vtkVolumeMapper* mapper, const std::array<double, 6>& bounds,
  const RayScene& scene);

/// A volume of ours as it stands in the picture.
struct VolumeOnScreen
{
  PlacedBody Body;
  PixelRect Viewport;
};

/// Why a volume is not blended in the order of depth: one bit each.
enum NotInDepth : unsigned char
{
  SharedSpace = 1, ///< with another volume of ours
  Surface = 2,     ///< a translucent surface is before it, or in it
  Stranger = 4,    ///< a volume that others draw is
  Text = 8,        ///< a text in space is
  Layers = 16      ///< a translucent surface has more layers than are drawn
};

/// Of volumes, which are mixed: see GroupsThatMix.
using Groups = std::vector<std::vector<int>>;

/// Whether a volume may be mixed with others, and with surfaces.
bool CanMix(const VolumeFrame& frame);

/// Those of volumes in a picture.
Groups GroupsOf(const std::vector<VolumeFrame*>& frames, const DepthOrder& order);

/// Collective. What others draw is drawn before our volumes: right where it is behind them.
/// @param camera of the picture that the volumes' viewports are in
/// @param groups of volumes: those of one are mixed
/// @return bits of NotInDepth for each volume, the same on all ranks
std::vector<unsigned char> FindNotInDepth(Communicator& communicator, vtkRenderer* renderer,
  const RayCamera& camera, const std::vector<VolumeOnScreen>& volumes, const DepthOrder& order,
  const Groups& groups = {});

/// Bits that were not told before; they are from then on.
unsigned char NotToldYet(unsigned char bits, unsigned char& told);

/// Sentences for users: what is not exact, and what to do.
std::string TellNotInDepth(unsigned char bits);

} // namespace banyan

#endif
