#ifndef banyan_Codec_GroupOrder_h
#define banyan_Codec_GroupOrder_h

#include <algorithm>
#include <cstdint>
#include <vector>

namespace banyan
{

/// The steps that a step of a group is predicted from, counted from the group's first; -1 for none.
struct StepReferences
{
  int A = -1; ///< before
  int B = -1; ///< after, or A where the group has no step there
};

/// Dyadic: a step refers to those at the distance of its lowest set bit. So a group of 8 has chains
/// of at most 4 steps (3.1 in the mean), half of the steps are referred to by none, and no step
/// refers beyond its group.
inline StepReferences ReferencesOfStep(int step, int steps)
{
  if (step == 0)
  {
    return {};
  }
  const int distance = step & -step;
  const int before = step - distance;
  const int after = step + distance;
  return { before, after < steps ? after : before };
}

/// The steps of a group in an order that has each after its references.
inline std::vector<int> DyadicOrder(int steps)
{
  std::vector<int> order;
  for (int step = 0; step < steps; ++step)
  {
    order.push_back(step);
  }
  const auto rank = [steps](int step) { return step == 0 ? 2 * steps : step & -step; };
  std::stable_sort(
    order.begin(), order.end(), [&rank](int a, int b) { return rank(a) > rank(b); });
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
