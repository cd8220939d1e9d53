#ifndef banyan_Render_SampleReader_h
#define banyan_Render_SampleReader_h

#include "Render/ArrayBrickSource.h"

#include <cmath>
#include <limits>

namespace banyan
{

/// Reads the samples of a SampleArray whose values have the type T: one component or the length of
/// all, NaN where hidden.
template <class T>
class SampleReader
{
public:
  explicit SampleReader(const SampleArray& array)
    : Array(array)
    , Values(static_cast<const T*>(array.Values))
    , Size(array.Samples.Size())
  {
  }

  /// @param x, y, z position in the array, from 0
  double At(int x, int y, int z) const
  {
    if (this->Array.Flags)
    {
      const std::int64_t index =
        x + this->Size.x * (y + static_cast<std::int64_t>(this->Size.y) * z);
      if (this->Array.Flags[index] & this->Array.HiddenBits)
      {
        return std::numeric_limits<double>::quiet_NaN();
      }
    }
    const T* sample = this->Values + x * this->Array.Stride[0] + y * this->Array.Stride[1] +
                      z * this->Array.Stride[2];
    if (this->Array.Component != SampleArray::Magnitude)
    {
      return static_cast<double>(sample[this->Array.Component * this->Array.ComponentStride]);
    }
    double sum = 0.0;
    for (int c = 0; c < this->Array.Components; ++c)
    {
      const auto value = static_cast<double>(sample[c * this->Array.ComponentStride]);
      sum += value * value;
    }
    return std::sqrt(sum);
  }

private:
  const SampleArray& Array;
  const T* Values;
  glm::ivec3 Size;
};

} // namespace banyan

#endif
