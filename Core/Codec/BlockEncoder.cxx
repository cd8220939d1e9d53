#include "Codec/BlockJob.h"

#include "Codec/Residual.h"

#include <algorithm>
#include <memory>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Codec/BlockEncoder.cxx"
#include <hwy/foreach_target.h>

#include "Codec/BlockUnits-inl.h"
#include "Codec/SliceEncoder-inl.h"
#include "Codec/SliceTrial-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

using Sample = std::int32_t; ///< of planes

template <class Edge, class Number>
struct BlockCoder
{
  struct Workspace
  {
    explicit Workspace(int edge)
      : Edges(edge)
      , EdgesTarget(edge)
      , Faces(edge)
      , FacesTarget(edge)
      , Interior(edge)
      , InteriorTarget(edge)
      , Tokens(edge)
      , Boxes(3 * static_cast<std::size_t>((edge + 1) * (edge + 1) * (edge + 1)))
    {
    }
    block::Scratch<Number, 1> Edges, EdgesTarget;
    block::Scratch<Number, 2> Faces, FacesTarget;
    block::Scratch<Number, 3> Interior, InteriorTarget;
    UnitTokens Tokens;
    std::vector<Number> Boxes; ///< of the target and both references
  };

  Edge B;
  const PlaneJob& Job;
  glm::ivec3 Position;
  Workspace& Work;

  const PlaneToEncode& Plane() const { return *this->Job.Plane; }

  View<Sample> ViewOf(PlaneNumbers& plane) const
  {
    const glm::ivec3 origin = this->Position * this->B();
    return { plane.Numbers.data() + plane.IndexOf(origin),
      { 1, plane.Padded.x, std::int64_t{ plane.Padded.x } * plane.Padded.y } };
  }
  View<const Sample> ViewOf(const PlaneNumbers& plane) const
  {
    const View<Sample> view = this->ViewOf(const_cast<PlaneNumbers&>(plane));
    return { view.Base, view.Stride };
  }

  References<Sample> ReferencesOf(block::Reference from) const
  {
    References<Sample> result;
    result.From = from;
    if (from != block::Reference::None)
    {
      result.A = this->ViewOf(*this->Plane().A);
      result.B = this->ViewOf(*this->Plane().B);
    }
    return result;
  }

  template <class P>
  RowQuantizer<P, Edge, Number> RowsOf(
    Unit<Number, P::D>& unit, Interpolation by, const Number* target) const
  {
    return { unit, this->B, by, target,
      static_cast<Number>(P::S == 2 ? this->Plane().CoarseBin : this->Plane().FineBin) };
  }

  /// Encodes the units of D dimensions of a block.
  /// @param coded false: they are predicted only
  template <int D>
  void EncodeUnits(BlockTokens& out, bool coded, block::Scratch<Number, D>& scratch,
    block::Scratch<Number, D>& target, bool& rough) const
  {
    const PlaneToEncode& plane = this->Plane();
    const block::Mode mode = block::ModeOf(out.Mode);
    const block::Shape<D> shape{ this->B() };
    const References<Sample> references = this->ReferencesOf(mode.From);
    const View<Sample> decoded = this->ViewOf(*this->Job.Decoded);
    const View<const Sample> wanted = this->ViewOf(*plane.Target);
    const glm::ivec3 blocks = this->Job.Decoded->Blocks;
    Unit<Number, D> unit{ scratch.W(), scratch.M(), scratch.R(), {}, rough };
    constexpr int units = D < 3 ? 3 : 1;
    bool exists[3] = {};
    for (int number = 0; number < units; ++number)
    {
      const glm::ivec3 axes = AxesOf<D>(number);
      const int mask = MaskOf<D>(number);
      exists[number] = !((mask & 1) != 0 && this->Position.x == blocks.x) &&
                       !((mask & 2) != 0 && this->Position.y == blocks.y) &&
                       !((mask & 4) != 0 && this->Position.z == blocks.z);
      unit.Limit[number] = glm::ivec3(-1);
      if (coded)
      {
        unit.Limit[number] = InOrderOf<D>(
          axes, plane.Target->Samples - 1 - this->Position * this->B(), this->B());
      }
      if (exists[number])
      {
        const std::ptrdiff_t at = number * shape.Pitch();
        const View<Sample> samples = decoded.Along(axes);
        LoadUnit<D>(View<const Sample>{ samples.Base, samples.Stride }, references.Along(axes),
          this->B, false, scratch.W() + at);
        LoadUnit<D>(
          wanted.Along(axes), references.Along(axes), this->B, true, target.W() + at);
      }
    }
    this->Work.Tokens.Clear();
    ForEachPass<D>(
      [&](auto pass)
      {
        using P = decltype(pass);
        SliceEncoder<P, Edge, Number>{ this->template RowsOf<P>(unit, mode.By, target.W()),
          this->Work.Tokens }
          .Run();
      });
    this->Work.Tokens.AppendTo(out);
    rough = unit.Any;
    for (int number = 0; number < units; ++number)
    {
      if (exists[number])
      {
        const glm::ivec3 axes = AxesOf<D>(number);
        StoreUnit<D>(scratch.W() + number * shape.Pitch(), references.Along(axes), this->B,
          plane.Least, plane.Greatest, decoded.Along(axes));
      }
    }
  }

