// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_ModeDecision_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_ModeDecision_inl_h
#undef banyan_Codec_ModeDecision_inl_h
#else
#define banyan_Codec_ModeDecision_inl_h
#endif

#include "Codec/Simd/RateEstimate-inl.h"
#include "Codec/Simd/StaticBlock-inl.h"

#include <glm/common.hpp>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Chooses the mode of a block.
template <int B, class Number>
struct ModeDecision : BlockAt<B, Number>
{
  using V = Samples<Number>;
  using Floats = Pack<float, Width>;
  using Costs = Pack<std::int32_t, Width>;

  /// Whether rows along z are looked at there: some of all.
  static bool Looked(int y) { return y % 16 == 3 || y % 16 == 8 || y % 16 == 12; }

  /// Takes what Estimate looks at, less its reference.
  void LoadLooked(
    const View<const Number>& samples, const References<Number>& from, Number* w) const
  {
    constexpr block::Shape<3> shape{ B };
    WithReference<Number>(from.From,
      [&](auto reference)
      {
        for (int z = 0; z <= B; ++z)
        {
          for (int y = 0; y <= B; ++y)
          {
            if (Looked(y) || (z & 3) == 0)
            {
              LoadRow(
                reference, RowOf(samples, from, y, z), 0, B, w + z * shape.Z() + y * shape.Y());
            }
          }
        }
      });
  }

  static std::int64_t SumOf(const Costs& costs)
  {
    // None is negative.
    return static_cast<std::int64_t>(
      SumOfLanes(Widen<std::uint64_t>(BitsAs<std::uint32_t>(costs))));
  }

  /// Guesses the bits that residuals take, from some rows of each pass, with what is to be coded in
  /// place of what will have been decoded.
  /// @param enough where there are more, the sum so far will do
  std::int64_t Estimate(const Number* w, Interpolation by, std::int64_t enough) const
  {
    const glm::ivec3 last =
      glm::min(this->Plane().Target->Samples - 1 - this->Position * B, glm::ivec3(B - 1));
    Costs costs = Costs::Set(0);
    const auto add = [&](auto pass, int y, int z, std::int32_t weight)
    {
      using P = decltype(pass);
      if (y <= last.y && z <= last.z)
      {
        costs += this->template RowEstimate<P>(w, y, z, by, last.x) * Costs::Set(weight);
      }
    };
    for (int k = 1; k < B; k += 2)
    {
      for (int j = 1; j < B; ++j)
      {
        if (Looked(j))
        {
          add(Pass<3, 2, 1>{}, j, k, 5);
        }
      }
      for (int j = 4; j < B; j += 4)
      {
        add(Pass<3, 1, 1>{}, k, j, 2);
        add(Pass<3, 0, 1>{}, k - 1, j, 2);
      }
      if (k % 4 == 3)
      {
        const std::int64_t most = SumOf(costs);
        if (most > enough)
        {
          return most;
        }
      }
    }
    for (int k = 2; k < B; k += 4)
    {
      for (int j = 4; j < B; j += 4)
      {
        add(Pass<3, 1, 2>{}, k, j, 1);
        if (Looked(j))
        {
          add(Pass<3, 2, 2>{}, j, k, 4);
        }
      }
    }
    return SumOf(costs);
  }

