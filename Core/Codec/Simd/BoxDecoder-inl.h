// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_BoxDecoder_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_BoxDecoder_inl_h
#undef banyan_Codec_BoxDecoder_inl_h
#else
#define banyan_Codec_BoxDecoder_inl_h
#endif

#if HWY_TARGET == HWY_SCALAR
#include "Codec/Scalar/ScalarBox.h"
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// DecodeBox for blocks of edge B. The kernels want vectors of 16 bytes at least.
template <int B, class Number>
void DecodeBoxOf(const PlaneCode& plane, const BoxCodeOf<Number>& code, Number* box)
{
  scalar::DecodeBox(B, plane, code, box);
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#else
#include "Base/Error.h"
#include "Codec/BlockScratch.h"
#include "Codec/DecodeStages.h"
#include "Codec/Simd/BoxPlaces-inl.h"
#include "Codec/Simd/EdgeDecoder-inl.h"
#include "Codec/Simd/FaceCopies-inl.h"
#include "Codec/Simd/InteriorDecoder-inl.h"
#include "Codec/SymbolReader.h"

#include <memory>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Memory that a thread decodes boxes with.
template <int B, class Number>
struct BoxWorkspace
{
  block::Scratch<Number, 1> Edges{ B };
  block::Scratch<Number, 2> Faces{ B };
  std::uint16_t InteriorSums[block::Shape<3>{ B }.Sums()] = {}; ///< of rows, from 16 on
  BoxMagnitudes<B> Magnitudes;
  BoxMemory<Number, B> Box;
  SymbolReader Readers[8];
  /// Magnitudes of the edges of the blocks 1, 2, 4 and 0 of a box, row by row.
  std::uint8_t EdgeMagnitudes[4][3][block::MostEdge];
};

/// Decodes a box: what comes to it without residuals, edges of all its blocks, their faces, and the
/// interior of its own block.
template <int B, class Number>
struct BoxDecoder : BoxPlaces<B, Number>
{
  const PlaneCode& Plane;
  View<const Number> ReferenceB;
  BoxWorkspace<B, Number>& Work;
  Number* To; ///< the whole box

  References<Number> ReferencesOf(int owner, const block::Mode& mode) const
  {
    if (mode.From != block::Reference::None && (this->Code.A == nullptr || this->Code.B == nullptr))
    {
      throw Error("A block refers to a step that its group does not have");
    }
    if (owner == 0 && mode.From != block::Reference::None)
    {
      const View<const Number> both{ this->Work.Box.Subtracted(), this->ReferenceA.Stride };
      return { block::Reference::A, both, both };
    }
    return { mode.From, this->ReferenceA, this->ReferenceB };
  }

  /// Takes what the block's own references give, once for all of its units.
  void TakeReferences() const
  {
    const block::Mode mode = block::ModeOf(this->Code.Blocks[0].Mode);
    if (!this->Plain(0) && this->ReferencesOf(0, mode).From != block::Reference::None)
    {
      const stages::In stage(stages::References);
      this->Work.Box.Refer(mode.From, this->Code.A, this->Code.B);
    }
  }

  /// The units of D dimensions of a block, with what is known of them.
  template <int D>
  Unit<Number, D> UnitsOfBlock(int owner, block::Scratch<Number, D>& scratch, bool any) const
  {
    Unit<Number, D> unit{ scratch.Samples(), scratch.Magnitudes(), scratch.Residuals(),
      scratch.RowSums(), {}, any };
    for (int number = 0; number < UnitsOf<D>; ++number)
    {
      unit.Limit[number] = InOrderOf<D>(AxesOf<D>(number), this->Code.Blocks[owner].Limit, B);
    }
    return unit;
  }

  /// Calls body(samples of the box, references, samples of the unit) for the units that lie in the
  /// box.
  template <int D, class Body>
  HWY_INLINE void ForEachInside(
    int owner, const References<Number>& references, Number* samples, const Body& body) const
  {
    constexpr block::Shape<D> shape{ B };
    const glm::ivec3 corner = this->Corner(owner);
    for (int number = 0; number < UnitsOf<D>; ++number)
    {
      if ((MaskOf<D>(number) & owner) == 0)
      {
        const glm::ivec3 axes = AxesOf<D>(number);
        const glm::ivec3 from = InOrderOf<3>(axes, corner, 0);
        body(this->Box.Along(axes).At(from), references.Along(axes).At(from),
          samples + number * shape.Pitch());
      }
    }
  }

  template <class P>
  Number BinOf() const
  {
    return static_cast<Number>(P::S == 2 ? this->Plane.CoarseBin : this->Plane.FineBin);
  }

  /// Decodes the edges of a block. Edges outside the box only advance the reader.
  /// @return whether some magnitudes are not 0
  bool DecodeEdges(int owner, SymbolReader* reader) const
  {
    const stages::In stage(stages::Edges);
    this->Work.Edges.Clear();
    const block::Mode mode = block::ModeOf(this->Code.Blocks[owner].Mode);
    const References<Number> references = this->ReferencesOf(owner, mode);
    Unit<Number, 1> unit = this->template UnitsOfBlock<1>(owner, this->Work.Edges, false);
    this->template ForEachInside<1>(owner, references, unit.Samples,
      [](const View<Number>& samples, const References<Number>& from, Number* to) {
        LoadUnit<1, B>(View<const Number>{ samples.Base, samples.Stride }, from, false, to);
      });
    ForEachPass<1>(
      [&](auto pass)
      {
        using P = decltype(pass);
        EdgeDecoder<P, B, Number>(unit, mode.By, reader, this->template BinOf<P>()).Run();
      });
    this->template ForEachInside<1>(owner, references, unit.Samples,
      [this](const View<Number>& samples, const References<Number>& from, const Number* decoded)
      { StoreUnit<1, B>(decoded, from, this->Plane.Least, this->Plane.Greatest, samples); });
    return unit.Any;
  }

  void KeepEdges(std::uint8_t (&magnitudes)[3][block::MostEdge]) const
  {
    for (int edge = 0; edge < 3; ++edge)
    {
      std::copy_n(
        this->Work.Edges.Magnitudes() + edge * block::Shape<1>{ B }.Pitch(), B, magnitudes[edge]);
    }
  }

  /// Decodes the faces of a block. Faces outside the box only advance the reader.
  /// @param edges magnitudes of its edges
  /// @param any whether some of them are not 0
  /// @return the same of edges and faces
  bool DecodeFaces(int owner, SymbolReader* reader, const std::uint8_t (&edges)[3][block::MostEdge],
    bool any) const
  {
    const stages::In stage(stages::FaceCopies);
    if (reader != nullptr)
    {
      this->Work.Magnitudes.BeginFaces(edges, this->Work.Faces.RowSums());
    }
    const block::Mode mode = block::ModeOf(this->Code.Blocks[owner].Mode);
    const References<Number> references = this->ReferencesOf(owner, mode);
    Unit<Number, 2> unit = this->template UnitsOfBlock<2>(owner, this->Work.Faces, any);
    this->template ForEachInside<2>(owner, references, unit.Samples,
      [](const View<Number>& samples, const References<Number>& from, Number* to)
      { WithFaceCopy<B>(samples, from, to, [](const auto& face) { face.Load(); }); });
    ForEachPass<2>(
      [&](auto pass)
      {
        using P = decltype(pass);
        this->Code.Prefetch(6);
        const stages::In passes(stages::FacePasses);
        auto& magnitudes = this->Work.Magnitudes;
        BeginStride<P>(magnitudes.Faces, reader);
        SliceDecoder<P, B, Number>(unit, magnitudes.Faces.template At<P::S>(), mode.By, reader,
          this->template BinOf<P>(), magnitudes.Slice)
          .Run();
      });
    this->template ForEachInside<2>(owner, references, unit.Samples,
      [this](const View<Number>& samples, const References<Number>& from, Number* decoded)
      {
        WithFaceCopy<B>(samples, from, decoded,
          [this](const auto& face) {
            face.Store(
              static_cast<Number>(this->Plane.Least), static_cast<Number>(this->Plane.Greatest));
          });
      });
    return unit.Any;
  }

  void DecodeInside(SymbolReader* reader, bool any) const
  {
    const stages::In stage(stages::References);
    std::uint16_t* const sums = this->Work.InteriorSums + 16;
    if (reader != nullptr)
    {
      this->Work.Magnitudes.BeginInterior(sums);
    }
    const BlockCode& block = this->Code.Blocks[0];
    Unit<Number, 3> unit{ this->Box.Base, nullptr, nullptr, sums, { block.Limit }, any };
    DecodeInterior(
      unit, block::ModeOf(block.Mode), this->Plane, reader, this->Work.Magnitudes, this->Work.Box,
      [this](int lines) { this->Code.Prefetch(lines); }, this->To);
    if (reader != nullptr && !reader->AtEnd())
    {
      throw Error("The payload of a block is damaged: its symbols do not end where it ends");
    }
  }

  /// Places what is plain, and opens the payloads of other blocks.
  void Begin(SymbolReader* (&readers)[8]) const
  {
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
        // No more is read of neighbours than their edges and faces; no symbol takes more bits.
        constexpr std::size_t most = (3 * B * B + 3 * B) * 41 / 8 + 8 * B;
        readers[owner]->Open(
          *this->Plane.Tables, block.Data, block.Bytes, owner == 0 ? block.Bytes : most);
      }
    }
  }

  void Run() const
  {
    {
      const stages::In stage(stages::Coarse);
      this->PlaceCoarse();
    }
    this->TakeReferences();
    SymbolReader* readers[8] = {};
    this->Begin(readers);
    for (const int owner : { 3, 5, 6 })
    {
      if (!this->Plain(owner) && !this->HasEdge(owner))
      {
        this->DecodeEdges(owner, readers[owner]);
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
        any[i] = this->DecodeEdges(owners[i], readers[owners[i]]);
        this->KeepEdges(this->Work.EdgeMagnitudes[i]);
      }
    }
    for (int i = 0; i < 4; ++i)
    {
      if (!this->Plain(owners[i]))
      {
        any[i] =
          this->DecodeFaces(owners[i], readers[owners[i]], this->Work.EdgeMagnitudes[i], any[i]);
      }
    }
    if (!this->Plain(0))
    {
      this->DecodeInside(readers[0], any[3]);
    }
    else
    {
      this->Work.Box.Copy(this->To);
    }
  }
};

/// DecodeBox for blocks of edge B.
template <int B, class Number>
HWY_INLINE void DecodeBoxOf(const PlaneCode& plane, const BoxCodeOf<Number>& code, Number* box)
{
  thread_local const auto work = std::make_unique<BoxWorkspace<B, Number>>();
  constexpr std::int64_t n = B + 1;
  const glm::i64vec3 strides{ 1, n, n * n };
  if (code.Prefetcher != nullptr)
  {
    code.Prefetcher->Write(box, BoxMemory<Number, B>::Count * sizeof(Number));
  }
  BoxDecoder<B, Number>{ { code, { work->Box.Decoded(), strides }, { code.A, strides } }, plane,
    { code.B, strides }, *work, box }
    .Run();
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // HWY_SCALAR

#endif
