// Included once per SIMD target: see BlockDecoder.cxx and BlockEncoder.cxx.
#if defined(banyan_Codec_BlockUnits_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_BlockUnits_inl_h
#undef banyan_Codec_BlockUnits_inl_h
#else
#define banyan_Codec_BlockUnits_inl_h
#endif

#include "Codec/BlockPasses-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Samples in an array of any strides: where a unit lies in a box, or in a whole field.
template <class Number>
struct View
{
  Number* Base;
  glm::i64vec3 Stride;

  /// The same array with its axes in another order; see UnitAxes.
  View Along(const glm::ivec3& axes) const
  {
    return { this->Base,
      { this->Stride[axes.x], this->Stride[axes.y], this->Stride[axes.z] } };
  }
  View At(const glm::ivec3& position) const
  {
    return { this->Base + position.x * this->Stride.x + position.y * this->Stride.y +
               position.z * this->Stride.z,
      this->Stride };
  }
  Number* Row(int y, int z) const
  {
    return this->Base + y * this->Stride.y + z * this->Stride.z;
  }
};

/// Where the samples of references lie; the same place as the unit's own.
struct References
{
  block::Reference From = block::Reference::None;
  View<const std::int32_t> A{ nullptr, {} }, B{ nullptr, {} };

  References Along(const glm::ivec3& axes) const
  {
    return { this->From, this->A.Along(axes), this->B.Along(axes) };
  }
  References At(const glm::ivec3& position) const
  {
    return this->From == block::Reference::None
             ? *this
             : References{ this->From, this->A.At(position), this->B.At(position) };
  }
};

/// Axes of a unit (a mask of the free ones) in its own order: the free ones first.
constexpr int UnitCount = 7;
constexpr int UnitMasks[UnitCount] = { 1, 2, 4, 3, 5, 6, 7 };
inline glm::ivec3 UnitAxes(int mask)
{
  switch (mask)
  {
    case 2:
      return { 1, 0, 2 };
    case 4:
      return { 2, 0, 1 };
    case 5:
      return { 0, 2, 1 };
    case 6:
      return { 1, 2, 0 };
    default:
      return { 0, 1, 2 };
  }
}

/// Calls body(reference value of (x)) for the samples of a row, the reference's kind known to the
/// compiler.
template <int N, class Body>
HWY_INLINE void WithReferenceRow(const References& from, int y, int z, Body&& body)
{
  if (from.From == block::Reference::None)
  {
    body([](int) { return 0; });
    return;
  }
  const std::int32_t* a = from.A.Row(y, z);
  const std::int32_t* b = from.B.Row(y, z);
  const std::int64_t sa = from.A.Stride.x;
  const std::int64_t sb = from.B.Stride.x;
  // Wrapping arithmetic in 32 bits: samples are far from the limits, and hostile files stay safe.
  const auto with = [&](auto get)
  {
    if (sa == 1 && sb == 1)
    {
      body([&](int x) { return get(a[x], b[x]); });
    }
    else
    {
      body([&](int x) { return get(a[x * sa], b[x * sb]); });
    }
  };
  switch (from.From)
  {
    case block::Reference::Mean:
      return with([](std::int32_t p, std::int32_t q) { return Shifted(U(p) + U(q) + 1u, 1); });
    case block::Reference::HalfMean:
      return with([](std::int32_t p, std::int32_t q) { return Shifted(U(p) + U(q) + 2u, 2); });
    case block::Reference::A:
      return with([](std::int32_t p, std::int32_t) { return p; });
    default:
      return with([](std::int32_t, std::int32_t q) { return q; });
  }
}

