#include "Codec/BlockEncoder.h"

#include "Base/ThreadPool.h"
#include "Codec/Residual.h"

#include <cmath>
#include <limits>
#include <memory>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Codec/BlockEncoder.cxx"
#include <hwy/foreach_target.h>

#include "Codec/BlockUnits-inl.h"

#ifndef banyan_Codec_BlockEncoder_once
#define banyan_Codec_BlockEncoder_once
namespace banyan
{

/// What is kept of a block between its edges, faces and interior.
struct BlockUnderway
{
  std::vector<std::uint8_t> Magnitudes; ///< 3 edges, 3 faces
  bool Rough = false;                   ///< some residual is not zero
};

struct PlaneJob
{
  const PlaneToEncode* Plane;
  PlaneNumbers* Decoded;
  std::vector<BlockTokens>* Blocks;
  std::vector<BlockUnderway>* Underway;
};

} // namespace banyan
#endif

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// What is written down of a unit.
template <int B>
struct UnitTokens
{
  // Every sample has a token at most, and every row a flag.
  std::uint16_t Tokens[B * B * B + 3 * B * B];
  std::uint32_t Extra[B * B * B];
  std::uint8_t Rows[6 * B * B];
  std::size_t TokenCount = 0, ExtraCount = 0, RowCount = 0;

  void AppendTo(BlockTokens& block)
  {
    block.Tokens.insert(block.Tokens.end(), this->Tokens, this->Tokens + this->TokenCount);
    block.Extra.insert(block.Extra.end(), this->Extra, this->Extra + this->ExtraCount);
    block.Rows.insert(block.Rows.end(), this->Rows, this->Rows + this->RowCount);
    this->TokenCount = 0;
    this->ExtraCount = 0;
    this->RowCount = 0;
  }
};

/// Quantizes the residuals of rows and writes them down.
template <int B>
struct RowEncoder
{
  const std::int32_t* W;      ///< of the unit
  const std::int32_t* Target; ///< same layout, what W is to become
  std::int32_t CoarseBin, FineBin;
  UnitTokens<B>* Out;
  bool* Rough;

  HWY_INLINE void operator()(const Row& row, std::int32_t* w, const std::int32_t* prediction,
    std::uint8_t* m, const std::uint8_t* classes, bool rough) const
  {
    if (row.Coded == 0)
    {
      SetLanes<B>(row.Lanes, prediction, w);
      return;
    }
    const std::int32_t bin = row.Stride == 2 ? this->CoarseBin : this->FineBin;
    const std::int32_t* target = this->Target + (w - this->W);
    alignas(64) std::int32_t residuals[B];
    Quantize(target, prediction, bin, residuals);
    const int last = row.Lanes.First + (row.Coded - 1) * row.Lanes.Step;
    alignas(64) std::uint32_t codes[B];
    std::uint32_t any = 0;
    const std::int32_t* mask = LaneMask<B>(row.Lanes);
    for (int x = 0; x < B; ++x)
    {
      residuals[x] = x <= last ? residuals[x] & mask[x] : 0;
      codes[x] = residual::Zigzag(residuals[x]);
      any |= codes[x];
    }
    SetLanes<B>(row.Lanes, prediction, residuals, bin, w);
    UnitTokens<B>& out = *this->Out;
    if (!rough)
    {
      out.Tokens[out.TokenCount++] = static_cast<std::uint16_t>(
        (residual::FlagContext + row.Band) << 8 | (any == 0 ? 1 : 0));
      out.Rows[out.RowCount++] = 1;
      if (any == 0)
      {
        return;
      }
    }
    *this->Rough |= any != 0;
    const int context = row.Band * residual::Classes;
    out.Rows[out.RowCount++] = static_cast<std::uint8_t>(row.Coded);
    std::uint16_t* tokens = out.Tokens + out.TokenCount;
    out.TokenCount += static_cast<std::size_t>(row.Coded);
    if (any < 32) // so is each code then
    {
      for (int x = row.Lanes.First; x <= last; x += row.Lanes.Step)
      {
        m[x] = residual::MagnitudeOf[codes[x]];
        *tokens++ = static_cast<std::uint16_t>(
          static_cast<std::uint32_t>(context + classes[x]) << 8 | codes[x]);
      }
      return;
    }
    for (int x = row.Lanes.First; x <= last; x += row.Lanes.Step)
    {
      std::uint32_t extra = 0;
      const int symbol = residual::SymbolOf(codes[x], extra);
      m[x] = residual::Magnitude(codes[x]);
      *tokens++ = static_cast<std::uint16_t>((context + classes[x]) << 8 | symbol);
      if (symbol >= residual::DirectSymbols)
      {
        out.Extra[out.ExtraCount++] = extra;
      }
    }
  }

