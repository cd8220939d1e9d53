// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see CellKernels.cxx.
#if defined(banyan_Render_Cells_CellPackets_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Render_Cells_CellPackets_inl_h
#undef banyan_Render_Cells_CellPackets_inl_h
#else
#define banyan_Render_Cells_CellPackets_inl_h
#endif

#include "Render/Cells/CellPlaces-inl.h"
#include "Render/Cells/CellRows-inl.h"
#include "Render/Cells/CellTile.h"
#include "Render/Cells/RunCollector.h"
#include "Render/Raycast/LightLanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Draws one cell after the other into a slab. Samples that may lie in a cell are collected until
/// they fill a vector, and found in it together.
class CellPackets
{
public:
  explicit CellPackets(const SlabJob& job)
    : Job(job)
    , Rows(job)
  {
  }

  /// Says whose the values of the next cell are, where owners are wanted.
  /// @param place of the cell in the order
  /// @param alone bits of faces that no other cell of the piece has
  void Own(std::uint32_t place, unsigned alone)
  {
    this->Place = place;
    this->Alone = alone;
  }

  /// @param first, last rows of the tile that samples of the cell may be in
  void Draw(const CellSetup& cell, const PixelRect& packets, double first, double last)
  {
    this->Cell = &cell;
    this->FirstRow = std::max(first, static_cast<double>(this->Job.FirstRow));
    this->LastRow = std::min(last, static_cast<double>(this->Job.FirstRow + SampleSlab::Rows - 1));
    this->RowMarks = MarksOf(static_cast<int>(this->FirstRow) - this->Job.FirstRow,
      static_cast<int>(this->LastRow) - this->Job.FirstRow);
    this->Rows.Begin(cell);
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
      VI first;
      VI last;
      this->Rows.Inside(slot, first, last);
      const auto some = AtMost(first, last);
      if (!hn::AllFalse(DI(), some))
      {
        this->Collect(packet, slot, first, last);
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

  /// Each ray goes from its first row to its last one.
  HWY_INLINE void Collect(int packet, int slot, VI first, VI last)
  {
    const DI di;
    const DU du;
    const VI one = hn::Set(di, 1);
    this->Job.Slab.Marks[packet] |= this->RowMarks;
    const VI lane = hn::Iota(di, SampleSlab::IndexOf(slot, 0));
    VI row = first;
    auto lanes = AtMost(row, last);
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
      // Stored whole: to compress into memory takes some processors ten times as long.
      hn::StoreU(hn::Compress(index, lanes), di, this->Index + this->Filled);
      for (int axis = 0; axis < 3; ++axis)
      {
        hn::StoreU(hn::Compress(hn::BitCast(di, position[axis]), lanes), di,
          this->Fixed[axis] + this->Filled);
        position[axis] = hn::Add(position[axis], step[axis]);
      }
      this->Filled += static_cast<int>(hn::CountTrue(di, lanes));
      row = hn::Add(row, one);
      lanes = AtMost(row, last);
      if (this->Filled >= 2 * Lanes)
      {
        this->FindFixed(2 * Lanes);
      }
    }
  }

  /// Bits of rows of a slab, both ends included.
  static std::uint64_t MarksOf(int first, int last)
  {
    if (first > last)
    {
      return 0;
    }
    const std::uint64_t upTo =
      last >= SampleSlab::Rows - 1 ? ~std::uint64_t{ 0 } : (std::uint64_t{ 1 } << (last + 1)) - 1;
    return upTo & ~((std::uint64_t{ 1 } << first) - 1);
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
  /// @param count at most two vectors
  void FindFixed(int count)
  {
    const DI di;
    if (count > Lanes)
    {
      this->Find<2>([this](int i, int axis) HWY_ATTR { return this->FixedAt(i, axis); }, count);
    }
    else if (count > 0)
    {
      this->Find<1>([this](int i, int axis) HWY_ATTR { return this->FixedAt(i, axis); }, count);
    }
    this->Filled -= count;
    if (this->Filled > 0)
    {
      hn::StoreU(hn::LoadU(di, this->Index + count), di, this->Index);
      for (auto& fixed : this->Fixed)
      {
        hn::StoreU(hn::LoadU(di, fixed + count), di, fixed);
      }
    }
  }

  HWY_INLINE VF FixedAt(int i, int axis) const
  {
    const VI fixed = hn::LoadU(DI(), this->Fixed[axis] + i * Lanes);
    return hn::Mul(hn::ConvertTo(D(), fixed), hn::Set(D(), 1.0f / (1 << FractionBits)));
  }

  void FindFloat(int count)
  {
    if (count > 0)
    {
      this->Find<1>(
        [this](int, int axis) HWY_ATTR { return hn::LoadU(D(), this->Float[axis]); }, count);
      this->Filled = 0;
    }
  }

  /// @param at gives a vector of positions along an axis
  /// @param count samples, in so many vectors
  template <int vectors, class At>
  HWY_INLINE void Find(At&& at, int count)
  {
    const D d;
    const CellPlaces places(*this->Cell);
    Triple positions[vectors];
    Triple found[vectors];
    hn::Mask<D> inside[vectors];
    for (int i = 0; i < vectors; ++i)
    {
      positions[i] = { at(i, 0), at(i, 1), at(i, 2) };
    }
    places.Find(positions, found, inside);
    for (int i = 0; i < vectors; ++i)
    {
      const auto rest = static_cast<std::size_t>(count - i * Lanes);
      const auto lanes = hn::And(inside[i], hn::FirstN(d, std::min<std::size_t>(rest, Lanes)));
      std::uint64_t bits = 0;
      hn::StoreMaskBits(d, lanes, reinterpret_cast<std::uint8_t*>(&bits));
      const std::int32_t* const indices = this->Index + i * Lanes;
      Put(places.At(this->Cell->Value, found[i]), bits, indices, this->Job.Slab.Value);
      if (this->Job.Owners)
      {
        std::uint64_t near = 0;
        hn::StoreMaskBits(
          d, places.AreNear(this->Alone, found[i]), reinterpret_cast<std::uint8_t*>(&near));
        this->PutOwners(bits, near, indices);
      }
      if (this->Job.Shading)
      {
        const auto gradient = [&](int axis) HWY_ATTR
        { return places.At(this->Cell->Gradient[axis], found[i]); };
        const VF cosine = CosineOf(
          *this->Job.Shading, gradient(0), gradient(1), gradient(2), this->DirectionsAt(indices));
        Put(cosine, bits, indices, this->Job.Slab.Cosine);
      }
    }
  }

  static HWY_INLINE void Put(
    VF numbers, std::uint64_t lanes, const std::int32_t* indices, float* to)
  {
    alignas(64) float values[RayTile::PacketSize];
    hn::Store(numbers, D(), values);
    for (; lanes != 0; lanes &= lanes - 1)
    {
      const int lane = __builtin_ctzll(lanes);
      to[indices[lane]] = values[lane];
    }
  }

  /// @param near those of the lanes whose samples other ranks' cells may hold
  HWY_INLINE void PutOwners(std::uint64_t lanes, std::uint64_t near, const std::int32_t* indices)
  {
    for (; lanes != 0; lanes &= lanes - 1)
    {
      const int lane = __builtin_ctzll(lanes);
      this->Job.Owners->Of[indices[lane]] =
        this->Place | ((near >> lane & 1) != 0 ? SlabOwners::Contested : 0);
    }
  }

  /// Of the rays of samples in the slab.
  HWY_INLINE Direction DirectionsAt(const std::int32_t* indices) const
  {
    const D d;
    const DI di;
    static_assert(SampleSlab::Rows * SampleSlab::Lanes == 1 << 10, "packets have 2^10 samples");
    const VI index = hn::LoadU(di, indices);
    const VI slot = hn::Or(hn::ShiftLeft<4>(hn::ShiftRight<10>(index)),
      hn::And(index, hn::Set(di, SampleSlab::Lanes - 1)));
    return { hn::GatherIndex(d, this->Job.Rays.Direction[0], slot),
      hn::GatherIndex(d, this->Job.Rays.Direction[1], slot),
      hn::GatherIndex(d, this->Job.Rays.Direction[2], slot) };
  }

  // Samples that wait: less than two vectors of them, and one more that may come at once.
  alignas(64) std::int32_t Index[3 * RayTile::PacketSize] = {};
  alignas(64) std::int32_t Fixed[3][3 * RayTile::PacketSize] = {};
  alignas(64) float Float[3][RayTile::PacketSize] = {};
  int Filled = 0;
  std::uint32_t MiddleLow[3] = {};
  const CellSetup* Cell = nullptr;
  std::uint32_t Place = 0;
  unsigned Alone = 0;
  std::uint64_t RowMarks = 0; ///< of rows that the cell may have samples in
  double FirstRow = 0.0;
  double LastRow = 0.0;
  const SlabJob& Job;
  CellRows Rows;
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
