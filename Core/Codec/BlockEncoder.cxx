#include "Codec/BlockJob.h"

#include "Codec/Residual.h"

#include <algorithm>
#include <memory>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Codec/BlockEncoder.cxx"
#include <hwy/foreach_target.h>

#include "Codec/BlockUnits-inl.h"
#include "Codec/RowEncoder-inl.h"
#include "Codec/RowTrial-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

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
    Work().Tokens.Clear();
    RunPasses<B, D>(unit, mode.By,
      RowEncoder<B>{ unit.W, target.W(), plane.CoarseBin, plane.FineBin, &Work().Tokens, &rough });
    Work().Tokens.AppendTo(out);
    StoreUnit<B, D>(unit.W, from, plane.Least, plane.Greatest, samples);
  }

  /// See EncodeBlock.
  static void Encode(const PlaneJob& job, const glm::ivec3& position, BlockPhase phase)
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
    const int first = phase == BlockPhase::Edges ? 0 : phase == BlockPhase::Faces ? 3 : 6;
    const int end = phase == BlockPhase::Interior ? 7 : first + 3;
    for (int unit = first; unit < end; ++unit)
    {
      const int mask = UnitMasks[unit];
      if (((mask & 1) != 0 && position.x == blocks.x) ||
          ((mask & 2) != 0 && position.y == blocks.y) ||
          ((mask & 4) != 0 && position.z == blocks.z))
      {
        continue;
      }
      if (phase == BlockPhase::Edges)
      {
        work.Edge.ClearMagnitudes();
        EncodeUnit<1>(job, position, mask, out, !beyond, work.Edge, work.EdgeTarget, underway.Rough);
        Keep(underway, unit, work.Edge.M(), 1);
      }
      else if (phase == BlockPhase::Faces)
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
    std::vector<std::pair<double, block::Mode>> costs;
    block::Reference loaded = block::Reference::None;
    for (const block::Mode& mode : plane.Candidates)
    {
      if (mode.From != block::Reference::None && (plane.A == nullptr || plane.B == nullptr))
      {
        continue;
      }
      if (costs.empty() || mode.From != loaded)
      {
        LoadUnit<B, 3>(wanted, ReferencesOf(plane, mode.From, origin), scratch.W());
        loaded = mode.From;
      }
      costs.emplace_back(Estimate(scratch.W(), mode.By, plane.FineBin), mode);
    }
    const std::size_t tried = static_cast<std::size_t>(std::max(plane.Trials, 1));
    std::stable_sort(costs.begin(), costs.end(),
      [](const auto& a, const auto& b) { return a.first < b.first; });
    costs.resize(std::min(costs.size(), tried));
    for (auto& [cost, mode] : costs)
    {
      cost = costs.size() > 1 ? TrialCost(plane, wanted, mode, origin) : 0.0;
    }
    const auto best = std::min_element(costs.begin(), costs.end(),
      [](const auto& a, const auto& b) { return a.first < b.first; });
    out.Mode = static_cast<std::uint8_t>(block::NumberOf(best->second));
  }

  /// What the interior of a block would cost, with borders as they are to be in place of what they
  /// will have been decoded to.
  static double TrialCost(const PlaneToEncode& plane, const View<const std::int32_t>& wanted,
    const block::Mode& mode, const glm::ivec3& origin)
  {
    block::Scratch<B, 3>& scratch = Work().Interior;
    block::Scratch<B, 3>& target = Work().InteriorTarget;
    const References from = ReferencesOf(plane, mode.From, origin);
    LoadUnit<B, 3>(wanted, from, target.W());
    LoadUnit<B, 3>(wanted, from, scratch.W());
    scratch.ClearMagnitudes();
    block::Unit<B> unit = scratch.Whole();
    unit.Limit = plane.Target->Samples - 1 - origin;
    std::int64_t cost = 0;
    RunPasses<B, 3>(unit, mode.By,
      RowTrial<B>{ unit.W, target.W(), plane.CoarseBin, plane.FineBin, &cost });
    return static_cast<double>(cost);
  }
};

template <int B>
void EncodeBlockOf(const PlaneJob& job, const glm::ivec3& position, BlockPhase phase)
{
  if (phase == BlockPhase::Choose)
  {
    BlockCoder<B>::Choose(job, position);
    return;
  }
  BlockCoder<B>::Encode(job, position, phase);
}

void EncodeBlockHere(const PlaneJob& job, const glm::ivec3& position, BlockPhase phase)
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

void EncodeBlock(const PlaneJob& job, const glm::ivec3& position, BlockPhase phase)
{
  HWY_DYNAMIC_DISPATCH(EncodeBlockHere)(job, position, phase);
}

} // namespace banyan
#endif
