// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see CellKernels.cxx.
#if defined(banyan_Render_Cells_CellPackets_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Render_Cells_CellPackets_inl_h
#undef banyan_Render_Cells_CellPackets_inl_h
#else
#define banyan_Render_Cells_CellPackets_inl_h
#endif

#include "Render/Cells/CellPlaces-inl.h"
#include "Render/Cells/CellTile.h"
#include "Render/Raycast/LightLanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

#if HWY_TARGET != HWY_SCALAR
using DD = hn::Repartition<double, D>;
using DHalfFloat = hn::Rebind<float, DD>;
using VD = hn::Vec<DD>;
#endif

/// Where the rays of a vector are from a point of reference on, at one row, and how they go on.
struct RayLanes
{
  Triple At;   ///< in cells
  Triple Step; ///< from row to row
};

/// @param middle fixed-point, whole
HWY_INLINE RayLanes RaysAt(const SlabJob& job, int slot, double row, const double (&middle)[3])
{
  const D d;
  constexpr double perUnit = 1.0 / (1 << FractionBits);
#if HWY_TARGET == HWY_SCALAR
  const auto at = [&](int axis)
  {
    const double whole = job.Rows.Zero[axis][slot] + row * job.Rays.WholeStep[axis][slot];
    return hn::Set(d, static_cast<float>((whole - middle[axis]) * perUnit));
  };
#else
  const DD dd;
  constexpr int half = static_cast<int>(hn::MaxLanes(DD()));
  const VD n = hn::Set(dd, row);
  const auto at = [&](int axis) HWY_ATTR
  {
    const VD from = hn::Set(dd, middle[axis]);
    const auto part = [&](int first) HWY_ATTR
    {
      const VD whole = hn::Add(hn::Load(dd, job.Rows.Zero[axis] + first),
        hn::Mul(n, hn::Load(dd, job.Rays.WholeStep[axis] + first)));
      return hn::DemoteTo(DHalfFloat(), hn::Mul(hn::Sub(whole, from), hn::Set(dd, perUnit)));
    };
    return hn::Combine(d, part(slot + half), part(slot));
  };
#endif
  return { { at(0), at(1), at(2) },
    { hn::Load(d, job.Rows.Step[0] + slot), hn::Load(d, job.Rows.Step[1] + slot),
      hn::Load(d, job.Rows.Step[2] + slot) } };
}

/// Lanes in which a <= b.
HWY_INLINE hn::Mask<DI> AtMost(VI a, VI b)
{
  return hn::Not(hn::Gt(a, b));
}

/// Draws one cell after the other into a slab. Samples that may lie in a cell are collected until
/// they fill a vector, and found in it together.
class CellPackets
{
public:
  explicit CellPackets(const SlabJob& job)
    : Job(job)
  {
  }

  /// @param row of the tile near the cell's middle
  /// @param first, last rows of the tile that samples of the cell may be in
  void Draw(const CellSetup& cell, const PixelRect& packets, double row, double first, double last)
  {
    this->Cell = &cell;
    this->FirstRow = std::max(first, static_cast<double>(this->Job.FirstRow));
    this->LastRow = std::min(last, static_cast<double>(this->Job.FirstRow + SampleSlab::Rows - 1));
    this->Row = row;
    for (int axis = 0; axis < 3; ++axis)
    {
      this->MiddleLow[axis] =
        static_cast<std::uint32_t>(static_cast<std::int64_t>(cell.Middle[axis]));
    }
    for (int y = packets.Lo.y; y < packets.Hi.y; ++y)
    {
      for (int x = packets.Lo.x; x < packets.Hi.x; ++x)
      {
        this->DrawPacket(y * RayTile::PacketsPerRow + x);
      }
    }
    this->FindAll();
  }

private:
  static constexpr int Lanes = static_cast<int>(hn::MaxLanes(D()));

  void DrawPacket(int packet)
  {
    for (int i = 0; i < RayTile::PacketSize; i += Lanes)
    {
      const int slot = packet * RayTile::PacketSize + i;
      const RayLanes rays = RaysAt(this->Job, slot, this->Row, this->Cell->Middle);
      VI first;
      VI last;
      this->RowsInside(rays, slot, first, last);
      const auto some = AtMost(first, last);
      if (!hn::AllFalse(DI(), some))
      {
        this->Collect(packet, slot, rays, first, last);
      }
    }
    if (this->Job.Rows.AnyEnds)
    {
      this->DrawEnds(
        packet, this->Job.Rows.Heads[packet], this->Job.Rows.Head, this->Job.Rays.Head);
      this->DrawEnds(
        packet, this->Job.Rows.Tails[packet], this->Job.Rows.Tail, this->Job.Rays.Tail);
    }
  }

