// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see PacketMarcher.cxx.
#if defined(banyan_Render_Raycast_NoteSteps_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Render_Raycast_NoteSteps_inl_h
#undef banyan_Render_Raycast_NoteSteps_inl_h
#else
#define banyan_Render_Raycast_NoteSteps_inl_h
#endif

#include "Render/Raycast/SegmentLog.h"
#include "Render/Raycast/TableSteps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Notes a sample of some lanes.
/// @param slot of the first lane
/// @param samples their numbers, as SegmentLog has them
inline void NoteSteps(SegmentLog& log, int slot, VI samples, hn::Mask<D> lanes, const Steps& steps)
{
  const D d;
  constexpr int most = RayTile::PacketSize;
  alignas(64) std::int32_t number[most];
  alignas(64) float step[4][most];
  hn::Store(samples, DI(), number);
  hn::Store(steps.R, d, step[0]);
  hn::Store(steps.G, d, step[1]);
  hn::Store(steps.B, d, step[2]);
  hn::Store(steps.Transmittance, d, step[3]);
  std::uint64_t bits = 0;
  hn::StoreMaskBits(d, lanes, reinterpret_cast<std::uint8_t*>(&bits));
  for (; bits != 0; bits &= bits - 1)
  {
    const int i = __builtin_ctzll(bits);
    log.Add(slot + i, number[i], step[0][i], step[1][i], step[2][i], step[3][i]);
  }
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