  /// Nearest multiple of the bin. The bin is odd, so nothing lies half way, and double precision is
  /// far more exact than what is left to the next half.
  static HWY_INLINE void Quantize(const std::int32_t* HWY_RESTRICT target,
    const std::int32_t* HWY_RESTRICT prediction, std::int32_t bin,
    std::int32_t* HWY_RESTRICT residuals)
  {
    const double inverse = 1.0 / bin;
    constexpr double rounder = 6755399441055744.0; // 1.5 * 2^52: adding it rounds
    for (int x = 0; x < B; ++x)
    {
      const double rest = static_cast<std::int32_t>(U(target[x]) - U(prediction[x]));
      residuals[x] = static_cast<std::int32_t>((rest * inverse + rounder) - rounder);
    }
  }
};

template <int B>
struct BlockCoder
{
  struct Workspace
  {
    block::Scratch<B, 1> Edge, EdgeTarget;
    block::Scratch<B, 2> Face, FaceTarget;
    block::Scratch<B, 3> Interior, InteriorTarget;
    UnitTokens<B> Tokens;
  };

  static Workspace& Work()
  {
    thread_local std::unique_ptr<Workspace> work;
    if (!work)
    {
      work = std::make_unique<Workspace>();
    }
    return *work;
  }

  static glm::i64vec3 StridesOf(const PlaneNumbers& plane)
  {
    return { 1, plane.Padded.x, std::int64_t{ plane.Padded.x } * plane.Padded.y };
  }

  static References ReferencesOf(const PlaneToEncode& plane, block::Reference from, const glm::ivec3& origin)
  {
    References result;
    result.From = from;
    if (from != block::Reference::None)
    {
      result.A = { plane.A->Numbers.data() + plane.A->IndexOf(origin), StridesOf(*plane.A) };
      result.B = { plane.B->Numbers.data() + plane.B->IndexOf(origin), StridesOf(*plane.B) };
    }
    return result;
  }

  template <int D>
  static void EncodeUnit(const PlaneJob& job, const glm::ivec3& position, int mask,
    BlockTokens& out, bool coded, block::Scratch<B, D>& scratch, block::Scratch<B, D>& target,
    bool& rough)
  {
    const PlaneToEncode& plane = *job.Plane;
    const glm::ivec3 origin = position * B;
    const glm::ivec3 axes = UnitAxes(mask);
    const block::Mode mode = block::ModeOf(out.Mode);
    const References from = ReferencesOf(plane, mode.From, origin).Along(axes);
    const View<std::int32_t> samples =
      View<std::int32_t>{ job.Decoded->Numbers.data() + job.Decoded->IndexOf(origin),
        StridesOf(*job.Decoded) }.Along(axes);
    const View<const std::int32_t> wanted =
      View<const std::int32_t>{ plane.Target->Numbers.data() + plane.Target->IndexOf(origin),
        StridesOf(*plane.Target) }.Along(axes);
    block::Unit<B> unit = scratch.Whole();
    const auto permuted = [&](const glm::ivec3& v)
    { return glm::ivec3{ v[axes.x], D > 1 ? v[axes.y] : B, D > 2 ? v[axes.z] : B }; };
    unit.Limit = coded ? permuted(plane.Target->Samples - 1 - origin) : glm::ivec3(-1);
    LoadUnit<B, D>({ samples.Base, samples.Stride }, from, unit.W);
    LoadUnit<B, D>(wanted, from, target.W());
    RunPasses<B, D>(unit, mode.By,
      RowEncoder<B>{ unit.W, target.W(), plane.CoarseBin, plane.FineBin, &Work().Tokens, &rough });
    Work().Tokens.AppendTo(out);
    StoreUnit<B, D>(unit.W, from, plane.Least, plane.Greatest, samples);
  }

