// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Quantize_QuantizationError_h
#define banyan_Series_Quantize_QuantizationError_h

#include "Series/Quantize/OpacityWeight.h"
#include "Series/Quantize/Transform.h"

#include <cstddef>
#include <cstdint>

namespace banyan
{

/// Measures what coding did to the finite values of a component, in the domain of the data and in
/// the transformed one. Values that are not finite are left out (they are kept exactly); a finite
/// one that decodes to NaN counts as infinitely far away.
///
/// @par Source: "A study of time-varying octree and difference encoding", section 3.1, equations 1
/// and 2. The integrals over the density of the data are means over the data themselves:
///
///     (1)  E = 1/n * sum (x - x')^2        (2)  E = 1/n * sum a(x) * (x - x')^2
///
/// with x' what x decodes to and a(x) the opacity of the original value, 0 to 1.
struct QuantizationError
{
  std::int64_t Count = 0; ///< finite values
  double Greatest = 0.0;  ///< |x - x'|
  double SumSquared = 0.0;
  double SumWeighted = 0.0;         ///< of a(x) * (x - x')^2
  double SumOpacity = 0.0;          ///< of a(x)
  double GreatestTransformed = 0.0; ///< |f(x) - f(x')|
  double SumSquaredTransformed = 0.0;

  /// Equation 1, in squared units of the data; 0 without values.
  double MeanSquared() const;
  /// Equation 2, in squared units of the data; 0 without values.
  double OpacityWeighted() const;
  double MeanSquaredTransformed() const;

  /// Sums of both. The result depends on the order of merging by rounding only.
  void Merge(const QuantizationError& other);
};

/// Adds `count` pairs of original and decoded values. For all types of ScalarType.
/// @param opacity null: every value counts 1, and both equations are the same
template <class T>
void AddErrors(QuantizationError& error, const Transform& transform, const OpacityFunction* opacity,
  const T* original, const T* decoded, std::size_t count);

/// A mean squared error as a share of a range: error / (width * width). The paper's "less than 1 %"
/// is read as this being below 0.01. 0 when the width is 0.
double ShareOfSquaredRange(double meanSquared, const ValueRange& range);

/// Its root: the (weighted) root-mean-square error as a share of the range. Stricter: a share of
/// 0.01 here is one of 0.0001 above.
double RootShareOfRange(double meanSquared, const ValueRange& range);

/// Equation 1 in closed form: the uniform quantizer with `levels` levels over a range, for values
/// that are evenly distributed: D * D / 12, D = width / levels. Throws Error when levels < 1.
double UniformQuantizerError(const ValueRange& range, std::int64_t levels);

} // namespace banyan

#endif