  /// The same for a row, in 2^-13 bits, about. Less than half a bin costs little, and much less the
  /// less it is: it is 0 once it is quantized, like what is around it.
  template <class P>
  HWY_INLINE Costs RowEstimate(const Number* w, int y, int z, Interpolation by, int last) const
  {
    constexpr block::Shape<3> shape{ B };
    const RowPlace place{ z * shape.Z() + y * shape.Y(), 0, y, z, y, 0 };
    const float scale =
      3.5f / static_cast<float>(P::S == 2 ? this->Plane().CoarseBin : this->Plane().FineBin);
    Costs sum = Costs::Set(0);
    ForEachPart<B>(
      [&](auto at)
      {
        const int left = last + 1 - P::First - at();
        if (left <= 0)
        {
          return;
        }
        const V rest =
          (V::Load(w + place.Sample + P::First + at()) - Predict<P, B, at()>(w, place, by)) &
          LanesOfPassBelow<P, Number>(left);
        const Floats bins = FloatsOf(rest) * Floats::Set(scale);
        const Floats squares = bins * bins;
        const Floats size = Floats::Set(1.0f) + squares * squares;
        const Costs bits = BitsAs<std::int32_t>(size);
        sum += ShiftRight<12>(bits - Costs::Set(0x3f800000)); // 2^11 times about log2(size)
      });
    return sum;
  }
  static HWY_INLINE Floats FloatsOf(const V& numbers)
  {
    if constexpr (sizeof(Number) == sizeof(std::int32_t))
    {
      return ToFloats(numbers);
    }
    else
    {
      return ToFloats(Widen<std::int32_t>(numbers));
    }
  }

  /// The samples that a block is chosen by, side by side: they are looked at many times.
  struct Boxes
  {
    View<const Number> Target, ReferenceA, ReferenceB;
    References<Number> ReferencesOf(block::Reference from) const
    {
      return { from, this->ReferenceA, this->ReferenceB };
    }
  };

  Boxes GatherBoxes() const
  {
    const PlaneToEncode& plane = this->Plane();
    constexpr std::int64_t n = B + 1;
    Number* to = this->Work.Boxes.data();
    const auto gather = [&](const PlaneNumbers* from)
    {
      const View<const Number> box{ to, { 1, n, n * n } };
      if (from != nullptr)
      {
        const View<const Number> samples = this->ViewOf(*from);
        for (int z = 0; z < n; ++z)
        {
          for (int y = 0; y < n; ++y, to += n)
          {
            std::memcpy(to, samples.Row(y, z), static_cast<std::size_t>(n) * sizeof(Number));
          }
        }
      }
      return box;
    };
    Boxes boxes;
    boxes.Target = gather(plane.Target);
    boxes.ReferenceA = gather(plane.A);
    boxes.ReferenceB = plane.B == plane.A ? boxes.ReferenceA : gather(plane.B);
    return boxes;
  }

  /// Asks for the samples that the next block is chosen by. One part of them after the other: more
  /// at a time would be waited for.
  void Prefetch(std::size_t part, std::size_t parts) const
  {
    const PlaneToEncode& plane = this->Plane();
    constexpr std::size_t n = B + 1;
    const std::int64_t next = this->NextBlock();
    for (const PlaneNumbers* from :
      { plane.Target, plane.A, plane.B != plane.A ? plane.B : nullptr })
    {
      if (from == nullptr)
      {
        continue;
      }
      const View<const Number> samples = this->ViewOf(*from);
      for (std::size_t z = part * n / parts; z < (part + 1) * n / parts; ++z)
      {
        for (std::size_t y = 0; y < n; ++y)
        {
          __builtin_prefetch(samples.Row(static_cast<int>(y), static_cast<int>(z)) + next);
        }
      }
    }
  }

  std::size_t Trials() const { return static_cast<std::size_t>(std::max(this->Plane().Trials, 1)); }

  /// Greatest cost of candidates that are tried out beside one of this cost. Where one looks
  /// clearly best, it is: eleven times, or, of what costs much anyway, by a bit per sample.
  std::int64_t CloseTo(std::int64_t cost) const
  {
    const std::int64_t samples = std::int64_t{ B } * B * B;
    return cost + std::min(10 * cost, samples << 13);
  }

