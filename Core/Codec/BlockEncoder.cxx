// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/BlockJob.h"

#include "Codec/Residual.h"

#include <algorithm>
#include <memory>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Codec/BlockEncoder.cxx"
#include <hwy/foreach_target.h>

#include "Codec/BlockAt-inl.h"
#include "Codec/BlockChoice-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Encodes the units of a block.
template <class Edge, class Number>
struct BlockCoder : BlockAt<Edge, Number>
{
  /// Encodes the units of D dimensions of a block.
  /// @param coded false: they are predicted only
  template <int D>
  void EncodeUnits(BlockTokens& out, bool coded, UnitMemory<Number, D>& scratch,
    UnitMemory<Number, D>& target, bool& rough) const
  {
    const PlaneToEncode& plane = this->Plane();
    const block::Mode mode = block::ModeOf(out.Mode);
    const block::Shape<D> shape{ this->B() };
    const References<Number> references = this->ReferencesOf(mode.From);
    const View<Number> decoded = this->ViewOf(*this->Job.Decoded);
    const View<const Number> wanted = this->ViewOf(*plane.Target);
    const glm::ivec3 blocks = this->Job.Decoded->Blocks;
    Unit<Number, D> unit{ scratch.W(), scratch.M(), scratch.R(), scratch.S(), {}, rough };
    bool exists[3] = {};
    for (int number = 0; number < UnitsOf<D>; ++number)
    {
      const glm::ivec3 axes = AxesOf<D>(number);
      const int mask = MaskOf<D>(number);
      exists[number] = !((mask & 1) != 0 && this->Position.x == blocks.x) &&
                       !((mask & 2) != 0 && this->Position.y == blocks.y) &&
                       !((mask & 4) != 0 && this->Position.z == blocks.z);
      unit.Limit[number] = glm::ivec3(-1);
      if (coded)
      {
        unit.Limit[number] =
          InOrderOf<D>(axes, plane.Target->Samples - 1 - this->Position * this->B(), this->B());
      }
      if (exists[number])
      {
        const std::ptrdiff_t at = number * shape.Pitch();
        const View<Number> samples = decoded.Along(axes);
        LoadBoth<D>(View<const Number>{ samples.Base, samples.Stride }, wanted.Along(axes),
          references.Along(axes), this->B, scratch.W() + at, target.W() + at);
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
    scratch.Used = rough;
    for (int number = 0; number < UnitsOf<D>; ++number)
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
    // Where no residual is known, magnitudes are zero, and nothing needs to be kept or placed.
    if (phase == BlockPhase::Edges)
    {
      this->Work.Edges.Clean();
      this->EncodeUnits<1>(out, !beyond, this->Work.Edges, this->Work.EdgesTarget, underway.Rough);
      if (underway.Rough && !beyond)
      {
        const std::uint8_t* m = this->Work.Edges.M();
        underway.Magnitudes.assign(m, m + 3 * edges.Pitch());
      }
    }
    else if (phase == BlockPhase::Faces)
    {
      this->Work.Faces.Clean();
      if (underway.Rough && !beyond)
      {
        std::uint8_t kept[3][64];
        for (int edge = 0; edge < 3; ++edge)
        {
          std::copy_n(underway.Magnitudes.data() + edge * edges.Pitch(), b, kept[edge]);
        }
        block::PlaceEdges(b, kept, this->Work.Faces.M());
        SumRows<2>(this->Work.Faces.M(), this->B, this->Work.Faces.S());
      }
      this->EncodeUnits<2>(out, !beyond, this->Work.Faces, this->Work.FacesTarget, underway.Rough);
      if (underway.Rough && !beyond)
      {
        const std::uint8_t* m = this->Work.Faces.M();
        underway.Magnitudes.assign(m, m + b * faces.Y());
      }
    }
    else if (!beyond)
    {
      this->Work.Interior.Clean();
      if (underway.Rough)
      {
        block::PlaceFaces(b, underway.Magnitudes.data(), this->Work.Interior.M());
        SumRows<3>(this->Work.Interior.M(), this->B, this->Work.Interior.S());
      }
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
};

template <class Edge, class Number>
void EncodeBlockOf(
  const Edge& edge, const PlaneJob& job, const glm::ivec3& position, BlockPhase phase)
{
  thread_local std::unique_ptr<BlockMemory<Number>> work;
  thread_local int workEdge = 0;
  if (workEdge != edge())
  {
    work = std::make_unique<BlockMemory<Number>>(edge());
    workEdge = edge();
  }
  const BlockAt<Edge, Number> block{ edge, job, position, *work };
  if (phase == BlockPhase::Choose)
  {
    return BlockChooser<Edge, Number>{ block }.Choose();
  }
  BlockCoder<Edge, Number>{ block }.Encode(phase);
}

template <class Number>
void EncodeBlockOf(const PlaneJob& job, const glm::ivec3& position, BlockPhase phase)
{
  WithEdge(job.Decoded->Edge, [&](const auto& edge)
    { EncodeBlockOf<std::decay_t<decltype(edge)>, Number>(edge, job, position, phase); });
}

void EncodeBlockHere(const PlaneJob& job, const glm::ivec3& position, BlockPhase phase)
{
  if (job.Decoded->Narrow)
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