/// Takes a unit with its borders (B + 1 samples per free axis) into scratch, less its reference.
template <int B, int D>
HWY_INLINE void LoadUnit(
  const View<const std::int32_t>& samples, const References& from, std::int32_t* HWY_RESTRICT w)
{
  constexpr int n = B + 1;
  for (int z = 0; z < (D > 2 ? n : 1); ++z)
  {
    for (int y = 0; y < (D > 1 ? n : 1); ++y)
    {
      const std::int32_t* row = samples.Row(y, z);
      if (D > 2)
      {
        // Rows lie far apart in whole fields: ask for those of the next slice in time.
        __builtin_prefetch(row + samples.Stride.z);
        __builtin_prefetch(row + samples.Stride.z + n - 1);
        if (from.From != block::Reference::None)
        {
          __builtin_prefetch(from.A.Row(y, z + 1));
          __builtin_prefetch(from.B.Row(y, z + 1));
        }
      }
      const std::int64_t stride = samples.Stride.x;
      std::int32_t* HWY_RESTRICT to = w + (z * n + y) * (B + 8);
      WithReferenceRow<n>(from, y, z,
        [&](auto reference)
        {
          if (stride == 1)
          {
            for (int x = 0; x < n; ++x)
            {
              to[x] = static_cast<std::int32_t>(U(row[x]) - U(reference(x)));
            }
            return;
          }
          for (int x = 0; x < n; ++x)
          {
            to[x] = static_cast<std::int32_t>(U(row[x * stride]) - U(reference(x)));
          }
        });
    }
  }
}

/// Puts the inside of a unit (samples 1 to B - 1 of its free axes) back, with its reference and
/// within the limits of the lattice.
template <int B, int D>
HWY_INLINE void StoreUnit(const std::int32_t* HWY_RESTRICT w, const References& from,
  std::int32_t least, std::int32_t greatest, const View<std::int32_t>& samples)
{
  for (int z = (D > 2 ? 1 : 0); z < (D > 2 ? B : 1); ++z)
  {
    for (int y = (D > 1 ? 1 : 0); y < (D > 1 ? B : 1); ++y)
    {
      std::int32_t* row = samples.Row(y, z);
      const std::int64_t stride = samples.Stride.x;
      const std::int32_t* HWY_RESTRICT in = w + (z * (B + 1) + y) * (B + 8);
      WithReferenceRow<B>(from, y, z,
        [&](auto reference)
        {
          const auto value = [&](int x)
          {
            const std::int32_t sum = static_cast<std::int32_t>(U(in[x]) + U(reference(x)));
            return std::min(std::max(sum, least), greatest);
          };
          if (stride == 1)
          {
            for (int x = 1; x < B; ++x)
            {
              row[x] = value(x);
            }
            return;
          }
          for (int x = 1; x < B; ++x)
          {
            row[x * stride] = value(x);
          }
        });
    }
  }
}

/// Sets the lanes of a row: prediction plus residual times bin.
template <int B>
HWY_INLINE void SetLanes(const LaneSet& lanes, const std::int32_t* HWY_RESTRICT prediction,
  const std::int32_t* HWY_RESTRICT residual, std::int32_t bin, std::int32_t* HWY_RESTRICT w)
{
  using V = Numbers<B>;
  const std::int32_t* mask = LaneMask<B>(lanes);
  for (int x = 0; x < B; x += V::Width)
  {
    const auto set = V::Load(mask + x);
    const auto value = V::Load(prediction + x) + V::Load(residual + x) * U(bin);
    V::Store((value & set) | (V::Load(w + x) & ~set), w + x);
  }
}

/// The same without residuals.
template <int B>
HWY_INLINE void SetLanes(const LaneSet& lanes, const std::int32_t* HWY_RESTRICT prediction,
  std::int32_t* HWY_RESTRICT w)
{
  using V = Numbers<B>;
  const std::int32_t* mask = LaneMask<B>(lanes);
  for (int x = 0; x < B; x += V::Width)
  {
    const auto set = V::Load(mask + x);
    V::Store((V::Load(prediction + x) & set) | (V::Load(w + x) & ~set), w + x);
  }
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
