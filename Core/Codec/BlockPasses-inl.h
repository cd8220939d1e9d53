// Included once per SIMD target: see BlockDecoder.cxx and BlockEncoder.cxx.
#if defined(banyan_Codec_BlockPasses_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_BlockPasses_inl_h
#undef banyan_Codec_BlockPasses_inl_h
#else
#define banyan_Codec_BlockPasses_inl_h
#endif

#include "Codec/BlockModes.h"
#include "Codec/BlockScratch.h"

#include <algorithm>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

using block::Interpolation;

/// The lanes of a row that a pass predicts: First, First + Step, ... below B.
struct LaneSet
{
  int First;
  int Step;
};

/// -1 for the lanes of a set.
template <int B, class Number = std::int32_t>
HWY_INLINE const Number* LaneMask(const LaneSet& set)
{
  struct Masks
  {
    alignas(64) Number Of[4][B] = {};
    constexpr Masks()
    {
      for (int x = 0; x < B; ++x)
      {
        Of[0][x] = x >= 1 ? -1 : 0;              // 1, 2, 3, ...
        Of[1][x] = x % 2 == 1 ? -1 : 0;          // 1, 3, 5, ...
        Of[2][x] = x >= 2 && x % 2 == 0 ? -1 : 0; // 2, 4, 6, ...
        Of[3][x] = x % 4 == 2 ? -1 : 0;          // 2, 6, 10, ...
      }
    }
  };
  static constexpr Masks masks{};
  return masks.Of[(set.First - 1) * 2 + (set.Step > set.First ? 1 : 0)];
}

// Wrapping arithmetic: files made with ill intent must not reach undefined behaviour.
HWY_INLINE std::uint32_t U(std::int32_t a)
{
  return static_cast<std::uint32_t>(a);
}
HWY_INLINE std::int32_t Shifted(std::uint32_t a, int bits)
{
  return static_cast<std::int32_t>(a) >> bits;
}

/// Numbers of a row, as vectors of up to 16 (of the compiler: it splits them for every target).
template <int B>
struct Numbers
{
  static constexpr int Width = B < 16 ? B : 16;
  static constexpr int Count = B / Width;
  typedef std::uint32_t Unsigned __attribute__((vector_size(4 * Width)));
  typedef std::int32_t Signed __attribute__((vector_size(4 * Width)));

  static HWY_INLINE Unsigned Load(const std::int32_t* from)
  {
    Unsigned result;
    std::memcpy(&result, from, sizeof(result));
    return result;
  }
  static HWY_INLINE void Store(Unsigned value, std::int32_t* to)
  {
    std::memcpy(to, &value, sizeof(value));
  }
  static HWY_INLINE Unsigned Shift(Unsigned value, int bits)
  {
    return reinterpret_cast<Unsigned>(reinterpret_cast<Signed>(value) >> bits);
  }

  static HWY_INLINE Unsigned Cubic(Unsigned a, Unsigned b, Unsigned c, Unsigned d)
  {
    return Shift(9u * (b + c) - a - d + 8u, 4);
  }
  static HWY_INLINE Unsigned Quadratic(Unsigned near, Unsigned other, Unsigned far)
  {
    return Shift(3u * near + 6u * other - far + 4u, 3);
  }
  static HWY_INLINE Unsigned Linear(Unsigned a, Unsigned b) { return Shift(a + b + 1u, 1); }
};

/// Predicts a row from rows at distance `gap` (in elements) on both sides.
/// @param position of the row along the axis of the pass, and @param s the stride
template <int B>
HWY_INLINE void PredictAcross(const std::int32_t* w, std::ptrdiff_t gap, int position, int s,
  Interpolation by, std::int32_t* HWY_RESTRICT prediction)
{
  using V = Numbers<B>;
  for (int i = 0; i < V::Count; ++i, w += V::Width, prediction += V::Width)
  {
    typename V::Unsigned result{};
    if (by != Interpolation::None)
    {
      const auto before = V::Load(w - gap);
      const auto after = V::Load(w + gap);
      if (by == Interpolation::Linear)
      {
        result = V::Linear(before, after);
      }
      else if (position - 3 * s < 0)
      {
        result = V::Quadratic(before, after, V::Load(w + 3 * gap));
      }
      else if (position + 3 * s > B)
      {
        result = V::Quadratic(after, before, V::Load(w - 3 * gap));
      }
      else
      {
        result = V::Cubic(V::Load(w - 3 * gap), before, after, V::Load(w + 3 * gap));
      }
    }
    V::Store(result, prediction);
  }
}

