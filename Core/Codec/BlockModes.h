// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Codec_BlockModes_h
#define banyan_Codec_BlockModes_h

#include <cstdint>

/// How the samples of a block are predicted. The numbers are part of the file format.
namespace banyan::block
{

/// Which earlier decoded steps are subtracted first. A is the reference before, B the one after;
/// where there is none before, A is B.
enum class Reference : std::uint8_t
{
  None = 0,
  Mean = 1,     ///< (A + B) / 2
  HalfMean = 2, ///< (A + B) / 4: for motion too fast to trust the mean
  A = 3,
  B = 4
};
constexpr int References = 5;

/// How the rest is predicted from its neighbours along the axis of a pass.
enum class Interpolation : std::uint8_t
{
  Cubic = 0,
  Linear = 1,
  None = 2
};
constexpr int Interpolations = 3;

struct Mode
{
  Reference From = Reference::None;
  Interpolation By = Interpolation::Cubic;
  friend bool operator==(const Mode& a, const Mode& b) { return a.From == b.From && a.By == b.By; }
};

/// A mode as one number, 0 to ModeCount - 1.
constexpr int ModeCount = References * Interpolations;
constexpr int NumberOf(Mode mode)
{
  return static_cast<int>(mode.From) * Interpolations + static_cast<int>(mode.By);
}
constexpr Mode ModeOf(int number)
{
  return { static_cast<Reference>(number / Interpolations),
    static_cast<Interpolation>(number % Interpolations) };
}

} // namespace banyan::block

#endif
