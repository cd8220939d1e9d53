// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Series_MeanOfLeaves_h
#define banyan_Mesh_Series_MeanOfLeaves_h

#include "Mesh/Series/Rounded.h"
#include "Mesh/Series/StoredMesh.h"
#include "Series/Quantize/FillValues.h"

#include <cmath>

namespace banyan
{

/// The value of a cell that leaves were merged into: their mean, weighted by volume, summed in
/// double precision in the order of their Morton keys. Integers are rounded. NaN if one of them is;
/// a fill value if one of them is. That of a single leaf is its own, bit for bit.
/// @param Out the type T of the values, or a real that the mean is wanted as
/// @param image `[sample][components]`
/// @param component of the image
/// @param first, end the leaves; at least one
/// @param isFill receives whether it is a fill value; may be null
template <class Out, class T>
Out MeanOfLeaves(const StoredMesh& mesh, const T* image, int components, int component,
  std::size_t first, std::size_t end, const FillSet<T>& fills, bool* isFill = nullptr)
{
  const auto valueOf = [&](std::size_t leaf)
  {
    return image[std::int64_t{ mesh.SampleOfCell[mesh.CellOfLeaf[leaf]] } * components + component];
  };
  const auto cellsOf = [&](std::size_t leaf)
  { return static_cast<double>(CubeKeys(mesh.Leaves.Levels[leaf])); };
  double volume = 0.0;
  for (std::size_t leaf = first; leaf < end; ++leaf)
  {
    const T value = valueOf(leaf);
    const bool fill = fills.Holds(value);
    if (isFill)
    {
      *isFill = fill;
    }
    if (fill || end - first == 1)
    {
      return static_cast<Out>(value);
    }
    volume += cellsOf(leaf);
  }
  // Sums of the largest doubles, as often as there are finest cells, would be infinite. Powers of
  // two change no digit.
  int exponent = 0;
  const double part = std::frexp(volume, &exponent);
  double sum = 0.0;
  for (std::size_t leaf = first; leaf < end; ++leaf)
  {
    sum += std::ldexp(cellsOf(leaf), -exponent) * static_cast<double>(valueOf(leaf));
  }
  return Rounded<Out>(MeanOfPart(sum, part));
}

} // namespace banyan

#endif
