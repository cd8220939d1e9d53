// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Frame_FieldFrames_h
#define banyan_Parallel_Frame_FieldFrames_h

#include "Parallel/Balance/PictureRegions.h"
#include "Parallel/Frame/KeptPictures.h"
#include "Parallel/Frame/ToleranceControl.h"
#include "Render/Levels/KeptRays.h"

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace banyan
{

/// Frames of one field of all ranks, one after the other, and what a frame can take from those
/// before it: how finely it is sampled, plans of compositing, rays that meet what they met, and
/// whole pictures of scenes that come again.
class FieldFrames
{
public:
  /// What ranks divide among them.
  enum class Division
  {
    Automatic, ///< the picture where several ranks show parts of it, else the data
    ByData,    ///< the cells: each draws a zone, and pictures are composited
    ByPicture  ///< the pixels: each draws all cells under some; DrawnField::IsOnEachRank
  };

  struct Wish
  {
    ToleranceControl::Wish Sampling;
    PixelTransport Transport = PixelTransport::Floats;
    PixelRect Behind;                 ///< CompositeOptions; places have their own
    std::vector<PicturePlace> Places; ///< DrawDistributed
    Division Divides = Division::Automatic;
    bool ReadAhead = true; ///< whether bricks of the next frame are decoded in the background
    bool Reuse = true;     ///< whether the frame may take anything from those before
    bool Passing = false;  ///< whether the picture will not be wanted again: nothing of it is kept
    /// Not empty where the scene's viewport is a part of a picture that is drawn part by part: this
    /// is the picture's. One plan of samplings is made for all parts in which nothing opaque is,
    /// and nothing else is kept of them. Zones and bricks are those of the picture.
    PixelRect Whole;
    /// Not null where the volume shares space with others: what it has along rays comes here, and
    /// there is no picture. The frame is a part of a picture (Whole), planned without depths. It
    /// says nothing of the time that frames take: FrameTook does.
    SegmentPicture* Segments = nullptr;
    double ShowSeconds = 0.0; ///< that putting the picture on the screen is expected to take
  };

  struct Frame
  {
    DrawnPicture Picture;   ///< its pixels are those of this rank's place; null where it has none
    bool Kept = false;      ///< it was drawn for an earlier frame: the same on all ranks
    bool ByPicture = false; ///< how it was divided, if it was not

    /// The part of the pixels that show something whose rays were cast for an earlier frame.
    double ReusedFraction() const
    {
      return this->Kept ? 1.0 : this->Picture.Statistics.ReusedFraction;
    }
  };

  /// Collective; all arguments are the same on all ranks, but for what the field holds.
  /// @param scene gets the samplings that it was drawn with
  /// When a rank fails, all ranks throw the same Error.
  Frame Draw(
    Communicator& communicator, DistributedField& field, RayScene& scene, const Wish& wish);

  /// Collective: a picture of the scene that was drawn before, and is as exact as wanted; nothing
  /// is drawn. Nothing where there is none.
  std::optional<Frame> Kept(
    Communicator& communicator, DistributedField& field, const RayScene& scene, const Wish& wish);

  /// A hash of all that decides a picture, but the values and how finely they are sampled, and
  /// where its pixels end.
  static Hash128 SceneOf(const RayScene& scene, const Wish& wish);

  /// Of the pictures that this rank keeps: none but those with a place have any.
  std::uint64_t PictureBytes() const { return this->Pictures.Bytes(); }

  /// Collective: tells what a frame took of which all parts went to Segments.
  void FrameTook(Communicator& communicator, const Wish& wish, double seconds);

  /// Forgets all frames: when the ranks are others, say.
  void Forget();

private:
  /// Hashes of all that decides a picture, without the values and with them.
  struct Names
  {
    Hash128 View;
    Hash128 Whole;
  };

  /// What a frame is to show, as this rank knows it, and as all go by.
  struct Sight
  {
    Hash128 Scene;                ///< FieldFrames::SceneOf, and where pixels end
    std::vector<Hash128> Content; ///< DistributedField::VisibleContent
    Hash128 Mine;                 ///< of both
    Names Agreed;
    ToleranceControl::Aim Aim;
    KeptPictures::Quality Quality;
  };

  Sight Look(
    Communicator& communicator, DistributedField& field, const RayScene& scene, const Wish& wish);
  bool TakeKept(Communicator& communicator, const Sight& sight, const Wish& wish, Frame& frame);
  bool BeginRays(Communicator& communicator, DrawnField& drawn, RayScene& scene,
    const Hash128& name, const Wish& wish);
  static bool DividesPicture(
    const Communicator& communicator, const DrawnField& drawn, const Wish& wish);
  void Plan(Communicator& communicator, DistributedField& field, RayScene& scene,
    const Hash128& view, const Wish& wish, const ToleranceControl::Aim& aim, DrawnPicture& picture);
  void PlanPart(Communicator& communicator, DistributedField& field, RayScene& whole,
    RayScene& scene, const Wish& wish, const ToleranceControl::Aim& aim, DrawnPicture& picture);
  void DrawAnew(Communicator& communicator, DistributedField& field, RayScene& scene,
    const Names& names, const Wish& wish, const ToleranceControl::Aim& aim, Frame& frame);

  /// Values in memory that are others each time are hardly looked at.
  struct Looking
  {
    std::uint64_t Version = 0; ///< of the field, in the last frame
    int Useless = 0;           ///< versions in a row that nothing could be taken for
    bool Looks = true;         ///< at this version
    bool Judged = false;       ///< whether it is known what could be taken at this version
  };
  void BeginLooking(std::uint64_t version);
  void EndLooking(bool taken);

  /// How finely a picture is sampled that is drawn part by part.
  struct PlanOfParts
  {
    Hash128 Name;
    std::shared_ptr<const TileSamplings> Samplings;
    float OpacityLimit = 0.0f;
    LevelEdges Levels;
    double EstimatedError = 0.0;
    std::string Limit;
  };

  Looking Values;
  std::array<PlanOfParts, 2> OfParts; ///< of each eye's picture
  ToleranceControl Tolerance;
  CompositePlanCache Plans;
  KeptRays Rays;
  PictureRegions Regions;
  KeptPictures Pictures; ///< on ranks with places
};

} // namespace banyan

#endif