  /// Estimates candidates: those that may be tried out come first in Work.Costs, the best ones
  /// first, and of equal ones those that come first among the candidates.
  void EstimateAll(const Boxes& boxes) const
  {
    const std::vector<block::Mode>& modes = this->Plane().CandidateModes;
    std::vector<std::pair<std::int64_t, std::size_t>>& costs = this->Work.Costs;
    costs.clear();
    const bool alone = this->Plane().A == nullptr || this->Plane().B == nullptr;
    Number* const w = this->Work.Interior.Samples();
    std::size_t loaded = modes.size();
    std::int64_t enough = std::numeric_limits<std::int64_t>::max();
    const auto estimate = [&](std::size_t i)
    {
      const block::Mode& mode = modes[i];
      if (alone && mode.From != block::Reference::None)
      {
        return;
      }
      if (loaded == modes.size() || mode.From != modes[loaded].From)
      {
        this->LoadLooked(boxes.Target, boxes.ReferencesOf(mode.From), w);
        loaded = i;
      }
      const std::pair<std::int64_t, std::size_t> cost{ this->Estimate(w, mode.By, enough), i };
      costs.insert(std::upper_bound(costs.begin(), costs.end(), cost), cost);
      enough = this->CloseTo(costs[0].first);
      if (costs.size() >= this->Trials())
      {
        enough = std::min(enough, costs[this->Trials() - 1].first);
      }
    };
    // The mode of the block before is likely good again: others need not be looked at in full.
    const std::size_t previous = std::min(this->Work.PreviousMode, modes.size() - 1);
    estimate(previous);
    for (std::size_t i = 0; i < modes.size(); ++i)
    {
      this->Prefetch(i, modes.size());
      if (i != previous)
      {
        estimate(i);
      }
    }
  }

  void Choose() const
  {
    const PlaneToEncode& plane = this->Plane();
    const std::size_t index = static_cast<std::size_t>(
      (std::int64_t{ this->Position.z } * plane.Target->Blocks.y + this->Position.y) *
        plane.Target->Blocks.x +
      this->Position.x);
    BlockTokens& out = (*this->Job.Blocks)[index];
    const StaticBlock<B, Number> still{ *this };
    if (still.PlaceUniform(out) || (plane.A != nullptr && still.PlaceSame(out)))
    {
      this->Prefetch(0, 1); // there is little to be done meanwhile
      return;
    }
    const Boxes boxes = this->GatherBoxes();
    this->EstimateAll(boxes);
    const std::vector<std::pair<std::int64_t, std::size_t>>& costs = this->Work.Costs;
    const std::int64_t close = this->CloseTo(costs[0].first);
    const auto end = std::find_if(
      costs.begin() + 1, costs.end(), [close](const auto& cost) { return cost.first > close; });
    const std::size_t trials =
      std::min(static_cast<std::size_t>(end - costs.begin()), this->Trials());
    std::size_t best = 0;
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    for (std::size_t i = 0; trials > 1 && i < trials; ++i)
    {
      const std::int64_t cost =
        this->ExactCost(boxes, plane.CandidateModes[costs[i].second], least);
      best = cost < least ? i : best;
      least = std::min(cost, least);
    }
    this->Work.PreviousMode = costs[best].second;
    out.Mode = static_cast<std::uint8_t>(block::NumberOf(plane.CandidateModes[costs[best].second]));
  }

  /// Cost of the interior of a block, with borders as they are to be in place of what they
  /// will have been decoded to.
  /// @param enough more than that is as good as any other
  std::int64_t ExactCost(const Boxes& boxes, const block::Mode& mode, std::int64_t enough) const
  {
    UnitMemory<Number, 3>& scratch = this->Work.Interior;
    UnitMemory<Number, 3>& target = this->Work.InteriorTarget;
    LoadUnit<3, B>(boxes.Target, boxes.ReferencesOf(mode.From), true, target.Samples());
    constexpr block::Shape<3> shape{ B };
    std::copy_n(target.Samples(), (B + 1) * shape.Z(), scratch.Samples());
    scratch.Clean();
    Unit<Number, 3> unit{ scratch.Samples(), scratch.Magnitudes(), scratch.Residuals(),
      scratch.RowSums(), { this->Plane().Target->Samples - 1 - this->Position * B }, false };
    std::int64_t cost = 0;
    ForEachPass<3>(
      [&](auto pass)
      {
        using P = decltype(pass);
        if (cost < enough)
        {
          cost +=
            RateEstimate<P, B, Number>{ this->template RowsOf<P>(unit, mode.By, target.Samples()) }
              .Run(enough - cost);
        }
      });
    scratch.Used = unit.Any;
    return cost;
  }
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
