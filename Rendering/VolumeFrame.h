// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_VolumeFrame_h
#define banyan_Rendering_VolumeFrame_h

#include "FrameFigures.h"
#include "MapperState.h"
#include "RendererCamera.h"

#include "Base/Timer.h"
#include "Parallel/Composite/TilePicture.h"

#include <memory>
#include <optional>

class vtkBanyanVolumeMapper;
class vtkRenderer;

namespace banyan
{

struct DepthPicture;

/// One volume in the frame that is under way. All functions but the getters are collective, and
/// throw Error when a rank fails.
class VolumeFrame
{
public:
  /// @param mapper has the settings, and gets the statistics
  /// @param state of the mapper; its field is that of the volume
  VolumeFrame(vtkBanyanVolumeMapper* mapper, MapperState& state, vtkVolume* volume)
    : Owner(mapper)
    , State(&state)
    , Prop(volume)
  {
  }

  vtkBanyanVolumeMapper* Mapper() const { return this->Owner; }
  vtkVolume* Volume() const { return this->Prop; }
  /// Of a volume that is prepared.
  const RayScene& Scene() const { return *this->Wanted; }

  /// @return whether the volume is on the screen
  bool Prepare(const ScreenView& view);

  /// Volumes of the picture, this one included.
  struct Together
  {
    int Volumes = 1;
    int OfMapper = 1; ///< that this one's mapper draws
  };

  /// How the volume is to be drawn, but for what lies behind it.
  /// @param interacting whether somebody moves the camera
  /// @param eye see EyeOf
  FieldFrames::Wish WishFor(bool interacting, int eye, int volumes) const;

  /// Begins to count what a picture takes.
  void BeginFigures();
  /// Publishes what is known of a picture when it is drawn.
  void Tell(const FieldFrames::Frame& frame);

  /// Draws the volume, which is on the screen.
  /// @return the volume's picture on rank 0; null elsewhere
  std::shared_ptr<const FloatImage> Cast(
    vtkRenderer* renderer, const Backdrop& backdrop, const Together& others);

  /// Draws a part of the volume's picture: the statistics of parts add up.
  /// @param part of the picture; the volume may be in none of it
  /// @return the volume's picture there on rank 0; null elsewhere
  std::shared_ptr<const FloatImage> CastPart(
    vtkRenderer* renderer, const Backdrop& backdrop, const Together& others, const PixelRect& part);

  /// A picture on displays of ranks.
  struct OnWall
  {
    const std::vector<PicturePlace>& Places;
    std::size_t Number;   ///< of the picture: each has frames of its own
    std::size_t Pictures; ///< that are drawn one after the other
  };

  /// Takes what the volume has along the rays of a part of a picture, for volumes that share space
  /// with it: the statistics of parts add up.
  /// @param part of the picture
  /// @param segments get it, as far as this rank has it
  /// @return the transmittance at which rays end
  float CastSegments(vtkRenderer* renderer, const Backdrop& backdrop, const Together& others,
    const PixelRect& part, SegmentPicture& segments);
  /// The same for a picture on displays of ranks.
  /// @param volumes in the picture
  float CastSegmentsOnWall(vtkRenderer* renderer, const OnWall& wall, const DepthPicture& depths,
    int volumes, const PixelRect& part, SegmentPicture& segments);
  /// What a picture took that was mixed.
  struct Mixing
  {
    int Volumes = 1;         ///< of the picture
    double Seconds = 0.0;    ///< for this volume
    SentBytes Sent;          ///< by this rank, for this volume
    std::size_t Picture = 0; ///< OnWall::Number
  };
  /// Tells what all parts of a picture took, of volumes that share space.
  void SegmentsTook(vtkRenderer* renderer, const Mixing& mixing, bool onWall);

  /// Whether somebody goes on in front of the window while the picture is drawn, or moves the
  /// camera. The same on all ranks.
  bool HasSpectator(vtkRenderer* renderer, const Together& others) const;

  /// Draws the volume for displays of ranks, picture by picture: their statistics add up.
  /// @param depths at which other data are
  /// @param volumes in the picture
  /// @return the part of the volume's picture in this rank's place; null where it has none
  std::shared_ptr<const FloatImage> CastOnWall(
    vtkRenderer* renderer, const OnWall& wall, const DepthPicture& depths, int volumes);

  /// Forgets frames of pictures that a wall does not show any more.
  /// @param pictures that it shows
  void ForgetPictures(std::size_t pictures);

  /// Publishes the statistics, when the picture is on the screen.
  /// @param geometry what it took to combine the pixels of other props
  /// @param writeSeconds for this volume's part of the picture
  void Finish(const CompositeStatistics& geometry, double writeSeconds);

private:
  void BeginParts(vtkRenderer* renderer, const Backdrop& backdrop);
  void BeginOnWall(vtkRenderer* renderer, const OnWall& wall);
  float TakeSegments(
    FieldFrames& frames, RayScene& scene, FieldFrames::Wish wish, SegmentPicture& segments);
  bool MayBeLate(vtkRenderer* renderer, const Together& others) const;
  bool MayBeLateForClient(const Together& others) const;
  void TellMore(FieldFrames::Frame frame);
  void DrawsAtOnce(bool exact);
  FieldFrames::Frame Draw(
    vtkRenderer* renderer, const FieldFrames::Wish& wish, const Together& others);

  vtkBanyanVolumeMapper* Owner;
  MapperState* State;
  vtkVolume* Prop;
  Timer Began;
  std::optional<RayScene> Wanted; ///< none until it is prepared
  FrameStatistics Statistics;
  FrameFigures Figures;
  bool Kept = false;       ///< FieldFrames::Frame
  int PicturesDrawn = 0;   ///< of a wall, or parts of a picture, in this frame
  double WorstError = 0.0; ///< estimated, of these
};

} // namespace banyan

#endif
