// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see CellKernels.cxx.
#if defined(banyan_Render_Cells_LatticeRows_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Render_Cells_LatticeRows_inl_h
#undef banyan_Render_Cells_LatticeRows_inl_h
#else
#define banyan_Render_Cells_LatticeRows_inl_h
#endif

#include "Render/Cells/CellRows-inl.h"
#include "Render/Cells/MeshLattice.h"
#include "Render/Raycast/LightLanes-inl.h"

#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Puts the values of a lattice into a slab, where rays are in the mesh. Whether they are, cells of
/// the lattice say, or the faces at the border that rays have crossed: those of the slab must have
/// been drawn.
class LatticeRows
{
public:
  LatticeRows(const SlabJob& job, const LatticeJob& lattice)
    : Job(job)
    , Lattice(lattice)
  {
    const PlacesInRows& places = lattice.Lattice.Places();
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Origin[axis] = static_cast<double>(places.First[axis]);
      this->Last[axis] = static_cast<float>(places.Count[axis] - 1);
    }
    this->PerEdge = static_cast<float>((1 << FractionBits) / static_cast<double>(places.Step[0]));
    this->Row = places.Count.x;
    this->Layer = places.Count.x * places.Count.y;
  }

  void Fill()
  {
    for (int slot = 0; slot < RayTile::Slots; slot += Lanes)
    {
      const D d;
      const auto open = hn::Gt(hn::Load(d, this->Job.Rays.Transmittance + slot),
        hn::Set(d, this->Job.Rays.TransmittanceLimit));
      if (this->Lattice.EndsNever || !hn::AllFalse(d, open))
      {
        this->FillRays(slot);
      }
    }
  }

