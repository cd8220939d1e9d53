// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_FragmentFormat_h
#define banyan_Parallel_Composite_FragmentFormat_h

#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>

namespace banyan
{

/// How the pixels of one message are written down: as floats, or as four whole numbers of at most
/// 16 bits (QuantizePixels). A few bytes that are sent as they are.
///
/// @par How far whole numbers may be off
/// Let n fragments that travel meet in a pixel, among others that do not travel, and let a picture
/// be that of exact fragments (c_i, a_i), blended front to back. Replace the fragments by rounded
/// ones (c'_i, a'_i) one after the other, the frontmost first. Each step changes the picture by
///
///     T'_i * ((c'_i - c_i) - (a'_i - a_i) * B_i)
///
/// where T'_i is the product of 1 - a'_j over what lies before, and B_i in [0, M] the exact picture
/// of what lies behind. M is 1 unless colours exceed their opacity. Since B_i is not known to the
/// sender, it rounds c_i + (a'_i - a_i) * M / 2 instead of c_i: then the bracket is at most half a
/// step of colours and M / 2 times the error of the opacity. (Should that number fall below 0, it
/// becomes 0, which is no worse while the error of the opacity, times M, is not larger than a step
/// of colours.)
///
/// All steps grow with w = 0.7 * a' + 0.3 / n: coarser where the fragment hides more. The sum of
/// T'_i * a'_i never exceeds 1, nor does that of T'_i / n: so that of T'_i * w_i is at most 1,
/// however many fragments there are, and what follows is the error of all n together.
///
/// - Colours have steps of w * share / 172: 1 / 2 / 172 < 0.742 / 255, times share.
/// - Opacities are written down as whole numbers q, a' = 3 / 7 / n * (exp(q / F) - 1), with
///   F = 255 * M / 0.7 / share: steps of w * share / 255 / M, to one part in 1000. M / 2 times half
///   a step make 0.25 / 255, times share.
///
/// Both together stay below share / 255, with room for the rounding of floats. So two pictures of
/// share 1, rounded to 8 bits, differ by at most 1; and fragments that are blended to partial
/// pictures, which travel again, may do both at share 1/2. At share 1, colours need 8 bits whatever
/// n and opacities 9 to 11 (n up to 100), where equal steps would need 8 + log2(n) bits for each.
struct FragmentFormat
{
  enum : std::uint8_t
  {
    Floats,  ///< four floats per pixel
    Bytes,   ///< each channel rounded to 8 bits: right when a pixel is not blended any more
    Fragment ///< as above
  };
  std::uint8_t Kind = Floats;
  std::uint8_t Shares = 1;   ///< 1 / share
  std::uint16_t Meeting = 1; ///< n
  float Brightest = 1.0f;    ///< M
};

/// The format of fragments of which up to `meeting` meet in a pixel; floats when 16 bits are not
/// enough for opacities (of colours many times brighter than 1).
/// @param shares 1 / share, at least 1
/// @param brightest largest colour over opacity, at least 1
FragmentFormat FormatOfFragments(int meeting, int shares, float brightest);

/// Pixels as whole numbers, red, green, blue, alpha one after the other. Transparent black is all
/// 0.
/// @param format not floats
/// @param numbers receives 4 * count; saturated, so that pixels out of range do no harm to others
void QuantizePixels(
  const FragmentFormat& format, const glm::vec4* pixels, std::size_t count, std::uint16_t* numbers);

/// Writes the pixels that QuantizePixels has rounded to.
void RestorePixels(
  const FragmentFormat& format, const std::uint16_t* numbers, std::size_t count, glm::vec4* pixels);

} // namespace banyan

#endif
