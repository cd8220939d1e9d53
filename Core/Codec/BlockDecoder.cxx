#include "Codec/BlockDecoder.h"

#include "Base/Error.h"
#include "Codec/SymbolReader.h"

#include <memory>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Codec/BlockDecoder.cxx"
#include <hwy/foreach_target.h>

#include "Codec/BlockUnits-inl.h"
#include "Codec/RowDecoder-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

template <int B>
struct BoxDecoder
{
  static constexpr int N = B + 1;
  const PlaneCode& Plane;
  const BoxCode& Code;
  View<std::int32_t> Box;
  View<const std::int32_t> A, BRef;

  struct Workspace
  {
    block::Scratch<B, 1> Edges[3];
    block::Scratch<B, 2> Faces[3];
    block::Scratch<B, 3> Interior;
    SymbolReader Readers[8];
  };

  static glm::ivec3 Corner(int owner) { return { owner & 1 ? B : 0, owner & 2 ? B : 0, owner & 4 ? B : 0 }; }

  References ReferencesOf(const block::Mode& mode) const
  {
    References result{ mode.From, this->A, this->BRef };
    if (mode.From != block::Reference::None && (this->Code.A == nullptr || this->Code.B == nullptr))
    {
      throw Error("A block refers to a step that its group does not have");
    }
    return result;
  }

  void PlaceCoarse() const
  {
    constexpr int n = B / 4 + 1;
    for (int z = 0; z < n; ++z)
    {
      for (int y = 0; y < n; ++y)
      {
        std::int32_t* row = this->Box.Row(4 * y, 4 * z);
        const std::int32_t* from = this->Code.Coarse + (z * n + y) * n;
        for (int x = 0; x < n; ++x)
        {
          row[4 * x] = from[x];
        }
      }
    }
  }

  /// The decoded face of a neighbour (1, 2 or 4), or null.
  const std::int32_t* FaceOf(int owner) const
  {
    return owner == 1 || owner == 2 || owner == 4 ? this->Code.Faces[owner / 2] : nullptr;
  }

  /// Whether the edge that a block across an edge of the box owns is in a decoded face.
  bool HasEdge(int owner) const
  {
    for (const int neighbour : { 1, 2, 4 })
    {
      if ((neighbour & owner) != 0 && this->FaceOf(neighbour) != nullptr)
      {
        return true;
      }
    }
    return false;
  }

  /// Rows have one of three lengths, which the compiler then knows.
  static HWY_INLINE void CopyRow(const std::int32_t* from, int count, std::int32_t* to)
  {
    if (count == 1)
    {
      *to = *from;
    }
    else if (count == B)
    {
      std::memcpy(to, from, B * sizeof(*to));
    }
    else
    {
      std::memcpy(to, from, N * sizeof(*to));
    }
  }

  /// A whole face, other owners' edges of it included.
  void PlaceFace(int owner) const
  {
    const std::int32_t* from = this->FaceOf(owner);
    for (int j = 0; j < N; ++j, from += N)
    {
      if (owner == 1)
      {
        for (int y = 0; y < N; ++y)
        {
          this->Box.Row(y, j)[B] = from[y];
        }
        continue;
      }
      CopyRow(from, N, owner == 2 ? this->Box.Row(B, j) : this->Box.Row(j, B));
    }
  }

  /// Whether a block takes no decoding: it is uniform, the same as in reference A, or decoded.
  bool Plain(int owner) const
  {
    const BlockCode& block = this->Code.Blocks[owner];
    return block.Uniform || block.Same || this->FaceOf(owner) != nullptr;
  }

