// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/BlockDecoder.h"

#include "Base/Error.h"
#include "Codec/BlockScratch.h"
#include "Codec/DecodeStages.h"
#include "Codec/SymbolReader.h"

#include <memory>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Codec/BlockDecoder.cxx"
#include <hwy/foreach_target.h>

#include "Codec/BoxPlaces-inl.h"
#include "Codec/DenseBox-inl.h"
#include "Codec/DenseFaces-inl.h"
#include "Codec/DenseInterior-inl.h"
#include "Codec/SliceDecoder-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

template <class Edge, class Number>
struct BoxDecoder : BoxPlaces<Edge, Number>
{
  static constexpr bool Dense = HasDense<Edge>;
  static constexpr int KnownEdge = Edge::Known; ///< 0: it is not known

  struct Workspace
  {
    explicit Workspace(int edge)
      : Edges(edge)
      , Faces(edge)
      , Interior(edge)
      , Slice(edge)
    {
    }
    block::Scratch<Number, 1> Edges;
    block::Scratch<Number, 2> Faces;
    block::Scratch<Number, 3> Interior;
    SliceMemory<Number> Slice;
    std::conditional_t<Dense, DenseWork<KnownEdge>, int> Vectors{};
    std::conditional_t<Dense, DenseBox<Number, KnownEdge>, int>
      Whole{}; ///< where the box is decoded
    SymbolReader Readers[8];
    /// Magnitudes of the edges of the blocks 1, 2, 4 and 0 of a box, row by row.
    std::uint8_t EdgeMagnitudes[4][3][64];
  };

  const PlaneCode& Plane;
  View<const Number> BRef;
  Workspace& Work;
  Number* To; ///< the whole box

  References<Number> ReferencesOf(int owner, const block::Mode& mode) const
  {
    if (mode.From != block::Reference::None && (this->Code.A == nullptr || this->Code.B == nullptr))
    {
      throw Error("A block refers to a step that its group does not have");
    }
    if constexpr (Dense)
    {
      if (owner == 0 && mode.From != block::Reference::None)
      {
        const View<const Number> both{ this->Work.Whole.Subtracted(), this->A.Stride };
        return { block::Reference::A, both, both };
      }
    }
    return { mode.From, this->A, this->BRef };
  }

  /// Takes what the block's own references give, once for all of its units.
  void TakeReferences() const
  {
    if constexpr (Dense)
    {
      const block::Mode mode = block::ModeOf(this->Code.Blocks[0].Mode);
      if (!this->Plain(0) && this->ReferencesOf(0, mode).From != block::Reference::None)
      {
        const stages::In stage(stages::References);
        this->Work.Whole.Refer(mode.From, this->Code.A, this->Code.B);
      }
    }
  }

  /// Decodes the units of D dimensions of a block. Those outside the box only advance the reader.
  /// @param any whether some magnitudes are not 0, before
  /// @return the same, after
  template <int D>
  bool DecodeUnits(
    int owner, SymbolReader* symbols, block::Scratch<Number, D>& scratch, bool any) const
  {
    const BlockCode& block = this->Code.Blocks[owner];
    const block::Mode mode = block::ModeOf(block.Mode);
    const block::Shape<D> shape{ this->B() };
    const glm::ivec3 corner = this->Corner(owner);
    const References<Number> references = this->ReferencesOf(owner, mode);
    const auto forEachNeeded = [&](auto&& body)
    {
      for (int number = 0; number < UnitsOf<D>; ++number)
      {
        if ((MaskOf<D>(number) & owner) == 0)
        {
          const glm::ivec3 axes = AxesOf<D>(number);
          const glm::ivec3 from = InOrderOf<3>(axes, corner, 0);
          body(this->Box.Along(axes).At(from), references.Along(axes).At(from),
            scratch.W() + number * shape.Pitch());
        }
      }
    };
    Unit<Number, D> unit{ scratch.W(), scratch.M(), scratch.R(), scratch.S(), {}, any };
    for (int number = 0; number < UnitsOf<D>; ++number)
    {
      unit.Limit[number] = InOrderOf<D>(AxesOf<D>(number), block.Limit, this->B());
    }
    forEachNeeded(
      [&](const View<Number>& samples, const References<Number>& from, Number* w)
      {
        if constexpr (Dense && D == 2)
        {
          WithDenseFace<KnownEdge>(samples, from, w, [](const auto& face) { face.Load(); });
        }
        else
        {
          LoadUnit<D>(View<const Number>{ samples.Base, samples.Stride }, from, this->B, false, w);
        }
      });
    ForEachPass<D>(
      [&](auto pass)
      {
        using P = decltype(pass);
        if constexpr (Dense && D == 2)
        {
          this->Code.AskAhead(6);
          const stages::In stage(stages::FacePasses);
          BeginStride<P>(this->Work.Vectors.Faces, symbols);
          DenseSliceDecoder<P, KnownEdge, Number>(unit,
            this->Work.Vectors.Faces.template At<P::S>(), mode.By, symbols,
            static_cast<Number>(P::S == 2 ? this->Plane.CoarseBin : this->Plane.FineBin),
            this->Work.Vectors.Slice)
            .Run();
          return;
        }
        SliceDecoder<P, Edge, Number>(unit, this->B, mode.By, symbols,
          static_cast<Number>(P::S == 2 ? this->Plane.CoarseBin : this->Plane.FineBin),
          this->Work.Slice)
          .Run();
      });
    forEachNeeded(
      [&](const View<Number>& samples, const References<Number>& from, Number* w)
      {
        if constexpr (Dense && D == 2)
        {
          WithDenseFace<KnownEdge>(samples, from, w,
            [this](const auto& face) {
              face.Store(
                static_cast<Number>(this->Plane.Least), static_cast<Number>(this->Plane.Greatest));
            });
        }
        else
        {
          StoreUnit<D>(w, from, this->B, this->Plane.Least, this->Plane.Greatest, samples);
        }
      });
    return unit.Any;
  }

