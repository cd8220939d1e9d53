// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_SampleReader_h
#define banyan_Render_Bricks_SampleReader_h

#include "Render/Bricks/ArraySamples.h"

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

  /// Reads samples [begin, end) of a row along x.
  /// @param y, z, begin, end positions in the array, from 0
  /// @param out float or double; end - begin of them
  template <class Out>
  void Read(int begin, int end, int y, int z, Out* out) const
  {
    const T* row = this->Values + y * this->Array.Stride[1] + z * this->Array.Stride[2];
    if (this->Array.Component == SampleArray::Magnitude)
    {
      this->ReadMagnitudes(row, begin, end, out);
    }
    else
    {
      row += this->Array.Component * this->Array.ComponentStride;
      const std::ptrdiff_t stride = this->Array.Stride[0];
      if (stride == 1)
      {
        for (int x = begin; x < end; ++x)
        {
          out[x - begin] = static_cast<Out>(row[x]);
        }
      }
      else
      {
        for (int x = begin; x < end; ++x)
        {
          out[x - begin] = static_cast<Out>(row[x * stride]);
        }
      }
    }
    if (this->Array.Flags)
    {
      const std::int64_t first = this->Size.x * (y + static_cast<std::int64_t>(this->Size.y) * z);
      for (int x = begin; x < end; ++x)
      {
        if (this->Array.Flags[first + x] & this->Array.HiddenBits)
        {
          out[x - begin] = std::numeric_limits<Out>::quiet_NaN();
        }
      }
    }
  }

  /// Whether rows lie in memory as Read would give them.
  bool IsPlain() const
  {
    return this->Array.Component != SampleArray::Magnitude && this->Array.Stride[0] == 1 &&
           !this->Array.Flags;
  }
  /// A sample, if IsPlain.
  const T* At(int x, int y, int z) const
  {
    return this->Values + this->Array.Component * this->Array.ComponentStride + x +
           y * this->Array.Stride[1] + z * this->Array.Stride[2];
  }
  std::ptrdiff_t RowStride() const { return this->Array.Stride[1]; }

private:
  template <class Out>
  void ReadMagnitudes(const T* row, int begin, int end, Out* out) const
  {
    for (int x = begin; x < end; ++x)
    {
      double sum = 0.0;
      for (int c = 0; c < this->Array.Components; ++c)
      {
        const auto value =
          static_cast<double>(row[x * this->Array.Stride[0] + c * this->Array.ComponentStride]);
        sum += value * value;
      }
      out[x - begin] = static_cast<Out>(std::sqrt(sum));
    }
  }

  const SampleArray& Array;
  const T* Values;
  glm::ivec3 Size;
};

} // namespace banyan

#endif
