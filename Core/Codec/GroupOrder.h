// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Codec_GroupOrder_h
#define banyan_Codec_GroupOrder_h

#include <algorithm>
#include <cstdint>
#include <vector>

namespace banyan
{

/// In place of a step of a group, which count from 0: no step.
constexpr int NoStep = -2;
/// The last step of the group before.
constexpr int StepBefore = -1;

/// The steps that a step of a group is predicted from, counted from the group's first.
struct StepReferences
{
  int A = NoStep; ///< before, or B where there is none
  int B = NoStep; ///< after

  /// False for the key frame of a group.
  bool Any() const { return this->A != NoStep; }
};

/// How far away the references of a step are: the lowest set bit of its distance to the last one.
inline int ReferenceDistance(int step, int steps)
{
  const int left = steps - 1 - step;
  return left & -left;
}

/// Dyadic. The last step of a group is its key frame, which is coded by itself; the others lie
/// between it and the key frame of the group before. So a group of 8 has chains of at most 5 steps,
/// half of the steps are referred to by none, and a step takes its own group and one key frame.
/// @param open whether the group refers to the key frame of the one before
inline StepReferences ReferencesOfStep(int step, int steps, bool open)
{
  const int distance = ReferenceDistance(step, steps);
  if (distance == 0)
  {
    return {};
  }
  const int after = step + distance;
  const int before = std::max(step - distance, StepBefore);
  return { before == StepBefore && !open ? after : before, after };
}

/// The steps of a group in an order that has each after its references.
inline std::vector<int> DyadicOrder(int steps)
{
  std::vector<int> order;
  for (int step = 0; step < steps; ++step)
  {
    order.push_back(step);
  }
  const auto rank = [steps](int step)
  { return step + 1 == steps ? 2 * steps : ReferenceDistance(step, steps); };
  std::stable_sort(order.begin(), order.end(), [&rank](int a, int b) { return rank(a) > rank(b); });
  return order;
}

/// Lattice steps per residual: the bound's own on the finest octave; coarser samples, which many
/// others are predicted from, are kept 1.3 times more exactly per octave. Odd, so that rounding
/// never ties.
/// @param octave 0 for stride 1, 1 for stride 2, ...
inline std::int32_t BinOfOctave(std::int32_t finest, int octave)
{
  std::int64_t scaled = std::int64_t{ finest } << 16;
  for (int i = 0; i < octave; ++i)
  {
    scaled = scaled * 10 / 13;
  }
  return static_cast<std::int32_t>(std::min<std::int64_t>((scaled >> 16) | 1, finest));
}

} // namespace banyan

#endif
