// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_SlicePredictions_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_SlicePredictions_inl_h
#undef banyan_Codec_SlicePredictions_inl_h
#else
#define banyan_Codec_SlicePredictions_inl_h
#endif

#include "Codec/Simd/RowLanes-inl.h"

#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// The samples of a pass: predictions of whole rows, with their residuals.
template <class P, int B, class Number>
struct SlicePredictions
{
  using InRows = RowLanes<P, B>;
  static constexpr int D = P::D;
  static constexpr int S = P::S;
  static constexpr int N = InRows::N;
  /// Lanes that are worked on together: a register of them.
  static constexpr int Together = std::min(B, RegisterLanes<Number>);
  using V = Pack<Number, Together>;

  Number* Unit; ///< its samples
  Interpolation By;
  Number Bin;

  /// Lane First of a row. Interiors lie in their box, faces in memory of their own.
  HWY_INLINE Number* RowAt(int slice, int row) const
  {
    const block::Shape<2> faces{ B };
    return this->Unit + P::First +
           (D == 3 ? (slice * (B + 1) + row) * ((B + 1) * S)
                   : slice * S * faces.Y() + row * faces.Pitch());
  }

  HWY_INLINE void WithoutResiduals(int slice) const
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
      ForEachPart<B, Together>(
        [&](auto at)
        {
          const V residual = ResidualsFrom(residuals + row * N + 1 + at() / S);
          this->template Set<at()>(
            slice, row, this->template Predicted<at()>(slice, row) + residual * V::Set(this->Bin));
        });
    }
  }

private:
  HWY_INLINE void Prediction(int slice, int row) const
  {
    ForEachPart<B, Together>([&](auto at)
      { this->template Set<at()>(slice, row, this->template Predicted<at()>(slice, row)); });
  }

  static constexpr std::ptrdiff_t Gap()
  {
    constexpr std::ptrdiff_t y = D == 3 ? B + 1 : 3 * (B + 8); // as block::Shape has it of faces
    return P::Axis == 0 ? S : P::Axis == 1 ? S * y : S * (B + 1) * (B + 1);
  }
  template <int At>
  HWY_INLINE V Predicted(int slice, int row) const
  {
    return PredictAt<P, B, At, Together>(static_cast<const Number*>(this->RowAt(slice, row) + At),
      Gap(), (P::Axis == D - 1 ? slice : row) * S, this->By);
  }
  template <int At>
  HWY_INLINE void Set(int slice, int row, const V& value) const
  {
    SetLanes<P, B, At>(value, this->RowAt(slice, row) + At);
  }

  /// Residuals of the lanes of a part; those between, at stride 2, get anything: every second lane
  /// of the part is the lower half of a number of twice the size.
  static HWY_INLINE V ResidualsFrom(const std::int8_t* from)
  {
    if constexpr (S == 1)
    {
      return Widen<Number>(Pack<std::int8_t, Together>::Load(from));
    }
    else
    {
      const auto some = Pack<std::int8_t, Together / 2>::Load(from);
      if constexpr (sizeof(Number) == sizeof(std::int16_t))
      {
        const auto wide = Widen<std::int32_t>(some);
        return { hn::BitCast(typename V::Tag(), wide.V) };
      }
      else
      {
        const auto wide = Widen<std::int64_t>(Widen<std::int32_t>(some));
        return { hn::BitCast(typename V::Tag(), wide.V) };
      }
    }
  }
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
