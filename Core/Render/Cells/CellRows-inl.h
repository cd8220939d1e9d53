// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see CellKernels.cxx.
#if defined(banyan_Render_Cells_CellRows_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Render_Cells_CellRows_inl_h
#undef banyan_Render_Cells_CellRows_inl_h
#else
#define banyan_Render_Cells_CellRows_inl_h
#endif

#include "Render/Cells/CellPlaces-inl.h"
#include "Render/Cells/CellTile.h"

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

/// Finds the rows of a slab in which rays may be in a cell: none too few, and few too many.
class CellRows
{
public:
  explicit CellRows(const SlabJob& job)
    : Job(job)
  {
    this->Place();
  }

  /// Takes a cell. Its bounds get some slack for rounding: a few units of the last place of the
  /// largest number on the way.
  void Begin(const CellSetup& cell)
  {
    this->Cell = &cell;
    float largest = this->Farthest;
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Middle[axis] = static_cast<float>(
        (cell.Middle[axis] - this->Origin[axis]) / (1 << FractionBits) + cell.Base[axis]);
      largest = std::max(largest, std::abs(this->Middle[axis]));
    }
    const float error = largest * (1.0f / (1 << 20));
    float sum = 0.0f;
    for (int i = 0; i < 3; ++i)
    {
      const float(&inverse)[3] = cell.Inverse[i];
      const float slack =
        error * (std::abs(inverse[0]) + std::abs(inverse[1]) + std::abs(inverse[2]));
      this->Low[i] = cell.Low[i] - slack;
      this->High[i] = cell.High[i] + slack;
      sum += slack;
    }
    this->HighSum = cell.HighSum + sum;
  }

  /// Rows of the slab in which whole samples of rays may be in the cell, from its first row on.
  HWY_INLINE void Inside(int slot, VI& first, VI& last) const
  {
    const D d;
    const DI di;
    const CellSetup& cell = *this->Cell;
    const auto load = [&](const float* numbers) HWY_ATTR { return hn::Load(d, numbers + slot); };
    const Triple from{ hn::Sub(load(this->At[0]), hn::Set(d, this->Middle[0])),
      hn::Sub(load(this->At[1]), hn::Set(d, this->Middle[1])),
      hn::Sub(load(this->At[2]), hn::Set(d, this->Middle[2])) };
    const Triple step{ load(this->Job.Rows.Step[0]), load(this->Job.Rows.Step[1]),
      load(this->Job.Rows.Step[2]) };
    const VI none = hn::Set(di, this->Job.FirstRow);
    const VI begin = hn::Sub(hn::Load(di, this->Job.Rows.First + slot), none);
    const VI end = hn::Sub(hn::Load(di, this->Job.Rows.End + slot), none);
    first = hn::Max(begin, hn::Zero(di));
    last = hn::Sub(hn::Min(end, hn::Set(di, SampleSlab::Rows)), hn::Set(di, 1));
    // In rows from the middle one on.
    const VF toRow = hn::Set(d, static_cast<float>(MiddleRow));
    VF enter = hn::Sub(hn::ConvertTo(d, first), toRow);
    VF leave = hn::Sub(hn::ConvertTo(d, last), toRow);
    VF sumAt = hn::Zero(d);
    VF sumAlong = hn::Zero(d);
    const bool tetrahedron = cell.Shape == CellShape::Tetrahedron;
    for (int i = 0; i < 3; ++i)
    {
      const Triple inverse = InAllLanes(cell.Inverse[i]);
      const VF at = DotOf(inverse, from);
      const VF along = DotOf(inverse, step);
      Clip(at, along, hn::Set(d, this->Low[i]), hn::Set(d, this->High[i]), enter, leave);
      if (i < 2 || tetrahedron)
      {
        sumAt = hn::Add(sumAt, at);
        sumAlong = hn::Add(sumAlong, along);
      }
    }
    if (cell.HasSum)
    {
      Clip(sumAt, sumAlong, hn::Set(d, -1e30f), hn::Set(d, this->HighSum), enter, leave);
    }
    const VF little = hn::Set(d, 0.03f);
    const auto some = hn::Le(enter, hn::Add(leave, little));
    const VI low = hn::ConvertTo(di, hn::Add(hn::Ceil(hn::Sub(enter, little)), toRow));
    const VI high = hn::ConvertTo(di, hn::Add(hn::Floor(hn::Add(leave, little)), toRow));
    first =
      hn::Max(first, hn::IfThenElse(hn::RebindMask(di, some), low, hn::Set(di, SampleSlab::Rows)));
    last = hn::Min(last, high);
  }