  /// Rows of the slab in which whole samples of rays may be in the cell, from its first row on.
  HWY_INLINE void RowsInside(const RayLanes& rays, int slot, VI& first, VI& last) const
  {
    const D d;
    const DI di;
    const CellSetup& cell = *this->Cell;
    const Triple from = Minus(rays.At, InAllLanes(cell.Base));
    const VI none = hn::Set(di, this->Job.FirstRow);
    const VI begin = hn::Sub(hn::Load(di, this->Job.Rows.First + slot), none);
    const VI end = hn::Sub(hn::Load(di, this->Job.Rows.End + slot), none);
    first = hn::Max(begin, hn::Zero(di));
    last = hn::Sub(hn::Min(end, hn::Set(di, SampleSlab::Rows)), hn::Set(di, 1));
    // In rows from this->Row on.
    const VF toRow = hn::Set(d, static_cast<float>(this->Row - this->Job.FirstRow));
    VF enter = hn::Sub(hn::ConvertTo(d, first), toRow);
    VF leave = hn::Sub(hn::ConvertTo(d, last), toRow);
    VF sumAt = hn::Zero(d);
    VF sumAlong = hn::Zero(d);
    VF sumSlack = hn::Zero(d);
    const bool tetrahedron = cell.Shape == CellShape::Tetrahedron;
    for (int i = 0; i < 3; ++i)
    {
      const Triple inverse = InAllLanes(cell.Inverse[i]);
      const VF at = DotOf(inverse, from);
      const VF along = DotOf(inverse, rays.Step);
      // What rounding may have done.
      const Triple size{ hn::Abs(hn::Mul(inverse.X, from.X)), hn::Abs(hn::Mul(inverse.Y, from.Y)),
        hn::Abs(hn::Mul(inverse.Z, from.Z)) };
      const VF slack = hn::Mul(hn::Add(hn::Add(size.X, size.Y), size.Z), hn::Set(d, 1e-6f));
      Clip(at, along, hn::Sub(hn::Set(d, cell.Low[i]), slack),
        hn::Add(hn::Set(d, cell.High[i]), slack), enter, leave);
      if (i < 2 || tetrahedron)
      {
        sumAt = hn::Add(sumAt, at);
        sumAlong = hn::Add(sumAlong, along);
        sumSlack = hn::Add(sumSlack, slack);
      }
    }
    if (cell.HasSum)
    {
      Clip(sumAt, sumAlong, hn::Set(d, -1e30f), hn::Add(hn::Set(d, cell.HighSum), sumSlack), enter,
        leave);
    }
    const VF little = hn::Set(d, 0.01f);
    const auto some = hn::Le(enter, hn::Add(leave, little));
    const VI low = hn::ConvertTo(di, hn::Add(hn::Ceil(hn::Sub(enter, little)), toRow));
    const VI high = hn::ConvertTo(di, hn::Add(hn::Floor(hn::Add(leave, little)), toRow));
    first =
      hn::Max(first, hn::IfThenElse(hn::RebindMask(di, some), low, hn::Set(di, SampleSlab::Rows)));
    last = hn::Min(last, high);
  }

  /// Narrows where low <= at + n * along <= high.
  static HWY_INLINE void Clip(VF at, VF along, VF low, VF high, VF& enter, VF& leave)
  {
    const D d;
    const VF least = hn::Set(d, 1e-30f);
    const VF safe = hn::IfThenElse(hn::Lt(hn::Abs(along), least), least, along);
    const VF inverse = hn::Div(hn::Set(d, 1.0f), safe);
    const VF a = hn::Mul(hn::Sub(low, at), inverse);
    const VF b = hn::Mul(hn::Sub(high, at), inverse);
    enter = hn::Max(enter, hn::Min(a, b));
    leave = hn::Min(leave, hn::Max(a, b));
  }

