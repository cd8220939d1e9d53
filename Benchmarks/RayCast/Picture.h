// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_Picture_h
#define banyan_Benchmarks_Picture_h

#include "Render/Levels/RayCaster.h"

#include <cstdint>
#include <string>
#include <vector>

namespace banyan::bench
{

/// A square picture as a screen gets it: over black, 8 bits per channel, `[y][x][rgb]`, y up.
struct Picture
{
  int Size = 0;
  std::vector<std::uint8_t> Rgb;
};

/// Rounds each channel. Pixels that the image does not have are black.
Picture Rounded(const FloatImage& image, int size);

/// How far a picture is from the reference: over red, green and blue of all pixels.
struct PictureError
{
  double PsnrDecibels = 0; ///< against the full range of a channel
  double Largest = 0;      ///< of any channel of any pixel, in 1/255
};

/// @param reference not rounded; so no picture of 8 bits is nearer to it than about 59 dB, or half
///        of 1/255
PictureError ErrorOf(const Picture& picture, const FloatImage& reference);

/// The same of a picture that was not rounded, which may lack black pixels.
PictureError ErrorOf(const FloatImage& picture, const FloatImage& reference);

/// As a portable pixel map (binary PPM), top row first. Throws Error when it cannot be written.
void WritePicture(const Picture& picture, const std::string& path);

} // namespace banyan::bench

#endif
