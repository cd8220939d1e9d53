// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_RayBlend_h
#define banyan_Render_Scene_RayBlend_h

#include <limits>

namespace banyan
{

/// How the samples of a ray become a pixel; as VTK's volume mappers define it.
enum class BlendMode
{
  Composite, ///< front to back, each sample with its colour and opacity
  Maximum,   ///< colour and opacity of the highest value
  Minimum,   ///< colour and opacity of the lowest value
  Average    ///< the mean of value times opacity, in grey and opaque
};

struct RayBlend
{
  BlendMode Mode = BlendMode::Composite;

  // For the average only.

  /// Samples of other values do not count.
  double AveragedLow = -std::numeric_limits<double>::infinity();
  double AveragedHigh = std::numeric_limits<double>::infinity();
  /// Values that a picture shows in black and in white where they are opaque; values beyond count
  /// as these.
  double Black = 0.0;
  double White = 1.0;
};

/// What the value between samples of the grid is.
enum class SampleInterpolation
{
  Linear, ///< trilinear
  Nearest ///< that of the nearest sample: for labels
};

} // namespace banyan

#endif
