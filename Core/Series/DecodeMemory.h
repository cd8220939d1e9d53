#ifndef banyan_Series_DecodeMemory_h
#define banyan_Series_DecodeMemory_h

#include "Series/LatticeBox.h"

#include <cstdint>
#include <vector>

namespace banyan
{

/// What a thread decodes with.
struct DecodeMemory
{
  std::vector<std::int32_t> Coarse, A, B, Box, Faces[3];

  static const std::int32_t* Take(
    std::vector<std::int32_t>& numbers, const LatticeBox& box, std::size_t n)
  {
    numbers.resize(n * n * n);
    box.CopyTo(numbers.data());
    return numbers.data();
  }

  /// The first layer of a neighbour along an axis.
  const std::int32_t* TakeFace(std::size_t axis, const LatticeBox& box, std::size_t n)
  {
    std::vector<std::int32_t>& face = this->Faces[axis];
    face.resize(n * n);
    if (axis == 0)
    {
      box.CopyTo(0, n, n * n, face.data());
    }
    else if (axis == 2)
    {
      box.CopyTo(0, 1, n * n, face.data());
    }
    else
    {
      for (std::size_t z = 0; z < n; ++z)
      {
        box.CopyTo(z * n * n, 1, n, face.data() + z * n);
      }
    }
    return face.data();
  }
};

} // namespace banyan

#endif
