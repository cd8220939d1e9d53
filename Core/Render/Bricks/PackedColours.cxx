// SPDX-License-Identifier: BSD-3-Clause
// The colours of a packed brick.
#include "Render/Bricks/ColourNumbers.h"
#include "Render/Bricks/PackedBrick.h"

#include <cmath>

namespace banyan
{

/// Sets the colours, too.
/// @param view float64
/// @param samples all of Whole, and some around
PackedBrick::Dense PackedBrick::ConvertColours(
  const BrickView& view, const glm::ivec3& corner, const Box& samples)
{
  Dense dense;
  dense.Samples = samples;
  dense.Values.resize(static_cast<std::size_t>(samples.Count()));
  const Box own{ this->Whole.Lo, this->Whole.Hi + 1 };
  this->Colours.resize(static_cast<std::size_t>(own.Count()));
  float* value = dense.Values.data();
  std::uint32_t* colour = this->Colours.data();
  for (int z = samples.Lo.z; z < samples.Hi.z; ++z)
  {
    for (int y = samples.Lo.y; y < samples.Hi.y; ++y)
    {
      const glm::ivec3 first = glm::ivec3(samples.Lo.x, y, z) - corner;
      const double* numbers = static_cast<const double*>(view.Values) + first.x * view.Stride[0] +
                              first.y * view.Stride[1] + first.z * view.Stride[2];
      for (int x = samples.Lo.x; x < samples.Hi.x; ++x, numbers += view.Stride[0])
      {
        *value = ColourNumber::ShownOf(*numbers);
        this->HasSpecial = this->HasSpecial || std::isnan(*value);
        ++value;
        if (own.Contains(glm::ivec3(x, y, z)))
        {
          *colour++ = ColourNumber::BytesOf(*numbers);
        }
      }
    }
  }
  return dense;
}

BrickView PackedBrick::ColourView(int channel) const
{
  const glm::ivec3 samples = this->Whole.Size() + 1;
  BrickView view;
  view.Values = reinterpret_cast<const std::uint8_t*>(this->Colours.data()) + channel;
  view.Type = ScalarType::UInt8;
  view.Stride[0] = sizeof(std::uint32_t);
  view.Stride[1] = view.Stride[0] * samples.x;
  view.Stride[2] = view.Stride[1] * samples.y;
  return view;
}

} // namespace banyan
