// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see BlockDecoder.cxx.
#if defined(banyan_Codec_DensePlaces_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_DensePlaces_inl_h
#undef banyan_Codec_DensePlaces_inl_h
#else
#define banyan_Codec_DensePlaces_inl_h
#endif

#include "Codec/DenseLanes-inl.h"

#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{
#if HWY_TARGET != HWY_SCALAR && !HWY_HAVE_SCALABLE

/// The samples of a pass: predictions of whole rows, with their residuals.
template <class P, int B, class Number>
struct DensePlaces
{
  using InRows = DenseLanes<P, B>;
  using Unsigned = std::make_unsigned_t<Number>;
  static constexpr int D = P::D;
  static constexpr int S = P::S;
  static constexpr int N = InRows::N;
  /// Lanes that are worked on together: a row of 32 where a vector holds one. (At stride 2 half of
  /// them are left out anyway.)
  static constexpr int Together =
    B == 32 && S == 1 && 32 * static_cast<int>(sizeof(Number)) <= VectorBytes ? 32 : Width;
  using V = Numbers<Number, Together>;
  using Vector = typename V::Unsigned;

  Number* W; ///< of the unit
  Interpolation By;
  Number Bin;

  /// Lane First of a row. Interiors lie in their box, faces in memory of their own.
  HWY_INLINE Number* RowAt(int slice, int row) const
  {
    const block::Shape<2> faces{ B };
    return this->W + P::First +
           (D == 3 ? (slice * (B + 1) + row) * ((B + 1) * S)
                   : slice * S * faces.Y() + row * faces.Pitch());
  }

  HWY_INLINE void Predictions(int slice) const
  {
    for (int row = InRows::RowFirst; row < InRows::RowEnd; row += InRows::RowStep)
    {
      this->Prediction(slice, row);
    }
  }

  /// Predicts rows and adds their residuals.
  /// @param rows those that have some, as bits
  /// @param residuals of all lanes of the slice
  HWY_INLINE void WithResiduals(int slice, unsigned rows, const std::int8_t* residuals) const
  {
    for (int row = InRows::RowFirst; row < InRows::RowEnd; row += InRows::RowStep)
    {
      if ((rows >> row & 1u) == 0)
      {
        this->Prediction(slice, row);
        continue;
      }
      ForEachPart(
        [&](auto at)
        {
          const Vector residual = ResidualsAt<decltype(at)::value>(residuals + row * N);
          this->Set(slice, row, at,
            this->Predicted(slice, row, at) + residual * static_cast<Unsigned>(this->Bin));
        });
    }
  }

private:
  /// Calls body with the lane, from the first one on, where each part of a row begins.
  template <class Body>
  static HWY_INLINE void ForEachPart(const Body& body)
  {
    body(std::integral_constant<int, 0>());
    if constexpr (Together < B)
    {
      body(std::integral_constant<int, Together>());
    }
  }

  HWY_INLINE void Prediction(int slice, int row) const
  {
    ForEachPart([&](auto at) { this->Set(slice, row, at, this->Predicted(slice, row, at)); });
  }

  static constexpr std::ptrdiff_t Gap()
  {
    constexpr std::ptrdiff_t y = D == 3 ? B + 1 : 3 * (B + 8); // as block::Shape has it of faces
    return P::Axis == 0 ? S : P::Axis == 1 ? S * y : S * (B + 1) * (B + 1);
  }
  HWY_INLINE Vector Predicted(int slice, int row, int at) const
  {
    return PredictAt<P, Together>(static_cast<const Number*>(this->RowAt(slice, row) + at), Gap(),
      EdgeIs<B>{}, (P::Axis == D - 1 ? slice : row) * S, at, this->By);
  }
  HWY_INLINE void Set(int slice, int row, int at, Vector value) const
  {
    SetLanes<P>(value, B - P::First - at, this->RowAt(slice, row) + at);
  }

  /// Residuals of the lanes of a part; those that have none get anything.
  template <int At>
  static HWY_INLINE Vector ResidualsAt(const std::int8_t* row)
  {
    typedef std::int8_t Bytes __attribute__((vector_size(Together)));
    Bytes some;
    if constexpr (N > Width)
    {
      std::memcpy(&some, row + 1 + At, sizeof(some));
    }
    else
    {
      some = reinterpret_cast<SignedByteVector>(
        __builtin_shuffle(LoadRowOf<N>(row), LanesFrom<1 + At / S, 1, S>()));
    }
    return reinterpret_cast<Vector>(__builtin_convertvector(some, typename V::Signed));
  }
};

#endif
} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
