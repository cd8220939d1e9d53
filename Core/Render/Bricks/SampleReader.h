// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_SampleReader_h
#define banyan_Render_Bricks_SampleReader_h

#include "Render/Bricks/ArraySamples.h"
#include "Render/Bricks/ColourNumbers.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{

/// Reads the samples of a SampleArray whose values have the type T: one component, the length of
/// all, or colours; NaN where hidden.
template <class T>
class SampleReader
{
public:
  /// @param numbers whether colours are read as ColourNumber, and not as what the opacity function
  /// is asked for
  explicit SampleReader(const SampleArray& array, bool numbers = false)
    : Array(array)
    , Values(static_cast<const T*>(array.Values))
    , Size(array.Samples.Size())
    , Numbers(numbers)
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
    else if (this->Array.Component == SampleArray::Colours)
    {
      this->ReadColours(row, begin, end, out);
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
    return this->Array.Component >= 0 && this->Array.Stride[0] == 1 && !this->Array.Flags;
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

  /// @param out double where Numbers
  template <class Out>
  void ReadColours(const T* row, int begin, int end, Out* out) const
  {
    const int count = std::min(this->Array.Components, 4);
    for (int x = begin; x < end; ++x)
    {
      double components[4];
      for (int c = 0; c < count; ++c)
      {
        components[c] =
          static_cast<double>(row[x * this->Array.Stride[0] + c * this->Array.ComponentStride]);
      }
      const double number = count == 1 ? components[0] : ColourNumber::Of(components, count);
      out[x - begin] = static_cast<Out>(this->Numbers ? number : ColourNumber::ShownOf(number));
    }
  }

  const SampleArray& Array;
  const T* Values;
  glm::ivec3 Size;
  bool Numbers;
};

} // namespace banyan

#endif