  /// One phase (0: edges, 1: faces, 2: interior) of the block at a position. Positions may lie one
  /// beyond the last block: what the field's last blocks share with none is predicted only.
  static void Encode(const PlaneJob& job, const glm::ivec3& position, int phase)
  {
    const glm::ivec3 blocks = job.Decoded->Blocks;
    const bool beyond = position.x == blocks.x || position.y == blocks.y || position.z == blocks.z;
    Workspace& work = Work();
    BlockTokens none;
    BlockUnderway noneUnderway;
    const std::size_t index = static_cast<std::size_t>(
      (std::int64_t{ position.z } * blocks.y + position.y) * blocks.x + position.x);
    BlockTokens& out = beyond ? none : (*job.Blocks)[index];
    BlockUnderway& underway = beyond ? noneUnderway : (*job.Underway)[index];
    if (!beyond && (out.Uniform || out.Same))
    {
      return;
    }
    for (int unit = phase == 0 ? 0 : phase == 1 ? 3 : 6; unit < (phase == 0 ? 3 : phase == 1 ? 6 : 7);
         ++unit)
    {
      const int mask = UnitMasks[unit];
      if (((mask & 1) != 0 && position.x == blocks.x) ||
          ((mask & 2) != 0 && position.y == blocks.y) ||
          ((mask & 4) != 0 && position.z == blocks.z))
      {
        continue;
      }
      if (phase == 0)
      {
        work.Edge.ClearMagnitudes();
        EncodeUnit<1>(job, position, mask, out, !beyond, work.Edge, work.EdgeTarget, underway.Rough);
        Keep(underway, unit, work.Edge.M(), 1);
      }
      else if (phase == 1)
      {
        work.Face.ClearMagnitudes();
        Recall(underway, mask, work.Face.M(), beyond);
        EncodeUnit<2>(job, position, mask, out, !beyond, work.Face, work.FaceTarget, underway.Rough);
        Keep(underway, unit, work.Face.M(), B);
      }
      else if (!beyond)
      {
        work.Interior.ClearMagnitudes();
        RecallFaces(underway, work.Interior.M());
        EncodeUnit<3>(
          job, position, mask, out, true, work.Interior, work.InteriorTarget, underway.Rough);
        Finish(out, underway);
      }
    }
  }

  static constexpr int RowM = block::Scratch<B, 2>::RowM;

  static std::size_t OffsetOf(int unit)
  {
    return static_cast<std::size_t>(unit < 3 ? unit * B : 3 * B + (unit - 3) * B * B);
  }

  static void Keep(BlockUnderway& underway, int unit, const std::uint8_t* m, int rows)
  {
    underway.Magnitudes.resize(OffsetOf(6));
    std::uint8_t* to = underway.Magnitudes.data() + OffsetOf(unit);
    for (int y = 0; y < rows; ++y)
    {
      std::copy(m + y * RowM, m + y * RowM + B, to + y * B);
    }
  }

  /// The magnitudes of the edges that a face starts with.
  static void Recall(const BlockUnderway& underway, int mask, std::uint8_t* m, bool beyond)
  {
    if (beyond)
    {
      return;
    }
    const glm::ivec3 axes = UnitAxes(mask);
    const std::uint8_t* alongX = underway.Magnitudes.data() + OffsetOf(axes.x);
    const std::uint8_t* alongY = underway.Magnitudes.data() + OffsetOf(axes.y);
    std::copy(alongX, alongX + B, m);
    for (int y = 1; y < B; ++y)
    {
      m[y * RowM] = alongY[y];
    }
  }

  static void RecallFaces(const BlockUnderway& underway, std::uint8_t* m)
  {
    const std::uint8_t* xy = underway.Magnitudes.data() + OffsetOf(3);
    const std::uint8_t* xz = underway.Magnitudes.data() + OffsetOf(4);
    const std::uint8_t* yz = underway.Magnitudes.data() + OffsetOf(5);
    for (int j = 0; j < B; ++j)
    {
      std::copy(xy + j * B, xy + j * B + B, m + j * RowM);
    }
    for (int k = 1; k < B; ++k)
    {
      std::copy(xz + k * B, xz + k * B + B, m + k * B * RowM);
      for (int j = 1; j < B; ++j)
      {
        m[(k * B + j) * RowM] = yz[k * B + j];
      }
    }
  }

  static void Finish(BlockTokens& out, BlockUnderway& underway)
  {
    if (!underway.Rough)
    {
      out.Tokens = {};
      out.Extra = {};
      out.Rows = {};
    }
    underway.Magnitudes = {};
  }

