// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Sampling_RefinementPasses_h
#define banyan_Render_Sampling_RefinementPasses_h

#include "Base/Hash.h"

namespace banyan
{

/// Draws the still pictures that follow an interaction in passes: the first with the tolerance of
/// interaction, each of the next ones with a quarter of the one before, until the one that is
/// wanted. A picture of the same scene is never drawn with a larger tolerance than the one before
/// it. Other still pictures (those of scripts, and of the files that people save) keep the
/// tolerance at once.
class RefinementPasses
{
public:
  struct Wish
  {
    bool Passes = false;      ///< otherwise the tolerance is kept at once
    double Still = 1.0;       ///< 1/255
    double Interactive = 8.0; ///< 1/255
  };

  /// Returns the tolerance of the next still picture.
  /// @param scene of it: a hash of all that decides it, its samplings apart
  double ToleranceOf(const Hash128& scene, const Wish& wish);

  /// Tells that a picture was shown in its place that was drawn before, with a smaller tolerance.
  void Showed(double tolerance, const Wish& wish);

  /// Tells that a picture was drawn while somebody moved the camera.
  void Interacted() { this->AfterInteraction = true; }

  /// Asks for the next pass. To be called on all ranks. @return false when there is none: the last
  /// picture kept the tolerance that is wanted, or was not drawn again since the last call
  bool Next();

private:
  Hash128 Drawn; ///< the last scene
  double Reached = 0.0;
  bool AfterInteraction = false;
  bool IsLast = true;
  bool Asked = false;
  bool Fresh = false; ///< whether a picture was drawn since Next
};

} // namespace banyan

#endif
