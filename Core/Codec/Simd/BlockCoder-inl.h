// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_BlockCoder_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_BlockCoder_inl_h
#undef banyan_Codec_BlockCoder_inl_h
#else
#define banyan_Codec_BlockCoder_inl_h
#endif

#include "Codec/Simd/BlockAt-inl.h"
#include "Codec/Simd/ModeDecision-inl.h"

#include <memory>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Encodes the units of a block.
template <int B, class Number>
struct BlockCoder : BlockAt<B, Number>
{
  bool Beyond(int axis) const { return this->Position[axis] == this->Job.Decoded->Blocks[axis]; }
  bool BeyondAny() const { return this->Beyond(0) || this->Beyond(1) || this->Beyond(2); }

  /// Whether the field has a unit.
  template <int D>
  bool Exists(int number) const
  {
    const int mask = MaskOf<D>(number);
    return !((mask & 1) != 0 && this->Beyond(0)) && !((mask & 2) != 0 && this->Beyond(1)) &&
           !((mask & 4) != 0 && this->Beyond(2));
  }

  /// Takes the units of D dimensions, and what they are to become, less what both refer to.
  /// @param coded false: they are predicted only
  template <int D>
  void Load(
    const References<Number>& references, bool coded, Unit<Number, D>& unit, Number* target) const
  {
    constexpr block::Shape<D> shape{ B };
    const View<Number> decoded = this->ViewOf(*this->Job.Decoded);
    const PlaneNumbers& plane = *this->Plane().Target;
    const View<const Number> wanted = this->ViewOf(plane);
    for (int number = 0; number < UnitsOf<D>; ++number)
    {
      const glm::ivec3 axes = AxesOf<D>(number);
      unit.Limit[number] =
        coded ? InOrderOf<D>(axes, plane.Samples - 1 - this->Position * B, B) : glm::ivec3(-1);
      if (this->template Exists<D>(number))
      {
        const std::ptrdiff_t at = number * shape.Pitch();
        const View<Number> samples = decoded.Along(axes);
        LoadBoth<D, B>(View<const Number>{ samples.Base, samples.Stride }, wanted.Along(axes),
          references.Along(axes), unit.Samples + at, target + at);
      }
    }
  }

  /// Puts back what units are decoded to.
  template <int D>
  void Store(const References<Number>& references, const Unit<Number, D>& unit) const
  {
    constexpr block::Shape<D> shape{ B };
    const PlaneToEncode& plane = this->Plane();
    const View<Number> decoded = this->ViewOf(*this->Job.Decoded);
    for (int number = 0; number < UnitsOf<D>; ++number)
    {
      if (this->template Exists<D>(number))
      {
        const glm::ivec3 axes = AxesOf<D>(number);
        StoreUnit<D, B>(unit.Samples + number * shape.Pitch(), references.Along(axes), plane.Least,
          plane.Greatest, decoded.Along(axes));
      }
    }
  }

  /// Encodes the units of D dimensions of a block.
  /// @param coded false: they are predicted only
  /// @param rough whether some residual is not 0
  template <int D>
  void EncodeUnits(BlockTokens& out, bool coded, UnitMemory<Number, D>& scratch,
    UnitMemory<Number, D>& target, bool& rough) const
  {
    const block::Mode mode = block::ModeOf(out.Mode);
    const References<Number> references = this->ReferencesOf(mode.From);
    Unit<Number, D> unit{ scratch.Samples(), scratch.Magnitudes(), scratch.Residuals(),
      scratch.RowSums(), {}, rough };
    this->template Load<D>(references, coded, unit, target.Samples());
    this->Work.Tokens.Clear();
    ForEachPass<D>(
      [&](auto pass)
      {
        using P = decltype(pass);
        SliceEncoder<P, B, Number>{ this->template RowsOf<P>(unit, mode.By, target.Samples()),
          this->Work.Tokens }
          .Run();
      });
    this->Work.Tokens.AppendTo(out);
    rough = unit.Any;
    scratch.Used = rough;
    this->template Store<D>(references, unit);
  }

