// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/ProfileModes.h"

namespace banyan
{
namespace
{

using block::Interpolation;
using block::Mode;
using block::Reference;

std::vector<Mode> CandidatesOf(EncodeProfile profile, const AblationSwitches& ideas)
{
  const Mode intra{ Reference::None, Interpolation::Cubic };
  const Mode mean{ Reference::Mean, Interpolation::Cubic };
  if (profile == EncodeProfile::Fast || !ideas.AllModes)
  {
    return { intra, mean };
  }
  std::vector<Mode> modes{ intra, { Reference::None, Interpolation::Linear }, mean,
    { Reference::Mean, Interpolation::Linear }, { Reference::Mean, Interpolation::None },
    { Reference::HalfMean, Interpolation::Cubic } };
  modes.push_back({ Reference::A, Interpolation::Linear });
  modes.push_back({ Reference::B, Interpolation::Linear });
  if (profile == EncodeProfile::Compact)
  {
    for (const Reference from : { Reference::A, Reference::B, Reference::HalfMean })
    {
      modes.push_back(
        { from, from == Reference::HalfMean ? Interpolation::Linear : Interpolation::Cubic });
      modes.push_back({ from, Interpolation::None });
    }
  }
  return modes;
}

} // namespace

void ApplyProfile(EncodeProfile profile, const AblationSwitches& ideas, PlaneToEncode& plane)
{
  plane.CandidateModes = CandidatesOf(profile, ideas);
  plane.Trials = profile == EncodeProfile::Compact ? 4 : 1;
}

} // namespace banyan
