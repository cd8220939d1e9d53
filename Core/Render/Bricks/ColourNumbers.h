// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_ColourNumbers_h
#define banyan_Render_Bricks_ColourNumbers_h

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace banyan
{

/// A colour as one sample, which bricks and messages carry like any other: the whole number
/// 2^32 + red + 2^8 green + 2^16 blue + 2^24 a. Red, green, blue and a are bytes, and a is what the
/// opacity function is asked for: alpha, or the luminance where there is none. NaN draws nothing.
/// Float64 has all these numbers; 2^32 tells them from values that data may have by themselves.
class ColourNumber
{
public:
  /// Components are rounded, and cut off at 0 and 255.
  /// @param components 3 or 4 numbers: red, green, blue, and alpha
  /// @return NaN if one of them is not finite
  static double Of(const double* components, int count)
  {
    std::uint32_t bytes[4] = {};
    for (int c = 0; c < count; ++c)
    {
      if (!std::isfinite(components[c]))
      {
        return std::numeric_limits<double>::quiet_NaN();
      }
      bytes[c] = ByteOf(components[c]);
    }
    bytes[3] = count > 3 ? bytes[3] : Luminance(bytes);
    return Offset + (bytes[0] | bytes[1] << 8 | bytes[2] << 16 | bytes[3] << 24);
  }

  static std::uint32_t ByteOf(double component)
  {
    const double upToNext = std::clamp(component, 0.0, 255.0) + 0.5;
    return static_cast<std::uint32_t>(upToNext);
  }

  /// As vtkImageLuminance weights them; rises with each of them.
  static std::uint32_t Luminance(const std::uint32_t* bytes)
  {
    const double upToNext = 0.30 * bytes[0] + 0.59 * bytes[1] + 0.11 * bytes[2] + 0.5;
    return static_cast<std::uint32_t>(upToNext);
  }

  /// Four bytes, red in the lowest; 0 for NaN.
  static std::uint32_t BytesOf(double number)
  {
    return number >= Offset ? static_cast<std::uint32_t>(number - Offset) : 0;
  }

  /// What the opacity function is asked for: 0 to 255, or NaN.
  static float ShownOf(double number)
  {
    return number >= Offset ? static_cast<float>(BytesOf(number) >> 24)
                            : std::numeric_limits<float>::quiet_NaN();
  }

private:
  static constexpr double Offset = 4294967296.0;
};

} // namespace banyan

#endif