  /// Guesses the bits that residuals take, from some rows of each pass, with what is to be coded in
  /// place of what will have been decoded.
  static double Estimate(const std::int32_t* w, Interpolation by, std::int32_t bin)
  {
    constexpr int n = B + 1;
    constexpr std::ptrdiff_t row = B + 8;
    alignas(64) std::int32_t prediction[B];
    double cost = 0;
    const auto add = [&](const std::int32_t* at, const LaneSet& lanes, double weight)
    {
      const std::int32_t* mask = LaneMask<B>(lanes);
      const float scale = 2.0f / static_cast<float>(bin);
      std::int32_t sum = 0;
      for (int x = 0; x < B; ++x)
      {
        const std::int32_t rest = static_cast<std::int32_t>(U(at[x]) - U(prediction[x])) & mask[x];
        const float bins = scale * static_cast<float>(rest);
        const float size = 1.0f + bins * bins;
        std::int32_t bits;
        std::memcpy(&bits, &size, 4);
        sum += (bits - 0x3f800000) >> 12; // 2^11 times about log2(size)
      }
      cost += weight * sum;
    };
    for (int k = 1; k < B; k += 2)
    {
      for (int j = 1 + (k / 2) % 3; j < B; j += 5)
      {
        const std::int32_t* across = w + (k * n + j) * row;
        PredictAcross<B>(across, n * row, k, 1, by, prediction);
        add(across, { 1, 1 }, 5.0);
      }
      for (int j = 4; j < B; j += 4)
      {
        const std::int32_t* across = w + (j * n + k) * row;
        PredictAcross<B>(across, row, k, 1, by, prediction);
        add(across, { 1, 1 }, 2.0);
        const std::int32_t* along = w + (j * n + (k / 2) * 2) * row;
        PredictAlong<B>(along, 1, by, prediction);
        add(along, { 1, 2 }, 2.0);
      }
    }
    return cost;
  }

  static void Choose(const PlaneJob& job, const glm::ivec3& position)
  {
    const PlaneToEncode& plane = *job.Plane;
    const glm::ivec3 origin = position * B;
    const std::size_t index = static_cast<std::size_t>(
      (std::int64_t{ position.z } * plane.Target->Blocks.y + position.y) * plane.Target->Blocks.x +
      position.x);
    BlockTokens& out = (*job.Blocks)[index];
    if (out.Uniform || out.Same)
    {
      return;
    }
    const View<const std::int32_t> wanted{ plane.Target->Numbers.data() +
                                             plane.Target->IndexOf(origin),
      StridesOf(*plane.Target) };
    block::Scratch<B, 3>& scratch = Work().Interior;
    double best = std::numeric_limits<double>::infinity();
    block::Reference loaded = block::Reference::None;
    bool first = true;
    for (const block::Mode& mode : plane.Candidates)
    {
      if (mode.From != block::Reference::None && (plane.A == nullptr || plane.B == nullptr))
      {
        continue;
      }
      if (first || mode.From != loaded)
      {
        LoadUnit<B, 3>(wanted, ReferencesOf(plane, mode.From, origin), scratch.W());
        loaded = mode.From;
        first = false;
      }
      const double cost = Estimate(scratch.W(), mode.By, plane.FineBin);
      if (cost < best)
      {
        best = cost;
        out.Mode = static_cast<std::uint8_t>(block::NumberOf(mode));
      }
    }
  }
};

template <int B>
void EncodeBlockOf(const PlaneJob& job, const glm::ivec3& position, int phase)
{
  if (phase < 0)
  {
    BlockCoder<B>::Choose(job, position);
    return;
  }
  BlockCoder<B>::Encode(job, position, phase);
}

