#ifndef banyan_Data_HotBlob_h
#define banyan_Data_HotBlob_h

#include <array>
#include <cstdint>
#include <vector>

namespace banyan
{

/// The temperature at the start: 1 inside a ball whose surface is wavy in a way that the seed
/// decides, 0 outside, with a smooth edge. Lengths as in FlowSimulation: the box has edge 2 pi.
class HotBlob
{
public:
  /// @param edgeWidth thickness of the edge; a few cells, or the modes cannot carry it
  HotBlob(std::uint64_t seed, float edgeWidth);

  /// Value in [0, 1].
  float Temperature(float x, float y, float z) const;

private:
  struct Ripple
  {
    std::array<float, 3> WaveVector;
    float Phase;
    float Amplitude;
  };
  std::vector<Ripple> Ripples;
  float EdgeWidth;
};

} // namespace banyan

#endif
