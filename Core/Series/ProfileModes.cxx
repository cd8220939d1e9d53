#include "Series/ProfileModes.h"

namespace banyan
{
namespace
{

using block::Interpolation;
using block::Mode;
using block::Reference;

std::vector<Mode> CandidatesOf(EncodeProfile profile, const EncodeIdeas& ideas)
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

void ApplyProfile(EncodeProfile profile, const EncodeIdeas& ideas, PlaneToEncode& plane)
{
  plane.Candidates = CandidatesOf(profile, ideas);
  plane.Trials = profile == EncodeProfile::Compact ? 4 : profile == EncodeProfile::Fast ? 1 : 2;
  plane.Trials = ideas.Trials ? plane.Trials : 1;
  plane.TrialMargin = profile == EncodeProfile::Compact ? 1000 : 100;
  // There is next to nothing to be gained by trials of such blocks, which are most of a smooth
  // series'.
  plane.LeastTriedBits = profile == EncodeProfile::Compact ? 0 : 16;
}

} // namespace banyan