  /// Fills what a plain block owns of the box.
  void PlacePlain(int owner) const
  {
    if (this->FaceOf(owner) != nullptr)
    {
      return this->PlaceFace(owner);
    }
    if (this->Code.Blocks[owner].Same && this->Code.A == nullptr)
    {
      throw Error("A block is the same as in a step that its group does not have");
    }
    const glm::ivec3 low = Corner(owner);
    const glm::ivec3 high{ owner & 1 ? N : B, owner & 2 ? N : B, owner & 4 ? N : B };
    for (int z = low.z; z < high.z; ++z)
    {
      for (int y = low.y; y < high.y; ++y)
      {
        std::int32_t* row = this->Box.Row(y, z);
        if (this->Code.Blocks[owner].Same)
        {
          CopyRow(this->A.Row(y, z) + low.x, high.x - low.x, row + low.x);
        }
        else
        {
          std::fill(row + low.x, row + high.x, this->Code.Blocks[owner].Value);
        }
      }
    }
  }

  /// Decodes one unit of a block. Units outside the box only advance the reader.
  template <int D>
  void DecodeUnit(int owner, int mask, SymbolReader* symbols, block::Scratch<B, D>& scratch) const
  {
    const BlockCode& block = this->Code.Blocks[owner];
    const block::Mode mode = block::ModeOf(block.Mode);
    const glm::ivec3 axes = UnitAxes(mask);
    block::Unit<B> unit = scratch.Whole();
    unit.Limit = Permuted(block.Limit, axes, D);
    const bool needed = (mask & owner) == 0;
    const glm::ivec3 corner = Corner(owner);
    References from = this->ReferencesOf(mode).Along(axes);
    View<std::int32_t> view = this->Box.Along(axes);
    if (needed)
    {
      from = from.At(Permuted(corner, axes, 3));
      view = view.At(Permuted(corner, axes, 3));
      LoadUnit<B, D>({ view.Base, view.Stride }, from, unit.W);
    }
    RunPasses<B, D>(unit, mode.By,
      RowDecoder<B>{ symbols, this->Plane.CoarseBin, this->Plane.FineBin });
    if (needed)
    {
      StoreUnit<B, D>(unit.W, from, this->Plane.Least, this->Plane.Greatest, view);
    }
  }

  /// A vector in the order of a unit's axes; those that the unit does not have do not limit it.
  static glm::ivec3 Permuted(const glm::ivec3& v, const glm::ivec3& axes, int dimensions)
  {
    return { v[axes.x], dimensions > 1 ? v[axes.y] : B, dimensions > 2 ? v[axes.z] : B };
  }

