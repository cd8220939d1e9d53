// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see PacketMarcher.cxx.
#if defined(banyan_Render_Raycast_TableSteps_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Render_Raycast_TableSteps_inl_h
#undef banyan_Render_Raycast_TableSteps_inl_h
#else
#define banyan_Render_Raycast_TableSteps_inl_h
#endif

#include "Render/Bricks/PacketVectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// What one sample per lane adds: premultiplied colour and transmittance.
struct Steps
{
  VF R;
  VF G;
  VF B;
  VF Transmittance;
};

/// As StepTable::Partial, with transmittance in place of opacity.
/// @param depths of entries: colour and optical depth
HWY_INLINE Steps OverFraction(const Blocks& depths, VF fraction)
{
  const VF opacity = OpacityOf(hn::Mul(depths.Of[3], fraction));
  return { hn::Mul(depths.Of[0], opacity), hn::Mul(depths.Of[1], opacity),
    hn::Mul(depths.Of[2], opacity), hn::Sub(hn::Set(D(), 1.0f), opacity) };
}

/// Entries of a table, one per lane.
/// @param indices of entries
HWY_INLINE Blocks EntriesAt(const glm::vec4* table, VI indices)
{
#if HWY_TARGET == HWY_SCALAR
  const glm::vec4& entry = table[hn::GetLane(indices)];
  const D d;
  return { { hn::Set(d, entry.r), hn::Set(d, entry.g), hn::Set(d, entry.b), hn::Set(d, entry.a) } };
#else
  Offsets entries;
  entries.Set(hn::ShiftLeft<4>(indices));
  return Transposed(LoadBlocks(table, entries));
#endif
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
