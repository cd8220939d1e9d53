// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Sampling_ProbeSequence_h
#define banyan_Render_Sampling_ProbeSequence_h

#include "Render/Sampling/ProbeImages.h"

#include <vector>

namespace banyan
{

/// Small pictures that come ever closer to the truth, and how far off each is expected to be: the
/// difference to the picture before, divided by r - 1, where r is how much larger the difference
/// before that was (Richardson's extrapolation, r held between 1.7 and 4). The difference to a
/// later picture, and that one's error, bound the error too, and so does what is expected of an
/// earlier one.
///
/// Errors of tiles are those of the probes in and around them, times a factor of safety, because
/// the worst of a thousand pixels is worse than that of a few; and at least the largest error
/// anywhere, because probes may miss what is thin.
class ProbeSequence
{
public:
  /// @param pictures must stay
  explicit ProbeSequence(const ProbeImages& pictures)
    : Pictures(pictures)
  {
  }

  void Add(ProbeImage picture);

  /// Says that the last picture, of at least two, has no error by definition.
  void LastIsExact();

  /// What is expected of each picture, now that all are there: at least two.
  std::vector<TileErrors> AllErrors() const;
  /// Whether no tile of the last picture is expected to be off by more.
  bool LastIsWithin(double allowed) const;

private:
  const ProbeImages& Pictures;
  std::vector<ProbeImage> Drawn;
  std::vector<ProbeErrors> Steps; ///< from each picture to the next
  double LargestBefore = 0.0;     ///< difference of the last two
  std::vector<TileErrors> Errors;
};

} // namespace banyan

#endif
