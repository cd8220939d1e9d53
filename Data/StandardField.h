// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_StandardField_h
#define banyan_Data_StandardField_h

#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace banyan
{

/// The field of the ray caster's standard scenes, in [0, 1] over the cube [0, 1]^3: eight Gaussian
/// blobs and two waves.
double StandardField(const glm::dvec3& position);

/// Samples of StandardField at i / (size - 1) per axis. All of its terms are products of factors
/// that depend on one or two coordinates, which are tabulated: a few additions per sample. The same
/// within the rounding of float.
class StandardFieldSlices
{
public:
  /// @param size samples per axis, at least 2
  explicit StandardFieldSlices(int size);

  /// @param z in [0, size)
  /// @param values receives the slice, `[y][x]`, size^2 of them
  void Slice(int z, float* values) const;

private:
  /// A factor per sample of an axis.
  using Factors = std::vector<double>;

  std::size_t Size;
  std::vector<Factors> BlobFactors[3]; ///< per axis and blob; the amplitude is in z
  Factors Sine;                        ///< of 8 pi x, the same for all axes
  std::vector<double> WaveInPlane;     ///< sin(2 pi (9x + 5y)), `[y][x]`
};

} // namespace banyan

#endif
