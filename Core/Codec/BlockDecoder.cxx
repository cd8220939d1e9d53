#include "Codec/BlockDecoder.h"

#include "Base/Error.h"
#include "Codec/BlockScratch.h"
#include "Codec/SymbolReader.h"

#include <memory>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Codec/BlockDecoder.cxx"
#include <hwy/foreach_target.h>

#include "Codec/BlockUnits-inl.h"
#include "Codec/SliceDecoder-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

template <class Edge, class Number>
struct BoxDecoder
{
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
    SymbolReader Readers[8];
    /// Magnitudes of the edges of the blocks 1, 2, 4 and 0 of a box, row by row.
    std::uint8_t EdgeMagnitudes[4][3][64];
  };

  Edge B;
  const PlaneCode& Plane;
  const BoxCodeOf<Number>& Code;
  View<Number> Box;
  View<const Number> A, BRef;
  Workspace& Work;

  int N() const { return this->B() + 1; }

  glm::ivec3 Corner(int owner) const
  {
    const int b = this->B();
    return { owner & 1 ? b : 0, owner & 2 ? b : 0, owner & 4 ? b : 0 };
  }

  References<Number> ReferencesOf(const block::Mode& mode) const
  {
    if (mode.From != block::Reference::None && (this->Code.A == nullptr || this->Code.B == nullptr))
    {
      throw Error("A block refers to a step that its group does not have");
    }
    return { mode.From, this->A, this->BRef };
  }

  void PlaceCoarse() const
  {
    const int n = this->B() / 4 + 1;
    const Number* from = this->Code.Coarse;
    for (int z = 0; z < n; ++z)
    {
      for (int y = 0; y < n; ++y, from += n)
      {
        Number* row = this->Box.Row(4 * y, 4 * z);
        for (int x = 0; x < n; ++x)
        {
          row[4 * x] = from[x];
        }
      }
    }
  }

  /// The decoded box of a neighbour (1, 2 or 4), or null.
  const Number* NeighbourOf(int owner) const
  {
    return owner == 1 || owner == 2 || owner == 4 ? this->Code.Neighbours[owner / 2] : nullptr;
  }

  /// Whether the edge that a block across an edge of the box owns is in a decoded face.
  bool HasEdge(int owner) const
  {
    for (const int neighbour : { 1, 2, 4 })
    {
      if ((neighbour & owner) != 0 && this->NeighbourOf(neighbour) != nullptr)
      {
        return true;
      }
    }
    return false;
  }

  /// The first layer of a decoded neighbour, other owners' edges of it included, is the last one here.
  void PlaceFace(int owner) const
  {
    const int n = this->N();
    const View<const Number> from{ this->NeighbourOf(owner), this->Box.Stride };
    const glm::ivec3 corner = this->Corner(owner);
    const View<Number> to = this->Box.At(corner);
    if (owner == 1)
    {
      for (int z = 0; z < n; ++z)
      {
        for (int y = 0; y < n; ++y)
        {
          *to.Row(y, z) = *from.Row(y, z);
        }
      }
      return;
    }
    for (int j = 0; j < n; ++j)
    {
      const int y = owner == 2 ? 0 : j;
      const int z = owner == 2 ? j : 0;
      std::copy_n(from.Row(y, z), n, to.Row(y, z));
    }
  }

  /// Whether a block takes no decoding: it is uniform, the same as in reference A, or decoded.
  bool Plain(int owner) const
  {
    const BlockCode& block = this->Code.Blocks[owner];
    return block.Uniform || block.Same || this->NeighbourOf(owner) != nullptr;
  }

  /// Fills what a plain block owns of the box.
  void PlacePlain(int owner) const
  {
    if (this->NeighbourOf(owner) != nullptr)
    {
      return this->PlaceFace(owner);
    }
    if (this->Code.Blocks[owner].Same && this->Code.A == nullptr)
    {
      throw Error("A block is the same as in a step that its group does not have");
    }
    const int n = this->N();
    const glm::ivec3 low = this->Corner(owner);
    const glm::ivec3 high{ owner & 1 ? n : n - 1, owner & 2 ? n : n - 1, owner & 4 ? n : n - 1 };
    for (int z = low.z; z < high.z; ++z)
    {
      for (int y = low.y; y < high.y; ++y)
      {
        Number* row = this->Box.Row(y, z);
        if (this->Code.Blocks[owner].Same)
        {
          std::copy(this->A.Row(y, z) + low.x, this->A.Row(y, z) + high.x, row + low.x);
        }
        else
        {
          std::fill(row + low.x, row + high.x, static_cast<Number>(this->Code.Blocks[owner].Value));
        }
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
    const References<Number> references = this->ReferencesOf(mode);
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
    forEachNeeded([&](const View<Number>& samples, const References<Number>& from, Number* w)
      { LoadUnit<D>(View<const Number>{ samples.Base, samples.Stride }, from, this->B, false, w); });
    ForEachPass<D>(
      [&](auto pass)
      {
        using P = decltype(pass);
        SliceDecoder<P, Edge, Number>(unit, this->B, mode.By, symbols,
          static_cast<Number>(P::S == 2 ? this->Plane.CoarseBin : this->Plane.FineBin),
          this->Work.Slice)
          .Run();
      });
    forEachNeeded(
      [&](const View<Number>& samples, const References<Number>& from, Number* w)
      { StoreUnit<D>(w, from, this->B, this->Plane.Least, this->Plane.Greatest, samples); });
    return unit.Any;
  }

  void Run() const
  {
    this->PlaceCoarse();
    SymbolReader* readers[8] = {};
    for (int owner = 0; owner < 8; ++owner)
    {
      const BlockCode& block = this->Code.Blocks[owner];
      if (block.Exists && this->Plain(owner))
      {
        this->PlacePlain(owner);
      }
      else if (block.Exists && block.Bytes > 0 && owner != 7 && !this->HasEdge(owner))
      {
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
  }

  bool Edges(int owner, SymbolReader* symbols) const
  {
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

  bool Faces(
    int owner, SymbolReader* symbols, const std::uint8_t (&edges)[3][64], bool any) const
  {
    if (symbols != nullptr)
    {
      this->Work.Faces.Clear();
      block::PlaceEdges(this->B(), edges, this->Work.Faces.M());
      SumRows<2>(this->Work.Faces.M(), this->B, this->Work.Faces.S());
    }
    return this->template DecodeUnits<2>(owner, symbols, this->Work.Faces, any);
  }

  void Inside(SymbolReader* symbols, bool any) const
  {
    if (symbols != nullptr)
    {
      this->Work.Interior.Clear();
      block::PlaceFaces(this->B(), this->Work.Faces.M(), this->Work.Interior.M());
      SumRows<3>(this->Work.Interior.M(), this->B, this->Work.Interior.S());
    }
    this->template DecodeUnits<3>(0, symbols, this->Work.Interior, any);
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
  Decoder{ edge, plane, code, { box, strides }, { code.A, strides }, { code.B, strides }, *work }
    .Run();
}

template <class Number>
void DecodeBoxOf(
  int edge, const PlaneCode& plane, const BoxCodeOf<Number>& code, Number* box)
{
  if (edge == 16)
  {
    return DecodeBoxOf(EdgeIs<16>{}, plane, code, box);
  }
  DecodeBoxOf(EdgeIs<0>{ edge }, plane, code, box);
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
