// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_PixelPacking_h
#define banyan_Parallel_Composite_PixelPacking_h

#include <cstddef>
#include <cstdint>

namespace banyan
{

/// Lossless packing of pixels of four whole numbers of 16 bits.
///
/// Per channel the difference to the pixel before, modulo 2^16. A prediction is subtracted: green
/// follows from the difference of alpha, red and blue from alpha and green, (a * alpha + g * green)
/// / 32, rounded down, with five factors a and g that are fitted to these pixels (least squares);
/// they stand at the beginning, a byte with sign each: green's a, red's a and g, blue's a and g.
///
/// Then eight pixels after the other: numbers are made positive by zig-zag (0, -1, 1, -2, ...
/// become 0, 1, 2, 3, ...), and of these only as many bits are kept as the largest of the eight
/// needs: 0 to 14, or 16, as a code of 4 bits per channel (15 says 16). A group begins with a byte
/// of four steps from the codes of the group before (0 for the first one), 2 bits per channel, red
/// lowest: 0, 1, 2, 3 say 0, +1, -1, -2. Where these do not do, it is 255, and 2 bytes of codes
/// follow, red lowest. Then come the bits of each channel: first the lowest ones of the eight
/// numbers in one byte, first pixel lowest, then the next. Missing pixels of the last group have
/// differences 0.
/// @return bytes written, at most PackedBytesAtMost
std::size_t PackPixels(const std::uint16_t* numbers, std::size_t count, std::uint8_t* packed);

/// Returns the bytes that `packed` must have room for; the last 8 of them may be written without
/// being part of it.
std::size_t PackedBytesAtMost(std::size_t count);

/// The inverse. Throws Error when `bytes` are not exactly what `count` pixels take.
void UnpackPixels(
  const std::uint8_t* packed, std::size_t bytes, std::size_t count, std::uint16_t* numbers);

/// Without differences: each channel with the bits of its largest number in all pixels. Begins with
/// 4 bytes, the bits of each channel. For links that are faster than packing.
/// @return bytes written, at most PackedBytesAtMost
std::size_t WritePlain(const std::uint16_t* numbers, std::size_t count, std::uint8_t* written);

/// The inverse. Throws Error when `bytes` are not exactly what `count` pixels take.
void ReadPlain(
  const std::uint8_t* written, std::size_t bytes, std::size_t count, std::uint16_t* numbers);

} // namespace banyan

#endif
