// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_HotBlobs_h
#define banyan_Data_HotBlobs_h

#include <array>
#include <cstdint>
#include <vector>

namespace banyan
{

/// The temperature at the start: 1 inside a few balls, 0 outside, with smooth edges. The seed
/// decides where the balls are, how large, and how wavy their surfaces. Lengths as in
/// FlowSimulation: the box has edge 2 pi.
class HotBlobs
{
public:
  /// @param edgeWidth thickness of the edges; a few cells, or the modes cannot carry them
  HotBlobs(std::uint64_t seed, float edgeWidth);

  /// Value in [0, 1].
  float Temperature(float x, float y, float z) const;

private:
  struct Ripple
  {
    std::array<float, 3> WaveVector;
    float Phase;
    float Amplitude;
  };
  struct Ball
  {
    std::array<float, 3> Centre;
    float Radius;
    std::vector<Ripple> Ripples;
  };
  float InBall(const Ball& ball, float x, float y, float z) const;

  std::vector<Ball> Balls;
  float EdgeWidth;
};

} // namespace banyan

#endif