  /// See EncodeBlock.
  void Encode(BlockPhase phase) const
  {
    const glm::ivec3 blocks = this->Job.Decoded->Blocks;
    const glm::ivec3& position = this->Position;
    const bool beyond = position.x == blocks.x || position.y == blocks.y || position.z == blocks.z;
    BlockTokens none;
    BlockUnderway noneUnderway;
    const std::size_t index = static_cast<std::size_t>(
      (std::int64_t{ position.z } * blocks.y + position.y) * blocks.x + position.x);
    BlockTokens& out = beyond ? none : (*this->Job.Blocks)[index];
    BlockUnderway& underway = beyond ? noneUnderway : (*this->Job.Underway)[index];
    if (!beyond && (out.Uniform || out.Same))
    {
      return;
    }
    const int b = this->B();
    const block::Shape<1> edges{ b };
    const block::Shape<2> faces{ b };
    if (phase == BlockPhase::Edges)
    {
      this->Work.Edges.Clear();
      this->EncodeUnits<1>(out, !beyond, this->Work.Edges, this->Work.EdgesTarget, underway.Rough);
      if (!beyond)
      {
        const std::uint8_t* m = this->Work.Edges.M();
        underway.Magnitudes.assign(m, m + 3 * edges.Pitch());
      }
    }
    else if (phase == BlockPhase::Faces)
    {
      this->Work.Faces.Clear();
      if (!beyond)
      {
        std::uint8_t kept[3][64];
        for (int edge = 0; edge < 3; ++edge)
        {
          std::copy_n(underway.Magnitudes.data() + edge * edges.Pitch(), b, kept[edge]);
        }
        block::PlaceEdges(b, kept, this->Work.Faces.M());
      }
      this->EncodeUnits<2>(out, !beyond, this->Work.Faces, this->Work.FacesTarget, underway.Rough);
      if (!beyond)
      {
        const std::uint8_t* m = this->Work.Faces.M();
        underway.Magnitudes.assign(m, m + b * faces.Y());
      }
    }
    else if (!beyond)
    {
      this->Work.Interior.Clear();
      block::PlaceFaces(b, underway.Magnitudes.data(), this->Work.Interior.M());
      this->EncodeUnits<3>(
        out, true, this->Work.Interior, this->Work.InteriorTarget, underway.Rough);
      if (!underway.Rough)
      {
        out.Tokens = {};
        out.Extra = {};
        out.Runs = {};
      }
      underway.Magnitudes = {};
    }
  }

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
    const RowPlace place{ z * shape.Z() + y * shape.Y(), 0, y, z, 0 };
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
    Unit<Number, 3> unit{ scratch.W(), scratch.M(), scratch.R(),
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

template <class Edge, class Number>
void EncodeBlockOf(
  const Edge& edge, const PlaneJob& job, const glm::ivec3& position, BlockPhase phase)
{
  using Coder = BlockCoder<Edge, Number>;
  thread_local std::unique_ptr<typename Coder::Workspace> work;
  thread_local int workEdge = 0;
  if (workEdge != edge())
  {
    work = std::make_unique<typename Coder::Workspace>(edge());
    workEdge = edge();
  }
  const Coder coder{ edge, job, position, *work };
  if (phase == BlockPhase::Choose)
  {
    coder.Choose();
    return;
  }
  coder.Encode(phase);
}

template <class Number>
void EncodeBlockOf(const PlaneJob& job, const glm::ivec3& position, BlockPhase phase)
{
  if (job.Decoded->Edge == 16)
  {
    return EncodeBlockOf<EdgeIs<16>, Number>({}, job, position, phase);
  }
  EncodeBlockOf<EdgeIs<0>, Number>({ job.Decoded->Edge }, job, position, phase);
}

void EncodeBlockHere(const PlaneJob& job, const glm::ivec3& position, BlockPhase phase)
{
  if (block::Narrow(job.Plane->Least, job.Plane->Greatest))
  {
    return EncodeBlockOf<std::int16_t>(job, position, phase);
  }
  EncodeBlockOf<std::int32_t>(job, position, phase);
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
