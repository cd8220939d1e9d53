// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_UnitMagnitudes_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_UnitMagnitudes_inl_h
#undef banyan_Codec_UnitMagnitudes_inl_h
#else
#define banyan_Codec_UnitMagnitudes_inl_h
#endif

#include "Codec/Simd/SliceDecoder-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Magnitudes at one stride, all zero at first.
template <int D, int N>
struct StrideMagnitudes
{
  using Shape = SliceShape<D, N>;
  static constexpr int Bytes = Shape::Count + 2 * Shape::Margin;

  std::uint8_t* First() { return this->All + Shape::Margin; }
  std::uint8_t* Row(int slice, int row) { return this->First() + slice * Shape::Slice + row * N; }
  void Clear() { std::memset(this->All, 0, sizeof(this->All)); }

  alignas(64) std::uint8_t All[Bytes] = {};
};

/// Magnitudes of units at both strides: what is known before is there at both, and what stride 2
/// adds comes to the other when it begins.
template <int D, int B>
struct UnitMagnitudes
{
  StrideMagnitudes<D, B / 2> Coarse;
  StrideMagnitudes<D, B> Fine;

  static constexpr int RowsOf(int n) { return D == 3 ? n : 3; }

  /// Magnitudes at stride S.
  template <int S>
  std::uint8_t* At()
  {
    return S == 2 ? this->Coarse.First() : this->Fine.First();
  }

  void Clear()
  {
    this->Coarse.Clear();
    this->Fine.Clear();
  }
  /// To be called when the fine ones hold what units begin with.
  HWY_INLINE void Coarsen()
  {
    this->ForEachRow(
      [](std::uint8_t* coarse, const std::uint8_t* fine)
      {
        for (int x = 0; x < B; x += Width)
        {
          const Bytes even = Picked<0, 2, 1>(Bytes::Load(fine + x));
          LowerHalf(even).Store(coarse + x / 2);
        }
      });
  }
  /// To be called between the strides.
  HWY_INLINE void Refine()
  {
    this->ForEachRow(
      [](const std::uint8_t* coarse, std::uint8_t* fine)
      {
        for (int x = 0; x < B; x += Width)
        {
          // Number i to byte 2 i.
          const auto wide = Widen<std::uint16_t>(Pack<std::uint8_t, 8>::Load(coarse + x / 2));
          const hn::CappedTag<std::uint8_t, Width> bytes;
          (Bytes::Load(fine + x) | Bytes{ hn::BitCast(bytes, wide.V) }).Store(fine + x);
        }
      });
  }

private:
  template <class Body>
  HWY_INLINE void ForEachRow(const Body& body)
  {
    for (int slice = 0; slice < B / 2; ++slice)
    {
      for (int row = 0; row < RowsOf(B / 2); ++row)
      {
        body(this->Coarse.Row(slice, row), this->Fine.Row(2 * slice, D == 3 ? 2 * row : row));
      }
    }
  }
};

/// Magnitudes of a block's faces and interior, and memory for a slice.
/// @param B their edge
template <int B>
struct BoxMagnitudes
{
  UnitMagnitudes<2, B> Faces;
  UnitMagnitudes<3, B> Interior;
  SliceMemory<B> Slice;

  /// Magnitudes of faces begin with those of the edges around them.
  void BeginFaces(const std::uint8_t (&edges)[3][block::MostEdge], std::uint16_t* sums)
  {
    const std::ptrdiff_t pitch = block::Shape<2>{ B }.SumPitch();
    this->Faces.Clear();
    constexpr int axes[3][2] = { { 0, 1 }, { 0, 2 }, { 1, 2 } };
    for (int face = 0; face < 3; ++face)
    {
      std::memcpy(this->Faces.Fine.Row(0, face), edges[axes[face][0]], B);
      sums[face] = SumOfRow(edges[axes[face][0]]);
      for (int y = 1; y < B; ++y)
      {
        *this->Faces.Fine.Row(y, face) = edges[axes[face][1]][y];
        sums[y * pitch + face] = edges[axes[face][1]][y];
      }
    }
    this->Faces.Coarsen();
  }

  /// Magnitudes of the interior begin with those of the faces, edges included.
  void BeginInterior(std::uint16_t* sums)
  {
    const std::ptrdiff_t pitch = block::Shape<3>{ B }.SumPitch();
    this->Interior.Clear();
    auto& faces = this->Faces.Fine;
    auto& to = this->Interior.Fine;
    for (int y = 0; y < B; ++y)
    {
      std::memcpy(to.Row(0, y), faces.Row(y, 0), B);
      sums[y] = SumOfRow(faces.Row(y, 0));
    }
    for (int z = 1; z < B; ++z)
    {
      const std::uint8_t* const first = faces.Row(z, 2);
      for (int y = 0; y < B; y += Width)
      {
        Widen<std::uint16_t>(Bytes::Load(first + y)).Store(sums + z * pitch + y);
      }
      std::memcpy(to.Row(z, 0), faces.Row(z, 1), B);
      sums[z * pitch] = SumOfRow(faces.Row(z, 1));
      for (int y = 1; y < B; ++y)
      {
        *to.Row(z, y) = first[y];
      }
    }
    this->Interior.Coarsen();
  }

private:
  static HWY_INLINE std::uint16_t SumOfRow(const std::uint8_t* row)
  {
    std::uint16_t sum = 0;
    for (int x = 0; x < B; x += Width)
    {
      sum = static_cast<std::uint16_t>(sum + SumOfBytes(Bytes::Load(row + x)));
    }
    return sum;
  }
};

/// To be called before each pass P of units.
template <class P, class Units>
HWY_INLINE void BeginStride(Units& units, const SymbolReader* symbols)
{
  if (P::S == 1 && P::Axis == 0 && symbols != nullptr)
  {
    units.Refine();
  }
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