void EncodeBlockHere(const PlaneJob& job, const glm::ivec3& position, int phase)
{
  switch (job.Decoded->Edge)
  {
    case 8:
      return EncodeBlockOf<8>(job, position, phase);
    case 16:
      return EncodeBlockOf<16>(job, position, phase);
    case 32:
      return EncodeBlockOf<32>(job, position, phase);
    default:
      return EncodeBlockOf<64>(job, position, phase);
  }
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace banyan
{

HWY_EXPORT(EncodeBlockHere);

namespace
{

void PlaceCoarser(const PlaneNumbers& coarser, PlaneNumbers& decoded)
{
  const glm::ivec3 last = coarser.Samples - 1;
  for (int z = 0; z < decoded.Padded.z; z += 4)
  {
    for (int y = 0; y < decoded.Padded.y; y += 4)
    {
      const std::int64_t from =
        coarser.IndexOf({ 0, std::min(y / 4, last.y), std::min(z / 4, last.z) });
      std::int32_t* row = decoded.Numbers.data() + decoded.IndexOf({ 0, y, z });
      for (int x = 0; x < decoded.Padded.x; x += 4)
      {
        row[x] = coarser.Numbers[static_cast<std::size_t>(from + std::min(x / 4, last.x))];
      }
    }
  }
}

/// Finds the blocks whose samples are all the same, and places them.
void PlaceUniform(const PlaneNumbers& target, const glm::ivec3& position, BlockTokens& block,
  PlaneNumbers& decoded)
{
  const glm::ivec3 low = position * target.Edge;
  const glm::ivec3 high = low + target.Edge;
  const std::int32_t value = target.Numbers[static_cast<std::size_t>(target.IndexOf(low))];
  for (int z = low.z; z < high.z; ++z)
  {
    for (int y = low.y; y < high.y; ++y)
    {
      const std::int32_t* row = target.Numbers.data() + target.IndexOf({ low.x, y, z });
      for (int x = 0; x < target.Edge; ++x)
      {
        if (row[x] != value)
        {
          return;
        }
      }
    }
  }
  block.Uniform = true;
  block.Value = value;
  for (int z = low.z; z < high.z; ++z)
  {
    for (int y = low.y; y < high.y; ++y)
    {
      std::int32_t* row = decoded.Numbers.data() + decoded.IndexOf({ low.x, y, z });
      std::fill(row, row + target.Edge, value);
    }
  }
}

/// Finds the blocks that may stay as they are in reference A, and places them.
void PlaceSame(const PlaneToEncode& plane, const glm::ivec3& position, BlockTokens& block,
  PlaneNumbers& decoded)
{
  const PlaneNumbers& target = *plane.Target;
  const glm::ivec3 low = position * target.Edge;
  const glm::ivec3 high = low + target.Edge;
  const glm::ivec3 limit = target.Samples;
  const std::int64_t most = plane.FineBin / 2;
  for (int z = low.z; z < std::min(high.z, limit.z); ++z)
  {
    for (int y = low.y; y < std::min(high.y, limit.y); ++y)
    {
      const std::int32_t* row = target.Numbers.data() + target.IndexOf({ 0, y, z });
      const std::int32_t* before = plane.A->Numbers.data() + plane.A->IndexOf({ 0, y, z });
      for (int x = low.x; x < std::min(high.x, limit.x); ++x)
      {
        const std::int64_t rest = std::int64_t{ row[x] } - before[x];
        if (rest > most || rest < -most)
        {
          return;
        }
      }
    }
  }
  block.Same = true;
  for (int z = low.z; z < high.z; ++z)
  {
    for (int y = low.y; y < high.y; ++y)
    {
      const std::int32_t* from = plane.A->Numbers.data() + plane.A->IndexOf({ low.x, y, z });
      std::copy(from, from + target.Edge, decoded.Numbers.data() + decoded.IndexOf({ low.x, y, z }));
    }
  }
}

glm::ivec3 PositionIn(const glm::ivec3& size, std::int64_t index)
{
  return { static_cast<int>(index % size.x), static_cast<int>(index / size.x % size.y),
    static_cast<int>(index / size.x / size.y) };
}

} // namespace

PlaneNumbers::PlaneNumbers(const glm::ivec3& samples, int edge)
  : Edge(edge)
  , Samples(samples)
  , Blocks((samples + edge - 1) / edge)
  , Padded(Blocks * edge + 1)
  , Numbers(static_cast<std::size_t>(std::int64_t{ Padded.x } * Padded.y * Padded.z))
{
}

glm::ivec3 CoarserSamples(const glm::ivec3& samples)
{
  return (samples - 1 + 3) / 4 + 1;
}

void EncodePlane(const PlaneToEncode& plane, PlaneNumbers& decoded,
  std::vector<BlockTokens>& blocks, ThreadPool& pool)
{
  const PlaneNumbers& target = *plane.Target;
  decoded = PlaneNumbers(target.Samples, target.Edge);
  blocks.clear();
  blocks.resize(static_cast<std::size_t>(target.BlockCount()));
  PlaceCoarser(*plane.Coarser, decoded);
  pool.ParallelFor(target.BlockCount(),
    [&](std::int64_t i)
    {
      const glm::ivec3 position = PositionIn(target.Blocks, i);
      BlockTokens& block = blocks[static_cast<std::size_t>(i)];
      PlaceUniform(target, position, block, decoded);
      if (!block.Uniform && plane.A != nullptr)
      {
        PlaceSame(plane, position, block, decoded);
      }
    });
  std::vector<BlockUnderway> underway(blocks.size());
  const PlaneJob job{ &plane, &decoded, &blocks, &underway };
  pool.ParallelFor(target.BlockCount(), [&](std::int64_t i)
    { HWY_DYNAMIC_DISPATCH(EncodeBlockHere)(job, PositionIn(target.Blocks, i), -1); });
  const glm::ivec3 extended = target.Blocks + 1;
  const std::int64_t count = std::int64_t{ extended.x } * extended.y * extended.z;
  for (int phase = 0; phase < 3; ++phase)
  {
    pool.ParallelFor(count, [&](std::int64_t i)
      { HWY_DYNAMIC_DISPATCH(EncodeBlockHere)(job, PositionIn(extended, i), phase); });
  }
}

} // namespace banyan
#endif