private:
  static constexpr int Lanes = static_cast<int>(hn::MaxLanes(D()));

  void FillRays(int slot)
  {
    const D d;
    const DI di;
    const TileRows& rows = this->Job.Rows;
    const VI first = hn::Load(di, rows.First + slot);
    const VI end = hn::Load(di, rows.End + slot);
    const VI head = hn::Load(di, rows.Head + slot);
    const VI tail = hn::Load(di, rows.Tail + slot);
    const int packet = slot / RayTile::PacketSize;
    VF inside = hn::Load(d, this->Lattice.Inside + slot);
    for (int row = 0; row < SampleSlab::Rows; ++row)
    {
      const VI here = hn::Set(di, this->Job.FirstRow + row);
      auto there = hn::AndNot(hn::Gt(first, here), hn::Gt(end, here));
      Triple at = RaysAt(this->Job, slot, this->Job.FirstRow + row, this->Origin).At;
      if (rows.AnyEnds)
      {
        const auto isHead = hn::Eq(head, here);
        const auto isTail = hn::Eq(tail, here);
        this->Replace(isHead, this->Job.Rays.Head, slot, at);
        this->Replace(isTail, this->Job.Rays.Tail, slot, at);
        there = hn::Or(there, hn::Or(isHead, isTail));
      }
      if (!hn::AllFalse(di, there))
      {
        this->FillRow(packet, slot, row, at, hn::RebindMask(d, there), inside);
      }
    }
    hn::Store(inside, d, this->Lattice.Inside + slot);
  }

  /// Positions of heads or tails, from Origin on.
  HWY_INLINE void Replace(hn::Mask<DI> lanes, const RayTile::Ends& ends, int slot, Triple& at) const
  {
    const D d;
    if (hn::AllFalse(DI(), lanes))
    {
      return;
    }
    alignas(64) float places[3][RayTile::PacketSize];
    for (int axis = 0; axis < 3; ++axis)
    {
      for (int i = 0; i < Lanes; ++i)
      {
        const std::int64_t position = ToFixed(ends.Cell[axis][slot + i]) +
                                      (ends.Position[axis][slot + i] & ((1u << FractionBits) - 1));
        places[axis][i] = static_cast<float>(
          (static_cast<double>(position) - this->Origin[axis]) / (1 << FractionBits));
      }
    }
    const auto mask = hn::RebindMask(d, lanes);
    at = { hn::IfThenElse(mask, hn::Load(d, places[0]), at.X),
      hn::IfThenElse(mask, hn::Load(d, places[1]), at.Y),
      hn::IfThenElse(mask, hn::Load(d, places[2]), at.Z) };
  }

  /// @param there lanes that have a sample in this row
  /// @param inside 1 where rays are in the mesh at the beginning of the row's interval, 0 where
  /// not, below 0 where that is not known; set to what is so at its end
  HWY_INLINE void FillRow(
    int packet, int slot, int row, const Triple& at, hn::Mask<D> there, VF& inside)
  {
    const D d;
    const DI di;
    const VF zero = hn::Zero(d);
    const VF one = hn::Set(d, 1.0f);
    const int index = SampleSlab::IndexOf(slot, row);
    SampleSlab& slab = this->Job.Slab;
    const bool border = (slab.Borders[packet] >> row & 1) != 0;
    const VF before = border ? hn::Load(d, slab.Before + index) : zero;
    const VF behind = border ? hn::Load(d, slab.Behind + index) : zero;
    const Place place = this->PlaceAt(at, there);
    const VI bits =
      hn::BitCast(di, hn::GatherIndex(d, this->Lattice.Lattice.Values(), place.Index));
    const auto has = [&](std::uint32_t mask, std::uint32_t what) HWY_ATTR
    {
      return hn::And(place.Within,
        hn::RebindMask(d, hn::Eq(hn::And(bits, hn::Set(di, static_cast<std::int32_t>(mask))),
                            hn::Set(di, static_cast<std::int32_t>(what)))));
    };
    const auto known = has(MeshLattice::CellBits, MeshLattice::Inside);
    const auto asked = has(MeshLattice::CellBits, MeshLattice::AtBorder);
    const auto unknown = hn::And(asked, hn::Lt(inside, zero));
    if (!hn::AllFalse(d, unknown))
    {
      const auto near = has(MeshLattice::PlaceBit, MeshLattice::PlaceBit);
      const VF begins = this->Beginning(packet, slot, row, hn::IfThenElseZero(near, one));
      inside = hn::IfThenElse(unknown, begins, inside);
    }
    const VF told = hn::Add(inside, before);
    const auto in = hn::And(there, hn::Or(known, hn::And(asked, hn::Gt(told, hn::Set(d, 0.5f)))));
    if (!hn::AllFalse(d, in))
    {
      this->Put(place, slot, index, in);
      slab.Marks[packet] |= std::uint64_t{ 1 } << row;
    }
    const VF after = hn::Add(hn::IfThenElseZero(in, one), behind);
    inside = hn::IfThenElse(there, hn::Min(hn::Max(after, zero), one), inside);
  }

  /// Whether rays that begin at the border are in the mesh: the next crossing of the border tells,
  /// or the next cell of the lattice that is not at the border.
  /// @param otherwise where nothing in the slab tells
  HWY_INLINE VF Beginning(int packet, int slot, int first, VF otherwise) const
  {
    const D d;
    const SampleSlab& slab = this->Job.Slab;
    alignas(64) float begins[RayTile::PacketSize];
    hn::Store(otherwise, d, begins);
    for (int i = 0; i < Lanes; ++i)
    {
      bool told = false;
      for (int row = first; row < SampleSlab::Rows && !told; ++row)
      {
        float change = 0.0f;
        if ((slab.Borders[packet] >> row & 1) != 0)
        {
          const int index = SampleSlab::IndexOf(slot, row) + i;
          change = slab.Before[index] != 0.0f ? slab.Before[index] : slab.Behind[index];
        }
        const std::uint32_t cell = this->CellAt(slot + i, this->Job.FirstRow + row);
        told = change != 0.0f || cell != MeshLattice::AtBorder;
        const bool in = change != 0.0f ? change < 0.0f : cell == MeshLattice::Inside;
        begins[i] = told ? (in ? 1.0f : 0.0f) : begins[i];
      }
    }
    return hn::Load(d, begins);
  }

  /// What is known of the lattice's cell where a ray has a whole sample; AtBorder where it has
  /// none.
  std::uint32_t CellAt(int slot, int row) const
  {
    const TileRows& rows = this->Job.Rows;
    if (row < rows.First[slot] || row >= rows.End[slot])
    {
      return MeshLattice::AtBorder;
    }
    const PlacesInRows& places = this->Lattice.Lattice.Places();
    glm::ivec3 at;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double position = rows.Zero[axis][slot] + row * this->Job.Rays.WholeStep[axis][slot];
      const double place = (position - this->Origin[axis]) / static_cast<double>(places.Step[axis]);
      if (!(place >= 0.0 && place < places.Count[axis] - 1))
      {
        return MeshLattice::Outside;
      }
      at[axis] = static_cast<int>(place);
    }
    std::uint32_t bits = 0;
    std::memcpy(&bits, this->Lattice.Lattice.Values() + places.IndexOf(at), sizeof(bits));
    return bits & MeshLattice::CellBits;
  }

  /// Where positions are on the lattice.
  struct Place
  {
    VI Index; ///< of the low corner of its cell
    Triple Part;
    hn::Mask<D> Within;
  };

  HWY_INLINE Place PlaceAt(const Triple& at, hn::Mask<D> there) const
  {
    const D d;
    const DI di;
    const Triple on = Times(at, hn::Set(d, this->PerEdge));
    const VF zero = hn::Zero(d);
    const auto within = [&](VF x, int axis) HWY_ATTR
    { return hn::And(hn::Ge(x, zero), hn::Lt(x, hn::Set(d, this->Last[axis]))); };
    Place place;
    place.Within =
      hn::And(hn::And(there, within(on.X, 0)), hn::And(within(on.Y, 1), within(on.Z, 2)));
    const auto low = [&](VF x) HWY_ATTR { return hn::Floor(hn::IfThenElseZero(place.Within, x)); };
    const Triple corner{ low(on.X), low(on.Y), low(on.Z) };
    place.Part = Minus(on, corner);
    place.Index = hn::Add(hn::ConvertTo(di, corner.X),
      hn::Add(hn::Mul(hn::ConvertTo(di, corner.Y), hn::Set(di, this->Row)),
        hn::Mul(hn::ConvertTo(di, corner.Z), hn::Set(di, this->Layer))));
    return place;
  }

  HWY_INLINE void Put(const Place& place, int slot, int index, hn::Mask<D> in) const
  {
    const D d;
    const MeshLattice& lattice = this->Lattice.Lattice;
    const VF nothing = hn::Set(d, SampleSlab::Nothing);
    hn::Store(hn::IfThenElse(in, this->Between(lattice.Values(), place), nothing), d,
      this->Job.Slab.Value + index);
    if (this->Job.Shading)
    {
      const Direction direction{ hn::Load(d, this->Job.Rays.Direction[0] + slot),
        hn::Load(d, this->Job.Rays.Direction[1] + slot),
        hn::Load(d, this->Job.Rays.Direction[2] + slot) };
      hn::Store(CosineOf(*this->Job.Shading, this->Between(lattice.Gradients(0), place),
                  this->Between(lattice.Gradients(1), place),
                  this->Between(lattice.Gradients(2), place), direction),
        d, this->Job.Slab.Cosine + index);
    }
  }

  /// Between the eight places around.
  HWY_INLINE VF Between(const float* values, const Place& place) const
  {
    const D d;
    const DI di;
    const auto line = [&](int from) HWY_ATTR
    {
      const VI low = hn::Add(place.Index, hn::Set(di, from));
      const VF a = hn::GatherIndex(d, values, low);
      const VF b = hn::GatherIndex(d, values + 1, low);
      return hn::Add(a, hn::Mul(hn::Sub(b, a), place.Part.X));
    };
    const auto face = [&](int from) HWY_ATTR
    {
      const VF a = line(from);
      return hn::Add(a, hn::Mul(hn::Sub(line(from + this->Row), a), place.Part.Y));
    };
    const VF a = face(0);
    return hn::Add(a, hn::Mul(hn::Sub(face(this->Layer), a), place.Part.Z));
  }

  const SlabJob& Job;
  const LatticeJob& Lattice;
  double Origin[3] = {}; ///< fixed-point
  float Last[3] = {};
  float PerEdge = 1.0f;
  std::int32_t Row = 0;
  std::int32_t Layer = 0;
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
