// Included once per SIMD target: see BlockEncoder.cxx.
#if defined(banyan_Codec_BlockChoice_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_BlockChoice_inl_h
#undef banyan_Codec_BlockChoice_inl_h
#else
#define banyan_Codec_BlockChoice_inl_h
#endif

#include "Codec/BlockAt-inl.h"
#include "Codec/SliceTrial-inl.h"

#include <algorithm>
#include <utility>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Chooses the mode of a block.
template <class Edge, class Number>
struct BlockChooser : BlockAt<Edge, Number>
{
  /// Guesses the bits that residuals take, from some rows of each pass, with what is to be coded in
  /// place of what will have been decoded.
  double Estimate(const Number* w, Interpolation by) const
  {
    const int b = this->B();
    double cost = 0;
    const auto add = [&](auto pass, int y, int z, double weight)
    {
      using P = decltype(pass);
      cost += weight * this->template RowEstimate<P>(w, y, z, by);
    };
    for (int k = 1; k < b; k += 2)
    {
      for (int j = 1 + (k / 2) % 3; j < b; j += 5)
      {
        add(Pass<3, 2, 1>{}, j, k, 5.0);
      }
      for (int j = 4; j < b; j += 4)
      {
        add(Pass<3, 1, 1>{}, k, j, 2.0);
        add(Pass<3, 0, 1>{}, (k / 2) * 2, j, 2.0);
      }
    }
    return cost;
  }

  template <class P>
  HWY_INLINE double RowEstimate(const Number* w, int y, int z, Interpolation by) const
  {
    using Signed = typename Numbers<Number>::Signed;
    using Bits = Numbers<std::int32_t>::Signed;
    typedef float Floats __attribute__((vector_size(64)));
    const block::Shape<3> shape{ this->B() };
    const RowPlace place{ z * shape.Z() + y * shape.Y(), 0, y, z, y, 0 };
    const float scale = 2.0f / static_cast<float>(this->Plane().FineBin);
    const int left = this->B() - P::First;
    Bits sum{};
    for (int at = 0; at < left; at += Width)
    {
      Signed rest = reinterpret_cast<Signed>(Numbers<Number>::Load(w + place.W + P::First + at) -
                                             Predict<P>(w, this->B, place, at, by));
      rest &= LaneMask<P, Signed>(left - at);
      const Floats bins = __builtin_convertvector(rest, Floats) * scale;
      const Floats size = 1.0f + bins * bins;
      Bits bits;
      std::memcpy(&bits, &size, sizeof(bits));
      sum += (bits - 0x3f800000) >> 12; // 2^11 times about log2(size)
    }
    std::int32_t total = 0;
    for (int x = 0; x < Width; ++x)
    {
      total += sum[x];
    }
    return total;
  }

  /// The samples that a block is chosen by, side by side: they are looked at many times.
  struct Boxes
  {
    View<const Number> Target, A, B;
    References<Number> ReferencesOf(block::Reference from) const
    {
      return { from, this->A, this->B };
    }
  };

  Boxes GatherBoxes() const
  {
    const PlaneToEncode& plane = this->Plane();
    const std::int64_t n = this->B() + 1;
    Number* to = this->Work.Boxes.data();
    const auto gather = [&](const PlaneNumbers* from)
    {
      const View<const Number> box{ to, { 1, n, n * n } };
      if (from != nullptr)
      {
        const View<const Sample> samples = this->ViewOf(*from);
        for (int z = 0; z < n; ++z)
        {
          for (int y = 0; y < n; ++y, to += n)
          {
            const Sample* row = samples.Row(y, z);
            __builtin_prefetch(row + samples.Stride.z);
            for (int x = 0; x < n; ++x)
            {
              to[x] = static_cast<Number>(row[x]);
            }
          }
        }
      }
      return box;
    };
    Boxes boxes;
    boxes.Target = gather(plane.Target);
    boxes.A = gather(plane.A);
    boxes.B = plane.B == plane.A ? boxes.A : gather(plane.B);
    return boxes;
  }

  void Choose() const
  {
    const PlaneToEncode& plane = this->Plane();
    const std::size_t index = static_cast<std::size_t>(
      (std::int64_t{ this->Position.z } * plane.Target->Blocks.y + this->Position.y) *
        plane.Target->Blocks.x +
      this->Position.x);
    BlockTokens& out = (*this->Job.Blocks)[index];
    if (out.Uniform || out.Same)
    {
      return;
    }
    const Boxes boxes = this->GatherBoxes();
    block::Scratch<Number, 3>& scratch = this->Work.Interior;
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
        LoadUnit<3>(boxes.Target, boxes.ReferencesOf(mode.From), this->B, true, scratch.W());
        loaded = mode.From;
      }
      costs.emplace_back(this->Estimate(scratch.W(), mode.By), mode);
    }
    const std::size_t tried = static_cast<std::size_t>(std::max(plane.Trials, 1));
    std::stable_sort(costs.begin(), costs.end(),
      [](const auto& a, const auto& b) { return a.first < b.first; });
    costs.resize(std::min(costs.size(), tried));
    for (auto& [cost, mode] : costs)
    {
      cost = costs.size() > 1 ? this->TrialCost(boxes, mode) : 0.0;
    }
    const auto best = std::min_element(costs.begin(), costs.end(),
      [](const auto& a, const auto& b) { return a.first < b.first; });
    out.Mode = static_cast<std::uint8_t>(block::NumberOf(best->second));
  }

  /// What the interior of a block would cost, with borders as they are to be in place of what they
  /// will have been decoded to.
  double TrialCost(const Boxes& boxes, const block::Mode& mode) const
  {
    block::Scratch<Number, 3>& scratch = this->Work.Interior;
    block::Scratch<Number, 3>& target = this->Work.InteriorTarget;
    LoadUnit<3>(boxes.Target, boxes.ReferencesOf(mode.From), this->B, true, target.W());
    const block::Shape<3> shape{ this->B() };
    std::copy_n(target.W(), (this->B() + 1) * shape.Z(), scratch.W());
    scratch.Clear();
    Unit<Number, 3> unit{ scratch.W(), scratch.M(), scratch.R(), scratch.S(),
      { this->Plane().Target->Samples - 1 - this->Position * this->B() }, true };
    std::int64_t cost = 0;
    ForEachPass<3>(
      [&](auto pass)
      {
        using P = decltype(pass);
        cost += SliceTrial<P, Edge, Number>{
          this->template RowsOf<P>(unit, mode.By, target.W()) }
                  .Run();
      });
    return static_cast<double>(cost);
  }
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
