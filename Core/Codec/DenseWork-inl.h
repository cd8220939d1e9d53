// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see BlockDecoder.cxx.
#if defined(banyan_Codec_DenseWork_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_DenseWork_inl_h
#undef banyan_Codec_DenseWork_inl_h
#else
#define banyan_Codec_DenseWork_inl_h
#endif

#include "Codec/DenseSlices-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{
#if HWY_TARGET != HWY_SCALAR && !HWY_HAVE_SCALABLE

/// Magnitudes at one stride, all zero at first.
template <int D, int N>
struct DenseMagnitudesOf
{
  using Shape = DenseShape<D, N>;
  static constexpr int Bytes = Shape::Count + 2 * Shape::Margin;

  std::uint8_t* M() { return this->All + Shape::Margin; }
  std::uint8_t* Row(int slice, int row) { return this->M() + slice * Shape::Slice + row * N; }
  void Clear() { std::memset(this->All, 0, sizeof(this->All)); }

  alignas(64) std::uint8_t All[Bytes] = {};
};

/// Magnitudes of units at both strides: what is known before is there at both, and what stride 2
/// adds comes to the other when it begins.
template <int D, int B>
struct DenseUnits
{
  DenseMagnitudesOf<D, B / 2> Coarse;
  DenseMagnitudesOf<D, B> Fine;

  static constexpr int RowsOf(int n) { return D == 3 ? n : 3; }

  /// Magnitudes at stride S.
  template <int S>
  std::uint8_t* At()
  {
    return S == 2 ? this->Coarse.M() : this->Fine.M();
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
          const ByteVector even = Compressed<2>(LoadVector<ByteVector>(fine + x));
          std::memcpy(coarse + x / 2, &even, 8);
        }
      });
  }
  /// To be called between the strides.
  HWY_INLINE void Refine()
  {
    this->ForEachRow(
      [](const std::uint8_t* coarse, std::uint8_t* fine)
      {
        // Number i to byte 2 i.
        const ByteVector mask{ 255, 0, 255, 0, 255, 0, 255, 0, 255, 0, 255, 0, 255, 0, 255, 0 };
        for (int x = 0; x < B; x += Width)
        {
          StoreVector(LoadVector<ByteVector>(fine + x) |
                        (Expanded<2>(LoadVector<ByteVector>(coarse + x / 2)) & mask),
            fine + x);
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

/// What contexts of blocks are computed with.
/// @param B their edge
template <int B>
struct DenseWork
{
  DenseUnits<2, B> Faces;
  DenseUnits<3, B> Interior;
  DenseMemory<B> Slice;

  /// Magnitudes of faces begin with those of the edges around them.
  void BeginFaces(const std::uint8_t (&edges)[3][64], std::uint16_t* sums)
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

  /// Those of the interior begin with those of the faces, edges included.
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
        StoreVector(__builtin_convertvector(LoadVector<ByteVector>(first + y), SumVector),
          sums + z * pitch + y);
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
      sum = static_cast<std::uint16_t>(sum + SumOf(LoadVector<ByteVector>(row + x)));
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

#else
template <int B>
struct DenseWork;
#endif
} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