private:
  static constexpr int MiddleRow = SampleSlab::Rows / 2;

  /// Places the rays in the middle of the slab, in cells from a point in the tile on. In float:
  /// rows that may be inside are looked for with it, and some slack.
  void Place()
  {
    const TileRows& rows = this->Job.Rows;
    const double row = this->Job.FirstRow + MiddleRow;
    int used = 0;
    while (used < RayTile::Slots && rows.First[used] >= rows.End[used])
    {
      ++used;
    }
    for (int axis = 0; axis < 3 && used < RayTile::Slots; ++axis)
    {
      this->Origin[axis] = rows.Zero[axis][used] + row * this->Job.Rays.WholeStep[axis][used];
    }
    const D d;
    const DI di;
    constexpr int lanes = static_cast<int>(hn::MaxLanes(D()));
    VF farthest = hn::Zero(d);
    for (int slot = 0; slot < RayTile::Slots; slot += lanes)
    {
      const auto has =
        hn::RebindMask(d, hn::Lt(hn::Load(di, rows.First + slot), hn::Load(di, rows.End + slot)));
      const RayLanes rays = RaysAt(this->Job, slot, row, this->Origin);
      const auto take = [&](int axis, VF at, VF step) HWY_ATTR
      {
        at = hn::IfThenElseZero(has, at);
        hn::Store(at, d, this->At[axis] + slot);
        const VF inSlab = hn::Mul(hn::Set(d, static_cast<float>(MiddleRow)), hn::Abs(step));
        farthest = hn::Max(farthest, hn::IfThenElseZero(has, hn::Add(hn::Abs(at), inSlab)));
      };
      take(0, rays.At.X, rays.Step.X);
      take(1, rays.At.Y, rays.Step.Y);
      take(2, rays.At.Z, rays.Step.Z);
    }
    alignas(64) float ofLanes[lanes];
    hn::Store(farthest, d, ofLanes);
    this->Farthest = *std::max_element(ofLanes, ofLanes + lanes);
  }

  /// Narrows where low <= at + n * along <= high.
  static HWY_INLINE void Clip(VF at, VF along, VF low, VF high, VF& enter, VF& leave)
  {
    const D d;
    const VF least = hn::Set(d, 1e-30f);
    const VF safe = hn::IfThenElse(hn::Lt(hn::Abs(along), least), least, along);
    // About is enough: rows are rounded outwards.
    const VF inverse = hn::ApproximateReciprocal(safe);
    const VF a = hn::Mul(hn::Sub(low, at), inverse);
    const VF b = hn::Mul(hn::Sub(high, at), inverse);
    enter = hn::Max(enter, hn::Min(a, b));
    leave = hn::Min(leave, hn::Max(a, b));
  }

  // The rays, from Origin on.
  alignas(64) float At[3][RayTile::Slots];
  double Origin[3] = {}; ///< fixed-point
  const SlabJob& Job;
  const CellSetup* Cell = nullptr;
  float Farthest = 0.0f; ///< of the rays' positions in the slab, along any axis
  // The cell.
  float Middle[3] = {}; ///< from Origin to CellSetup::Base
  float Low[3] = {};
  float High[3] = {};
  float HighSum = 0.0f;
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