  /// Each ray goes from its first row to its last one.
  HWY_INLINE void Collect(int packet, int slot, const RayLanes& rays, VI first, VI last)
  {
    const DI di;
    const DU du;
    const VI one = hn::Set(di, 1);
    std::uint64_t& marks = this->Job.Slab.Marks[packet];
    const VI lane = hn::Iota(di, SampleSlab::IndexOf(slot, 0));
    VI row = first;
    auto lanes = AtMost(row, last);
    int lowest = SampleSlab::Rows;
    int highest = -1;
    LimitsOf(first, last, lanes, lowest, highest);
    const std::uint64_t upTo =
      highest >= 63 ? ~std::uint64_t{ 0 } : (std::uint64_t{ 1 } << (highest + 1)) - 1;
    marks |= upTo & ~((std::uint64_t{ 1 } << lowest) - 1);
    if (this->Cell->IsWide)
    {
      this->CollectWide(slot, row, last, lane);
      return;
    }
    VU position[3];
    VU step[3];
    const VU n = hn::BitCast(du, hn::Add(row, hn::Set(di, this->Job.FirstRow)));
    for (int axis = 0; axis < 3; ++axis)
    {
      step[axis] = hn::Load(du, this->Job.Rays.Step[axis] + slot);
      position[axis] =
        hn::Sub(hn::Add(hn::Load(du, this->Job.Rows.ZeroLow[axis] + slot), hn::Mul(n, step[axis])),
          hn::Set(du, this->MiddleLow[axis]));
    }
    while (!hn::AllFalse(di, lanes))
    {
      const VI index = hn::Add(lane, hn::ShiftLeft<4>(row));
      const std::size_t count = hn::CompressStore(index, lanes, di, this->Index + this->Filled);
      for (int axis = 0; axis < 3; ++axis)
      {
        (void)hn::CompressStore(
          hn::BitCast(di, position[axis]), lanes, di, this->Fixed[axis] + this->Filled);
        position[axis] = hn::Add(position[axis], step[axis]);
      }
      this->Filled += static_cast<int>(count);
      row = hn::Add(row, one);
      lanes = AtMost(row, last);
      if (this->Filled >= Lanes)
      {
        this->FindFixed(Lanes);
      }
    }
    (void)rays;
  }

  static HWY_INLINE void LimitsOf(VI first, VI last, hn::Mask<DI> lanes, int& lowest, int& highest)
  {
    const DI di;
    lowest =
      hn::GetLane(hn::MinOfLanes(di, hn::IfThenElse(lanes, first, hn::Set(di, SampleSlab::Rows))));
    highest = hn::GetLane(hn::MaxOfLanes(di, hn::IfThenElse(lanes, last, hn::Set(di, -1))));
  }

  /// The same for cells that are too large for fixed-point numbers of 32 bits.
  void CollectWide(int slot, VI first, VI last, VI lane)
  {
    const DI di;
    alignas(64) std::int32_t firsts[RayTile::PacketSize];
    alignas(64) std::int32_t lasts[RayTile::PacketSize];
    alignas(64) std::int32_t indices[RayTile::PacketSize];
    hn::Store(first, di, firsts);
    hn::Store(last, di, lasts);
    hn::Store(lane, di, indices);
    for (int i = 0; i < Lanes; ++i)
    {
      for (int row = firsts[i]; row <= lasts[i]; ++row)
      {
        const double n = row + this->Job.FirstRow;
        double position[3];
        for (int axis = 0; axis < 3; ++axis)
        {
          position[axis] = this->Job.Rows.Zero[axis][slot + i] +
                           n * this->Job.Rays.WholeStep[axis][slot + i] - this->Cell->Middle[axis];
        }
        this->Add(indices[i] + row * SampleSlab::Lanes, position);
      }
    }
  }