/// Predicts lanes of a row from the row itself. Lanes outside the set hold anything.
template <int B>
HWY_INLINE void PredictAlong(
  const std::int32_t* w, int s, Interpolation by, std::int32_t* HWY_RESTRICT prediction)
{
  using V = Numbers<B>;
  for (int i = 0; i < V::Count; ++i)
  {
    const std::int32_t* at = w + i * V::Width;
    typename V::Unsigned result{};
    if (by != Interpolation::None)
    {
      const auto before = V::Load(at - s);
      const auto after = V::Load(at + s);
      result = by == Interpolation::Linear
                 ? V::Linear(before, after)
                 : V::Cubic(V::Load(at - 3 * s), before, after, V::Load(at + 3 * s));
    }
    V::Store(result, prediction + i * V::Width);
  }
  if (by == Interpolation::Cubic)
  {
    const auto quadratic = [](std::int32_t near, std::int32_t other, std::int32_t far)
    { return Shifted(3u * U(near) + 6u * U(other) - U(far) + 4u, 3); };
    prediction[s] = quadratic(w[0], w[2 * s], w[4 * s]);
    prediction[B - s] = quadratic(w[B], w[B - 2 * s], w[B - 4 * s]);
  }
}

/// Bytes of a row, as vectors of up to 16 (of the compiler: every target has those).
template <int B>
struct Bytes
{
  static constexpr int Width = B < 16 ? B : 16;
  static constexpr int Count = B / Width;
  typedef std::uint8_t Vector __attribute__((vector_size(Width)));
  Vector Of[Count];

  static HWY_INLINE Vector Load(const std::uint8_t* from)
  {
    Vector result;
    std::memcpy(&result, from, Width);
    return result;
  }
  HWY_INLINE void AddRow(const std::uint8_t* row)
  {
    for (int i = 0; i < Count; ++i)
    {
      this->Of[i] += Load(row + i * Width);
    }
  }
  HWY_INLINE void AddTwice(const std::uint8_t* row)
  {
    for (int i = 0; i < Count; ++i)
    {
      const Vector v = Load(row + i * Width);
      this->Of[i] += v + v;
    }
  }
  HWY_INLINE void AddSides(const std::uint8_t* row, int s)
  {
    this->AddRow(row - s);
    this->AddRow(row + s);
  }
};

/// Sum of the magnitudes of residuals around that are known when a row is coded: those at both ends
/// of the interpolation count double, so does the same lane of the row before. At most 18 times 12.
/// @param m magnitudes of the row (its lane 0); rows are `pitch`, slices `slice` apart
template <int B, int D>
HWY_INLINE Bytes<B> RoughnessOfRow(const std::uint8_t* m, std::ptrdiff_t pitch,
  std::ptrdiff_t slice, int axis, int s, int y, int z)
{
  Bytes<B> sum;
  for (auto& part : sum.Of)
  {
    part = typename Bytes<B>::Vector{};
  }
  // Beyond the last row nothing of this block is known: the other side stands for it.
  const auto up = [](int position, int step, std::ptrdiff_t gap)
  { return position + step < B ? gap : -gap; };
  if (axis == 0)
  {
    sum.AddSides(m, s);
    sum.AddSides(m, s);
    if (D > 1)
    {
      const std::ptrdiff_t gap = 2 * s * pitch;
      sum.AddSides(m - gap, s);
      sum.AddSides(m + up(y, 2 * s, gap), s);
      sum.AddTwice(m - gap);
    }
    if (D > 2)
    {
      const std::ptrdiff_t gap = 2 * s * slice;
      sum.AddSides(m - gap, s);
      sum.AddSides(m + up(z, 2 * s, gap), s);
      sum.AddTwice(m - gap);
    }
    return sum;
  }
  const std::ptrdiff_t gap = s * (axis == 1 ? pitch : slice);
  const std::ptrdiff_t ahead = up(axis == 1 ? y : z, s, gap);
  for (const std::ptrdiff_t end : { -gap, ahead })
  {
    sum.AddTwice(m + end);
    sum.AddSides(m + end, s);
    if (D > 2)
    {
      const std::ptrdiff_t across = axis == 1 ? 2 * s * slice : s * pitch;
      const std::ptrdiff_t next = axis == 1 ? up(z, 2 * s, across) : up(y, s, across);
      sum.AddRow(m + end - across);
      sum.AddRow(m + end + next);
    }
  }
  if (axis == 2 || y >= 2 * s)
  {
    const std::ptrdiff_t last = axis == 1 ? 2 * gap : s * pitch; // the row that was coded before
    sum.AddTwice(m - last);
    sum.AddSides(m - last, s);
  }
  if (D > 2 && z >= 2 * s)
  {
    sum.AddTwice(m - 2 * s * slice);
  }
  return sum;
}

