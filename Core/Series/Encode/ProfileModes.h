// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_ProfileModes_h
#define banyan_Series_Encode_ProfileModes_h

#include "Codec/BlockEncoder.h"
#include "Series/Encode/SeriesEncoder.h"

namespace banyan
{

/// Sets which modes are candidates for the blocks of a plane, and how many are tried out.
void ApplyProfile(EncodeProfile profile, const AblationSwitches& ideas, PlaneToEncode& plane);

} // namespace banyan

#endif
