// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Codec_BlockScratch_h
#define banyan_Codec_BlockScratch_h

#include <glm/vec3.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace banyan::block
{

/// The largest edge of blocks; the other one is 16.
constexpr int MostEdge = 32;

/// How the memory of units is laid out. A unit is what is left of a block between what is known:
/// its three edges (one dimension), its three faces (two), or its interior (three). Edges, and
/// faces, are coded together: their rows lie side by side, number 0 to 2.
///
/// Rows have room on both sides, because predictions of whole vectors read (and ignore) lanes
/// beyond the ends; so have magnitudes, with zeros before the first lane.
template <int D>
struct Shape
{
  int Edge;

  constexpr std::ptrdiff_t Pitch() const { return this->Edge + 8; }
  /// Distance of rows that follow each other along y, and along z.
  constexpr std::ptrdiff_t Y() const { return D == 2 ? 3 * this->Pitch() : this->Pitch(); }
  constexpr std::ptrdiff_t Z() const { return D > 2 ? (this->Edge + 1) * this->Pitch() : 0; }
  /// The same for magnitudes, which have no last row.
  constexpr std::ptrdiff_t MagnitudeZ() const { return D > 2 ? this->Edge * this->Pitch() : 0; }

  constexpr std::size_t Samples() const
  {
    const std::ptrdiff_t n = this->Edge + 1;
    return static_cast<std::size_t>((D == 1 ? 3 : D == 2 ? 3 * n : n * n) * this->Pitch() + 48);
  }
  constexpr std::size_t Magnitudes() const
  {
    const std::ptrdiff_t n = this->Edge;
    return static_cast<std::size_t>((D == 1 ? 3 : D == 2 ? 3 * n : n * n) * this->Pitch() + 48);
  }

  /// Distance of the sums of magnitudes of rows, from slice to slice; those of a slice lie side by
  /// side: along y, or those of three faces or edges.
  constexpr std::ptrdiff_t SumPitch() const { return D > 2 ? this->Edge + 16 : 16; }
  constexpr std::size_t Sums() const
  {
    return static_cast<std::size_t>((D == 1 ? 1 : this->Edge) * this->SumPitch() + 32);
  }
};

/// Memory of the units of D dimensions of a block.
template <class Number, int D>
class Scratch
{
public:
  explicit Scratch(int edge)
    : SamplesAt(Shape<D>{ edge }.Samples())
    , MagnitudesAt(Shape<D>{ edge }.Magnitudes())
    , ResidualsAt(MagnitudesAt.size())
    , SumsAt(Shape<D>{ edge }.Sums())
  {
  }

  /// Sample 0 of the first row. Samples 0 to edge of each axis.
  Number* Samples() { return this->SamplesAt.data() + 16; }
  /// Magnitude of the residual there. 0 to edge - 1 of each axis.
  std::uint8_t* Magnitudes() { return this->MagnitudesAt.data() + 16; }
  /// The residuals of the unit itself, from -15 to 15; of edges none is kept.
  std::int8_t* Residuals() { return this->ResidualsAt.data() + 16; }
  /// Sums of the magnitudes of rows.
  std::uint16_t* RowSums() { return this->SumsAt.data() + 16; }
  void Clear()
  {
    std::fill(this->SumsAt.begin(), this->SumsAt.end(), std::uint16_t{ 0 });
    std::fill(this->MagnitudesAt.begin(), this->MagnitudesAt.end(), std::uint8_t{ 0 });
    std::fill(this->ResidualsAt.begin(), this->ResidualsAt.end(), std::int8_t{ 0 });
  }

private:
  std::vector<Number> SamplesAt;
  std::vector<std::uint8_t> MagnitudesAt;
  std::vector<std::int8_t> ResidualsAt;
  std::vector<std::uint16_t> SumsAt;
};

/// Magnitudes of faces start with those of the edges around them.
/// @param edges along x, y, z
inline void PlaceEdges(int edge, const std::uint8_t (&edges)[3][MostEdge], std::uint8_t* faces)
{
  const Shape<2> shape{ edge };
  constexpr int axes[3][2] = { { 0, 1 }, { 0, 2 }, { 1, 2 } };
  for (int face = 0; face < 3; ++face)
  {
    std::uint8_t* m = faces + face * shape.Pitch();
    std::copy_n(edges[axes[face][0]], edge, m);
    for (int y = 1; y < edge; ++y)
    {
      m[y * shape.Y()] = edges[axes[face][1]][y];
    }
  }
}

/// Magnitudes of the interior start with those of the faces, edges included.
inline void PlaceFaces(int edge, const std::uint8_t* faces, std::uint8_t* interior)
{
  const Shape<2> from{ edge };
  const Shape<3> to{ edge };
  for (int j = 0; j < edge; ++j)
  {
    std::copy_n(faces + j * from.Y(), edge, interior + j * to.Y());
  }
  for (int k = 1; k < edge; ++k)
  {
    std::copy_n(faces + from.Pitch() + k * from.Y(), edge, interior + k * to.MagnitudeZ());
    const std::uint8_t* yz = faces + 2 * from.Pitch() + k * from.Y();
    for (int j = 1; j < edge; ++j)
    {
      interior[k * to.MagnitudeZ() + j * to.Y()] = yz[j];
    }
  }
}

/// Lattices that are no larger have predictions in 16-bit arithmetic (which wraps), others in
/// 32-bit. Part of the file format.
inline bool Narrow(std::int32_t least, std::int32_t greatest)
{
  constexpr std::int32_t most = 8000;
  return least >= -most && greatest <= most && greatest - least <= most;
}

} // namespace banyan::block

#endif