  void Run() const
  {
    {
      const stages::In stage(stages::Coarse);
      this->PlaceCoarse();
    }
    this->TakeReferences();
    SymbolReader* readers[8] = {};
    for (int owner = 0; owner < 8; ++owner)
    {
      const BlockCode& block = this->Code.Blocks[owner];
      if (block.Exists && this->Plain(owner))
      {
        const stages::In stage(stages::Plain);
        this->PlacePlain(owner);
      }
      else if (block.Exists && block.Bytes > 0 && owner != 7 && !this->HasEdge(owner))
      {
        const stages::In stage(stages::Payload);
        readers[owner] = &this->Work.Readers[owner];
        // Of neighbours no more is read than their edges and faces; no symbol takes more bits.
        const std::size_t b = static_cast<std::size_t>(this->B());
        const std::size_t most = (3 * b * b + 3 * b) * 41 / 8 + 8 * b;
        readers[owner]->Open(
          *this->Plane.Tables, block.Data, block.Bytes, owner == 0 ? block.Bytes : most);
      }
    }
    for (const int owner : { 3, 5, 6 })
    {
      if (!this->Plain(owner) && !this->HasEdge(owner))
      {
        this->Edges(owner, readers[owner]);
      }
    }
    // The faces of a block need the magnitudes of its own edges; those of all blocks need the edges
    // of the others.
    constexpr int owners[4] = { 1, 2, 4, 0 };
    bool any[4] = {};
    for (int i = 0; i < 4; ++i)
    {
      if (!this->Plain(owners[i]))
      {
        any[i] = this->Edges(owners[i], readers[owners[i]]);
        this->KeepEdges(this->Work.EdgeMagnitudes[i]);
      }
    }
    for (int i = 0; i < 4; ++i)
    {
      if (!this->Plain(owners[i]))
      {
        any[i] = this->Faces(owners[i], readers[owners[i]], this->Work.EdgeMagnitudes[i], any[i]);
      }
    }
    if (!this->Plain(0))
    {
      this->Inside(readers[0], any[3]);
    }
    else if constexpr (Dense)
    {
      this->Work.Whole.Copy(this->To);
    }
  }

  bool Edges(int owner, SymbolReader* symbols) const
  {
    const stages::In stage(stages::Edges);
    this->Work.Edges.Clear();
    return this->template DecodeUnits<1>(owner, symbols, this->Work.Edges, false);
  }

  void KeepEdges(std::uint8_t (&magnitudes)[3][64]) const
  {
    const block::Shape<1> shape{ this->B() };
    for (int edge = 0; edge < 3; ++edge)
    {
      std::copy_n(this->Work.Edges.M() + edge * shape.Pitch(), this->B(), magnitudes[edge]);
    }
  }