  // Where no residual is known, magnitudes are zero, and nothing needs to be kept or placed.

  void EncodeEdges(BlockTokens& out, bool coded, BlockUnderway& underway) const
  {
    this->Work.Edges.Clean();
    this->template EncodeUnits<1>(
      out, coded, this->Work.Edges, this->Work.EdgesTarget, underway.Rough);
    if (underway.Rough && coded)
    {
      const std::uint8_t* const m = this->Work.Edges.Magnitudes();
      underway.Magnitudes.assign(m, m + 3 * block::Shape<1>{ B }.Pitch());
    }
  }

  void EncodeFaces(BlockTokens& out, bool coded, BlockUnderway& underway) const
  {
    this->Work.Faces.Clean();
    std::uint8_t* const m = this->Work.Faces.Magnitudes();
    if (underway.Rough && coded)
    {
      std::uint8_t kept[3][block::MostEdge];
      for (int edge = 0; edge < 3; ++edge)
      {
        std::copy_n(
          underway.Magnitudes.data() + edge * block::Shape<1>{ B }.Pitch(), B, kept[edge]);
      }
      block::PlaceEdges(B, kept, m);
      SumRows<2, B>(m, this->Work.Faces.RowSums());
    }
    this->template EncodeUnits<2>(
      out, coded, this->Work.Faces, this->Work.FacesTarget, underway.Rough);
    if (underway.Rough && coded)
    {
      underway.Magnitudes.assign(m, m + B * block::Shape<2>{ B }.Y());
    }
  }

  void EncodeInterior(BlockTokens& out, BlockUnderway& underway) const
  {
    this->Work.Interior.Clean();
    if (underway.Rough)
    {
      std::uint8_t* const m = this->Work.Interior.Magnitudes();
      block::PlaceFaces(B, underway.Magnitudes.data(), m);
      SumRows<3, B>(m, this->Work.Interior.RowSums());
    }
    this->template EncodeUnits<3>(
      out, true, this->Work.Interior, this->Work.InteriorTarget, underway.Rough);
    if (!underway.Rough)
    {
      out.Tokens = {};
      out.Extra = {};
      out.Runs = {};
    }
    underway.Magnitudes = {};
  }

  /// See EncodeBlock.
  void Encode(BlockPhase phase) const
  {
    const glm::ivec3 blocks = this->Job.Decoded->Blocks;
    const glm::ivec3& position = this->Position;
    const bool coded = !this->BeyondAny();
    BlockTokens none;
    BlockUnderway noneUnderway;
    const std::size_t index = static_cast<std::size_t>(
      (std::int64_t{ position.z } * blocks.y + position.y) * blocks.x + position.x);
    BlockTokens& out = coded ? (*this->Job.Blocks)[index] : none;
    BlockUnderway& underway = coded ? (*this->Job.Underway)[index] : noneUnderway;
    if (out.Uniform || out.Same)
    {
      return;
    }
    if (phase == BlockPhase::Edges)
    {
      this->EncodeEdges(out, coded, underway);
    }
    else if (phase == BlockPhase::Faces)
    {
      this->EncodeFaces(out, coded, underway);
    }
    else if (coded)
    {
      this->EncodeInterior(out, underway);
    }
  }
};

/// EncodeBlock for blocks of edge B.
template <int B, class Number>
HWY_INLINE void EncodeBlockOf(const PlaneJob& job, const glm::ivec3& position, BlockPhase phase)
{
  thread_local const auto work = std::make_unique<BlockMemory<B, Number>>();
  const BlockAt<B, Number> block{ job, position, *work };
  if (phase == BlockPhase::Choose)
  {
    return ModeDecision<B, Number>{ block }.Choose();
  }
  BlockCoder<B, Number>{ block }.Encode(phase);
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