  void Run(Workspace& work) const
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
        readers[owner] = &work.Readers[owner];
        // Of neighbours no more is read than their edges and faces; no symbol takes more bits.
        constexpr std::size_t most = (3 * B * B + 3 * B) * 41 / 8 + 8;
        readers[owner]->Open(
          this->Plane.Tables, block.Data, block.Bytes, owner == 0 ? block.Bytes : most);
      }
    }
    for (const int owner : { 3, 5, 6 })
    {
      if (!this->Plain(owner) && !this->HasEdge(owner))
      {
        for (int unit = 0; unit < 3; ++unit)
        {
          this->Edge(owner, unit, readers[owner], work);
        }
      }
    }
    // The faces of a block need the magnitudes of its own edges; those of all blocks need the edges
    // of the others.
    struct FaceOwner
    {
      std::uint8_t Edges[3][B];
    };
    FaceOwner kept[4];
    constexpr int owners[4] = { 1, 2, 4, 0 };
    for (int i = 0; i < 4; ++i)
    {
      const int owner = owners[i];
      if (this->Plain(owner))
      {
        continue;
      }
      for (int unit = 0; unit < 3; ++unit)
      {
        this->Edge(owner, unit, readers[owner], work);
        std::copy(work.Edges[unit].M(), work.Edges[unit].M() + B, kept[i].Edges[unit]);
      }
    }
    for (int i = 0; i < 4; ++i)
    {
      const int owner = owners[i];
      if (this->Plain(owner))
      {
        continue;
      }
      for (int unit = 3; unit < 6; ++unit)
      {
        this->Face(owner, unit, readers[owner], kept[i].Edges, work);
      }
    }
    if (!this->Plain(0))
    {
      this->Inside(readers[0], work);
    }
  }

  void Edge(int owner, int unit, SymbolReader* symbols, Workspace& work) const
  {
    const int mask = UnitMasks[unit];
    const bool needed = (mask & owner) == 0;
    work.Edges[unit].ClearMagnitudes();
    if (needed || symbols != nullptr)
    {
      this->DecodeUnit<1>(owner, mask, symbols, work.Edges[unit]);
    }
  }

  void Face(int owner, int unit, SymbolReader* symbols, const std::uint8_t (&edges)[3][B],
    Workspace& work) const
  {
    const int mask = UnitMasks[unit];
    const bool needed = (mask & owner) == 0;
    block::Scratch<B, 2>& scratch = work.Faces[unit - 3];
    scratch.ClearMagnitudes();
    if (symbols != nullptr)
    {
      const glm::ivec3 axes = UnitAxes(mask);
      PlaceEdges(scratch, edges[axes.x], edges[axes.y]);
    }
    if (needed || symbols != nullptr)
    {
      this->DecodeUnit<2>(owner, mask, symbols, scratch);
    }
  }

  static void PlaceEdges(
    block::Scratch<B, 2>& scratch, const std::uint8_t* alongX, const std::uint8_t* alongY)
  {
    std::uint8_t* m = scratch.M();
    std::copy(alongX, alongX + B, m);
    for (int y = 1; y < B; ++y)
    {
      m[y * scratch.RowM] = alongY[y];
    }
  }

  void Inside(SymbolReader* symbols, Workspace& work) const
  {
    if (symbols != nullptr)
    {
      work.Interior.ClearMagnitudes();
      std::uint8_t* m = work.Interior.M();
      constexpr int row = block::Scratch<B, 3>::RowM;
      const std::uint8_t* xy = work.Faces[0].M();
      const std::uint8_t* xz = work.Faces[1].M();
      const std::uint8_t* yz = work.Faces[2].M();
      for (int j = 0; j < B; ++j)
      {
        std::copy(xy + j * row, xy + j * row + B, m + j * row);
      }
      for (int k = 1; k < B; ++k)
      {
        std::copy(xz + k * row, xz + k * row + B, m + k * B * row);
        for (int j = 1; j < B; ++j)
        {
          m[(k * B + j) * row] = yz[k * row + j];
        }
      }
    }
    this->DecodeUnit<3>(0, 7, symbols, work.Interior);
    if (symbols != nullptr && !symbols->AtEnd())
    {
      throw Error("The payload of a block is damaged: its symbols do not end where it ends");
    }
  }
};

template <int B>
void DecodeBoxOf(const PlaneCode& plane, const BoxCode& code, std::int32_t* box)
{
  constexpr std::int64_t n = B + 1;
  thread_local std::unique_ptr<typename BoxDecoder<B>::Workspace> work;
  if (!work)
  {
    work = std::make_unique<typename BoxDecoder<B>::Workspace>();
  }
  const glm::i64vec3 strides{ 1, n, n * n };
  const BoxDecoder<B> decoder{ plane, code, { box, strides }, { code.A, strides },
    { code.B, strides } };
  decoder.Run(*work);
}

void DecodeBoxHere(int edge, const PlaneCode& plane, const BoxCode& code, std::int32_t* box)
{
  switch (edge)
  {
    case 8:
      return DecodeBoxOf<8>(plane, code, box);
    case 16:
      return DecodeBoxOf<16>(plane, code, box);
    case 32:
      return DecodeBoxOf<32>(plane, code, box);
    default:
      return DecodeBoxOf<64>(plane, code, box);
  }
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace banyan
{

HWY_EXPORT(DecodeBoxHere);

void DecodeBox(int edge, const PlaneCode& plane, const BoxCode& code, std::int32_t* box)
{
  HWY_DYNAMIC_DISPATCH(DecodeBoxHere)(edge, plane, code, box);
}

} // namespace banyan
#endif