  bool Faces(int owner, SymbolReader* symbols, const std::uint8_t (&edges)[3][64], bool any) const
  {
    const stages::In stage(stages::FaceCopies);
    if constexpr (Dense)
    {
      if (symbols != nullptr)
      {
        this->Work.Vectors.BeginFaces(edges, this->Work.Faces.S());
      }
    }
    else if (symbols != nullptr)
    {
      this->Work.Faces.Clear();
      block::PlaceEdges(this->B(), edges, this->Work.Faces.M());
      SumRows<2>(this->Work.Faces.M(), this->B, this->Work.Faces.S());
    }
    return this->template DecodeUnits<2>(owner, symbols, this->Work.Faces, any);
  }

  void Inside(SymbolReader* symbols, bool any) const
  {
    const stages::In stage(stages::References);
    if constexpr (Dense)
    {
      if (symbols != nullptr)
      {
        this->Work.Vectors.BeginInterior(this->Work.Interior.S());
      }
    }
    else if (symbols != nullptr)
    {
      this->Work.Interior.Clear();
      block::PlaceFaces(this->B(), this->Work.Faces.M(), this->Work.Interior.M());
      SumRows<3>(this->Work.Interior.M(), this->B, this->Work.Interior.S());
    }
    if constexpr (Dense)
    {
      const BlockCode& block = this->Code.Blocks[0];
      const block::Mode mode = block::ModeOf(block.Mode);
      Unit<Number, 3> unit{ this->Box.Base, nullptr, nullptr, this->Work.Interior.S(),
        { block.Limit }, any };
      DecodeDenseInterior(
        unit, mode, this->Plane, symbols, this->Work.Vectors, this->Work.Whole,
        [this](int lines) { this->Code.AskAhead(lines); }, this->To);
    }
    else
    {
      this->template DecodeUnits<3>(0, symbols, this->Work.Interior, any);
    }
    if (symbols != nullptr && !symbols->AtEnd())
    {
      throw Error("The payload of a block is damaged: its symbols do not end where it ends");
    }
  }
};

template <class Edge, class Number>
void DecodeBoxOf(
  const Edge& edge, const PlaneCode& plane, const BoxCodeOf<Number>& code, Number* box)
{
  using Decoder = BoxDecoder<Edge, Number>;
  thread_local std::unique_ptr<typename Decoder::Workspace> work;
  thread_local int workEdge = 0;
  if (workEdge != edge())
  {
    work = std::make_unique<typename Decoder::Workspace>(edge());
    workEdge = edge();
  }
  const std::int64_t n = edge() + 1;
  const glm::i64vec3 strides{ 1, n, n * n };
  Number* decoded = box;
  if constexpr (Decoder::Dense)
  {
    decoded = work->Whole.Samples();
    if (code.Ahead != nullptr)
    {
      code.Ahead->Write(box, DenseBox<Number, Decoder::KnownEdge>::Count * sizeof(Number));
    }
  }
  Decoder{ { edge, code, { decoded, strides }, { code.A, strides } }, plane, { code.B, strides },
    *work, box }
    .Run();
}

template <class Number>
void DecodeBoxOf(int edge, const PlaneCode& plane, const BoxCodeOf<Number>& code, Number* box)
{
  WithEdge(edge, [&](const auto& known) { DecodeBoxOf(known, plane, code, box); });
}

void DecodeShort(
  int edge, const PlaneCode& plane, const BoxCodeOf<std::int16_t>& code, std::int16_t* box)
{
  DecodeBoxOf(edge, plane, code, box);
}

void DecodeLong(
  int edge, const PlaneCode& plane, const BoxCodeOf<std::int32_t>& code, std::int32_t* box)
{
  DecodeBoxOf(edge, plane, code, box);
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace banyan
{

HWY_EXPORT(DecodeShort);
HWY_EXPORT(DecodeLong);

void DecodeBox(
  int edge, const PlaneCode& plane, const BoxCodeOf<std::int16_t>& code, std::int16_t* box)
{
  HWY_DYNAMIC_DISPATCH(DecodeShort)(edge, plane, code, box);
}

void DecodeBox(
  int edge, const PlaneCode& plane, const BoxCodeOf<std::int32_t>& code, std::int32_t* box)
{
  HWY_DYNAMIC_DISPATCH(DecodeLong)(edge, plane, code, box);
}

} // namespace banyan
#endif