/// Classes of roughness, 0 to 7.
/// @return whether any lane is rough at all
template <int B>
HWY_INLINE bool ClassesOf(const Bytes<B>& sum, std::uint8_t* HWY_RESTRICT classes)
{
  using Vector = typename Bytes<B>::Vector;
  Vector any{};
  for (int i = 0; i < Bytes<B>::Count; ++i)
  {
    const Vector e = sum.Of[i];
    any |= e;
    Vector result{};
    for (const std::uint8_t limit : { 0, 3, 8, 15, 25, 38, 60 })
    {
      result -= reinterpret_cast<Vector>(e > limit); // -1 where it holds
    }
    std::memcpy(classes + i * Bytes<B>::Width, &result, Bytes<B>::Width);
  }
  std::uint64_t words[sizeof(Vector) / 8];
  std::memcpy(words, &any, sizeof any);
  return (words[0] | words[sizeof(Vector) / 8 - 1]) != 0;
}

/// One row as a pass hands it to a coder.
struct Row
{
  int Band;
  int Stride;
  LaneSet Lanes;
  int Y, Z;
  int Coded; ///< lanes (from the first) that carry a residual; the others are as predicted
};

/// One pass: predicts the samples at odd multiples of the stride along an axis. All that rows share
/// is known to the compiler.
template <int B, int D, int Axis, int S, class Coder>
HWY_INLINE void RunPass(const block::Unit<B>& unit, Interpolation by, const Coder& coder)
{
  constexpr std::ptrdiff_t pitch = block::Scratch<B, D>::Pitch;
  constexpr std::ptrdiff_t sliceW = block::Scratch<B, D>::SliceW;
  constexpr std::ptrdiff_t sliceM = block::Scratch<B, D>::SliceM;
  constexpr int band =
    D == 1 ? 2 - S : D == 2 ? (S == 2 ? 2 : 3 + Axis) : (S == 2 ? 5 : 8) + Axis;
  constexpr LaneSet lanes{ S, Axis > 0 ? S : 2 * S };
  constexpr int firstY = D > 1 ? (1 <= Axis ? S : 2 * S) : 0;
  constexpr int firstZ = D > 2 ? (2 <= Axis ? S : 2 * S) : 0;
  constexpr int stepY = D > 1 ? (1 < Axis ? S : 2 * S) : B;
  constexpr int stepZ = D > 2 ? 2 * S : B;
  const glm::ivec3 limit = unit.Limit;
  const int inRow =
    lanes.First <= limit.x ? (std::min(limit.x, B - 1) - lanes.First) / lanes.Step + 1 : 0;
  alignas(64) std::int32_t prediction[B];
  alignas(64) std::uint8_t classes[B];
  for (int z = firstZ; z < B; z += stepZ)
  {
    for (int y = firstY; y < B; y += stepY)
    {
      std::int32_t* w = unit.W + z * sliceW + y * pitch;
      std::uint8_t* m = unit.M + z * sliceM + y * pitch;
      if (Axis == 0)
      {
        PredictAlong<B>(w, S, by, prediction);
      }
      else
      {
        PredictAcross<B>(w, S * (Axis == 1 ? pitch : sliceW), Axis == 1 ? y : z, S, by, prediction);
      }
      const int coded = y <= limit.y && z <= limit.z ? inRow : 0;
      bool rough = false;
      if (coded > 0)
      {
        rough = ClassesOf<B>(RoughnessOfRow<B, D>(m, pitch, sliceM, Axis, S, y, z), classes);
      }
      coder(Row{ band, S, lanes, y, z, coded }, w, prediction, m, classes, rough);
    }
  }
}

/// Runs the passes of a unit: stride 2 and then stride 1, and in each the axes in order; rows z
/// outermost.
/// @param coder called as coder(row, w, prediction, m, classes, rough): predicts what it is given,
/// and must set the lanes of w and m
template <int B, int D, class Coder>
HWY_INLINE void RunPasses(const block::Unit<B>& unit, Interpolation by, const Coder& coder)
{
  RunPass<B, D, 0, 2>(unit, by, coder);
  if constexpr (D > 1)
  {
    RunPass<B, D, 1, 2>(unit, by, coder);
  }
  if constexpr (D > 2)
  {
    RunPass<B, D, 2, 2>(unit, by, coder);
  }
  RunPass<B, D, 0, 1>(unit, by, coder);
  if constexpr (D > 1)
  {
    RunPass<B, D, 1, 1>(unit, by, coder);
  }
  if constexpr (D > 2)
  {
    RunPass<B, D, 2, 1>(unit, by, coder);
  }
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