  /// @param position fixed-point, from the middle of a wide cell on
  void Add(int index, const double (&position)[3])
  {
    this->Index[this->Filled] = index;
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Float[axis][this->Filled] = static_cast<float>(position[axis] / (1 << FractionBits));
    }
    if (++this->Filled == Lanes)
    {
      this->FindFloat(Lanes);
    }
  }

  /// Heads or tails of a packet.
  void DrawEnds(
    int packet, const TileRows::Range& range, const std::int32_t* rows, const RayTile::Ends& ends)
  {
    if (range.Last < this->FirstRow || range.First > this->LastRow)
    {
      return;
    }
    const int begin = this->Job.FirstRow;
    if (!this->Cell->IsWide)
    {
      this->FindAll();
    }
    for (int slot = packet * RayTile::PacketSize; slot < (packet + 1) * RayTile::PacketSize; ++slot)
    {
      const int row = rows[slot] - begin;
      if (rows[slot] == TileRows::None || rows[slot] < this->FirstRow || rows[slot] > this->LastRow)
      {
        continue;
      }
      double position[3];
      bool near = true;
      for (int axis = 0; axis < 3; ++axis)
      {
        position[axis] =
          static_cast<double>(ToFixed(ends.Cell[axis][slot]) +
                              (ends.Position[axis][slot] & ((1u << FractionBits) - 1))) -
          this->Cell->Middle[axis];
        near = near && std::abs(position[axis]) <= this->Cell->Reach[axis];
      }
      if (near)
      {
        this->Job.Slab.Marks[packet] |= std::uint64_t{ 1 } << row;
        this->Add(SampleSlab::IndexOf(slot, row), position);
      }
    }
    if (!this->Cell->IsWide)
    {
      this->FindFloat(this->Filled);
    }
  }

  void FindAll()
  {
    this->Cell->IsWide ? this->FindFloat(this->Filled) : this->FindFixed(this->Filled);
  }

  /// Finds the first samples of those collected.
  void FindFixed(int count)
  {
    const D d;
    const DI di;
    if (count == 0)
    {
      return;
    }
    const VF unit = hn::Set(d, 1.0f / (1 << FractionBits));
    const auto at = [&](int axis) HWY_ATTR
    { return hn::Mul(hn::ConvertTo(d, hn::LoadU(di, this->Fixed[axis])), unit); };
    this->Find({ at(0), at(1), at(2) }, count);
    this->Filled -= count;
    hn::StoreU(hn::LoadU(di, this->Index + Lanes), di, this->Index);
    for (auto& fixed : this->Fixed)
    {
      hn::StoreU(hn::LoadU(di, fixed + Lanes), di, fixed);
    }
  }

  void FindFloat(int count)
  {
    const D d;
    if (count > 0)
    {
      this->Find({ hn::LoadU(d, this->Float[0]), hn::LoadU(d, this->Float[1]),
                   hn::LoadU(d, this->Float[2]) },
        count);
      this->Filled = 0;
    }
  }

  HWY_INLINE void Find(const Triple& position, int count)
  {
    const D d;
    Triple place;
    const CellPlaces places(*this->Cell);
    const auto found =
      hn::And(places.Find(position, place), hn::FirstN(d, static_cast<std::size_t>(count)));
    std::uint64_t bits = 0;
    hn::StoreMaskBits(d, found, reinterpret_cast<std::uint8_t*>(&bits));
    this->Put(places.At(this->Cell->Value, place), bits, this->Job.Slab.Value);
    if (this->Job.Shading)
    {
      const VF cosine = CosineOf(*this->Job.Shading, places.At(this->Cell->Gradient[0], place),
        places.At(this->Cell->Gradient[1], place), places.At(this->Cell->Gradient[2], place),
        this->DirectionsOfSlots());
      this->Put(cosine, bits, this->Job.Slab.Cosine);
    }
  }

  HWY_INLINE void Put(VF numbers, std::uint64_t lanes, float* to) const
  {
    alignas(64) float values[RayTile::PacketSize];
    hn::Store(numbers, D(), values);
    for (; lanes != 0; lanes &= lanes - 1)
    {
      const int lane = __builtin_ctzll(lanes);
      to[this->Index[lane]] = values[lane];
    }
  }

  /// Of the rays whose samples wait.
  HWY_INLINE Direction DirectionsOfSlots() const
  {
    const D d;
    const DI di;
    static_assert(SampleSlab::Rows * SampleSlab::Lanes == 1 << 10, "packets have 2^10 samples");
    const VI index = hn::LoadU(di, this->Index);
    const VI slot = hn::Or(hn::ShiftLeft<4>(hn::ShiftRight<10>(index)),
      hn::And(index, hn::Set(di, SampleSlab::Lanes - 1)));
    return { hn::GatherIndex(d, this->Job.Rays.Direction[0], slot),
      hn::GatherIndex(d, this->Job.Rays.Direction[1], slot),
      hn::GatherIndex(d, this->Job.Rays.Direction[2], slot) };
  }

  const SlabJob& Job;
  const CellSetup* Cell = nullptr;
  double Row = 0.0; ///< whole
  double FirstRow = 0.0;
  double LastRow = 0.0;
  std::uint32_t MiddleLow[3] = {};
  // Samples that wait: a vector of them at most, and one more that may come at once.
  int Filled = 0;
  alignas(64) std::int32_t Index[3 * RayTile::PacketSize] = {};
  alignas(64) std::int32_t Fixed[3][3 * RayTile::PacketSize] = {};
  alignas(64) float Float[3][RayTile::PacketSize] = {};
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
