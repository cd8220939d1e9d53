// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see PacketMarcher.cxx.
#if defined(banyan_Render_Raycast_ColourLanes_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Render_Raycast_ColourLanes_inl_h
#undef banyan_Render_Raycast_ColourLanes_inl_h
#else
#define banyan_Render_Raycast_ColourLanes_inl_h
#endif

#include "Render/Bricks/PackedBrick.h"
#include "Render/Bricks/PacketVectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// The colours of a packed brick, for a sample per lane.
class ColourLanes
{
public:
  /// Red, green and blue, 0 to 1.
  struct Tint
  {
    VF Of[3];
  };

  /// @param brick may have none: then nothing may be asked
  explicit ColourLanes(const PackedBrick& brick)
    : Colours(reinterpret_cast<const std::int32_t*>(brick.ColoursOfSamples()))
  {
    const glm::ivec3 samples = brick.Cells().Size() + 1;
    this->Row = samples.x;
    this->Slice = std::ptrdiff_t{ samples.x } * samples.y;
  }

  /// @param samples numbers of samples in the brick, x fastest
  HWY_INLINE Tint At(VI samples) const
  {
    const VI here = this->Further(samples, 0);
    return { { Scaled(Channel<0>(here)), Scaled(Channel<1>(here)), Scaled(Channel<2>(here)) } };
  }

  /// Interpolated byte by byte, as PlainInterpolator does.
  /// @param samples numbers of the first samples of cells
  /// @param x, y, z fractions of the way to the next ones
  HWY_INLINE Tint In(VI samples, VF x, VF y, VF z) const
  {
    const std::ptrdiff_t row = this->Row;
    const std::ptrdiff_t slice = this->Slice;
    // z changes first, then y, then x.
    const VI corners[8] = { this->Further(samples, 0), this->Further(samples, slice),
      this->Further(samples, row), this->Further(samples, row + slice), this->Further(samples, 1),
      this->Further(samples, 1 + slice), this->Further(samples, 1 + row),
      this->Further(samples, 1 + row + slice) };
    return { { Scaled(Mixed<0>(corners, x, y, z)), Scaled(Mixed<1>(corners, x, y, z)),
      Scaled(Mixed<2>(corners, x, y, z)) } };
  }

private:
  HWY_INLINE VI Further(VI samples, std::ptrdiff_t by) const
  {
    return hn::GatherIndex(DI(), this->Colours + by, samples);
  }

  static HWY_INLINE VF Scaled(VF bytes) { return hn::Mul(bytes, hn::Set(D(), 1.0f / 255.0f)); }

  template <int channel>
  static HWY_INLINE VF Channel(VI colours)
  {
    const VI byte = hn::And(hn::ShiftRight<8 * channel>(colours), hn::Set(DI(), 255));
    return hn::ConvertTo(D(), byte);
  }

  template <int channel>
  static HWY_INLINE VF Mixed(const VI (&corners)[8], VF x, VF y, VF z)
  {
    const auto edge = [&](int i) HWY_ATTR
    { return Mix(Channel<channel>(corners[i]), Channel<channel>(corners[i + 1]), z); };
    return Mix(Mix(edge(0), edge(2), y), Mix(edge(4), edge(6), y), x);
  }

  const std::int32_t* Colours;
  std::ptrdiff_t Row;
  std::ptrdiff_t Slice;
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
