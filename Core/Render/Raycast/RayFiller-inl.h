// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see RayTile.cxx.
#if defined(banyan_Render_Raycast_RayFiller_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Render_Raycast_RayFiller_inl_h
#undef banyan_Render_Raycast_RayFiller_inl_h
#else
#define banyan_Render_Raycast_RayFiller_inl_h
#endif

#include "Render/Raycast/RayTile.h"

#include <hwy/highway.h>

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

namespace hn = hwy::HWY_NAMESPACE;

using DD = hn::CappedTag<double, RayTile::PacketSize>;
using DHalf = hn::Rebind<std::int32_t, DD>;
using DFloat = hn::Rebind<float, DD>;
using VD = hn::Vec<DD>;

/// Makes the samples of as many rays at a time as a vector has lanes: RayLattice::SamplesOf, step
/// by step. Divisions and roots are those of IEEE and nothing is fused, so all targets agree.
class RayFiller
{
public:
  RayFiller(const RayLattice& lattice, RayTile& tile)
    : Setup(lattice.Setup())
    , Tile(tile)
  {
  }

  /// @param x, y pixels of the lanes
  /// @param end upper bound of t per lane: the geometry
  /// @param active not 0 for lanes that want a ray
  /// @return false when a lane's sample distance is too small for its distance
  HWY_INLINE bool Fill(
    int slot, const double* x, const double* y, const double* end, const double* active)
  {
    const DD d;
    auto alive = hn::Ne(hn::Load(d, active), hn::Zero(d));
    if (hn::AllFalse(d, alive))
    {
      this->StoreNothing(slot);
      return true;
    }
    this->MakeRay(hn::Load(d, x), hn::Load(d, y));
    VD enter = this->Near;
    VD exit = hn::Min(this->Far, hn::Load(d, end));
    this->Clip(enter, exit, alive);
    this->ClipToPlanes(enter, exit, alive);
    alive = hn::And(alive, hn::Lt(enter, exit));
    if (hn::AllFalse(d, alive))
    {
      this->StoreNothing(slot);
      return true;
    }
    const VD distance = hn::Set(d, this->Setup.Distance);
    const VD perDistance = hn::Set(d, this->Setup.PerDistance);
    const VD farthest = hn::Mul(hn::Max(hn::Abs(enter), hn::Abs(exit)), perDistance);
    if (!hn::AllFalse(
          d, hn::And(alive, hn::Gt(farthest, hn::Set(d, RayLattice::LargestSampleNumber)))))
    {
      return false;
    }
    // Lanes without a ray must not carry numbers that no integer can hold.
    enter = hn::IfThenElseZero(alive, enter);
    exit = hn::IfThenElseZero(alive, exit);
    const VD first = hn::Ceil(hn::Mul(enter, perDistance));
    const VD last = hn::Floor(hn::Mul(exit, perDistance));
    const auto whole = hn::And(alive, hn::Le(first, last));
    this->StoreEnd(
      slot, enter, hn::IfThenElse(whole, hn::Mul(first, distance), exit), alive, this->Tile.Head);
    this->StoreEnd(slot, hn::Mul(last, distance), exit, whole, this->Tile.Tail);
    const VD count = hn::IfThenElseZero(whole, hn::Sub(last, first));
    hn::Store(hn::DemoteTo(DHalf(), count), DHalf(), this->Tile.Count + slot);
    this->StoreWhole(slot, first, count, alive);
    hn::Store(first, d, this->Tile.Number + slot);
    for (int axis = 0; axis < 3; ++axis)
    {
      const VD scaled = hn::Mul(this->Direction[axis], this->Set(this->Setup.ShadingScale));
      hn::Store(hn::DemoteTo(DFloat(), scaled), DFloat(), this->Tile.Direction[axis] + slot);
    }
    return true;
  }

private:
  HWY_INLINE VD Set(double value) const { return hn::Set(DD(), value); }

  HWY_INLINE VD Dot(const VD (&a)[3], const VD (&b)[3]) const
  {
    return hn::Add(hn::Add(hn::Mul(a[0], b[0]), hn::Mul(a[1], b[1])), hn::Mul(a[2], b[2]));
  }

  /// As RayCamera::RayOf, in index space in the end.
  HWY_INLINE void MakeRay(VD x, VD y)
  {
    const VD one = this->Set(1.0);
    const VD two = this->Set(2.0);
    const VD u =
      hn::Sub(hn::Mul(hn::Add(hn::Mul(two, x), one), this->Set(this->Setup.PerPixel.x)), one);
    const VD v =
      hn::Sub(hn::Mul(hn::Add(hn::Mul(two, y), one), this->Set(this->Setup.PerPixel.y)), one);
    VD middle[4];
    VD apex[4];
    for (int i = 0; i < 4; ++i)
    {
      middle[i] = hn::Add(hn::Add(hn::Mul(this->Set(this->Setup.ClipToWorld[0][i]), u),
                            hn::Mul(this->Set(this->Setup.ClipToWorld[1][i]), v)),
        this->Set(this->Setup.ClipToWorld[3][i]));
      apex[i] = this->Set(this->Setup.ClipToWorld[2][i]);
    }
    const VD perNear = hn::Div(one, hn::Sub(middle[3], apex[3]));
    const VD farWeight = hn::Add(middle[3], apex[3]);
    const VD perFar = hn::Div(one, farWeight);
    VD nearPoint[3];
    VD direction[3];
    VD toNear[3];
    VD origin[3];
    for (int i = 0; i < 3; ++i)
    {
      nearPoint[i] = hn::Mul(hn::Sub(middle[i], apex[i]), perNear);
      direction[i] = this->Setup.Parallel
                       ? this->Set(this->Setup.Forward[i])
                       : hn::Sub(hn::Mul(apex[i], middle[3]), hn::Mul(middle[i], apex[3]));
      toNear[i] = hn::Sub(
        nearPoint[i], this->Set(this->Setup.Parallel ? this->Setup.Anchor[i] : this->Setup.Eye[i]));
    }
    if (!this->Setup.Parallel)
    {
      const VD scale = hn::Div(one, hn::Sqrt(this->Dot(direction, direction)));
      for (VD& component : direction)
      {
        component = hn::Mul(component, scale);
      }
    }
    this->Near = this->Dot(toNear, direction);
    VD toFar[3];
    for (int i = 0; i < 3; ++i)
    {
      origin[i] = this->Setup.Parallel ? hn::Sub(nearPoint[i], hn::Mul(direction[i], this->Near))
                                       : this->Set(this->Setup.Eye[i]);
      toFar[i] = hn::Sub(hn::Mul(hn::Add(middle[i], apex[i]), perFar), origin[i]);
    }
    this->Far = hn::IfThenElse(hn::Gt(farWeight, hn::Zero(DD())), this->Dot(toFar, direction),
      this->Set(std::numeric_limits<double>::infinity()));
    this->ToIndexSpace(origin, direction);
  }

  HWY_INLINE void ToIndexSpace(const VD (&origin)[3], const VD (&direction)[3])
  {
    const glm::dmat4& m = this->Setup.WorldToIndex;
    for (int i = 0; i < 3; ++i)
    {
      const VD x = this->Set(m[0][i]);
      const VD y = this->Set(m[1][i]);
      const VD z = this->Set(m[2][i]);
      this->Origin[i] = hn::Add(hn::Add(hn::Mul(x, origin[0]), hn::Mul(y, origin[1])),
        hn::Add(hn::Mul(z, origin[2]), this->Set(m[3][i])));
      this->Direction[i] = hn::Add(
        hn::Add(hn::Mul(x, direction[0]), hn::Mul(y, direction[1])), hn::Mul(z, direction[2]));
    }
  }

  HWY_INLINE void Clip(VD& enter, VD& exit, hn::Mask<DD>& alive) const
  {
    const VD infinity = this->Set(std::numeric_limits<double>::infinity());
    for (int axis = 0; axis < 3; ++axis)
    {
      const VD low = this->Set(this->Setup.Low[axis]);
      const VD high = this->Set(this->Setup.High[axis]);
      const VD origin = this->Origin[axis];
      const auto along = hn::Lt(hn::Abs(this->Direction[axis]), this->Set(RayLattice::AlongFaces));
      const auto inside = hn::And(hn::Ge(origin, low), hn::Le(origin, high));
      const VD inverse = hn::Div(this->Set(1.0), this->Direction[axis]);
      const VD a = hn::Mul(hn::Sub(low, origin), inverse);
      const VD b = hn::Mul(hn::Sub(high, origin), inverse);
      enter = hn::Max(enter, hn::IfThenElse(along, hn::Neg(infinity), hn::Min(a, b)));
      exit = hn::Min(exit, hn::IfThenElse(along, infinity, hn::Max(a, b)));
      alive = hn::And(alive, hn::Or(hn::Not(along), inside));
    }
  }

  HWY_INLINE void ClipToPlanes(VD& enter, VD& exit, hn::Mask<DD>& alive) const
  {
    const DD d;
    const VD infinity = this->Set(std::numeric_limits<double>::infinity());
    const VD zero = hn::Zero(d);
    for (std::size_t i = 0; i < this->Setup.PlaneCount; ++i)
    {
      const glm::dvec4& plane = this->Setup.Planes[i];
      const VD normal[3] = { this->Set(plane.x), this->Set(plane.y), this->Set(plane.z) };
      const VD along = this->Dot(normal, this->Direction);
      const VD above = hn::Add(this->Dot(normal, this->Origin), this->Set(plane.w));
      const VD t = hn::Div(hn::Neg(above), along);
      enter = hn::Max(enter, hn::IfThenElse(hn::Gt(along, zero), t, hn::Neg(infinity)));
      exit = hn::Min(exit, hn::IfThenElse(hn::Lt(along, zero), t, infinity));
      const auto beside = hn::And(hn::Eq(along, zero), hn::Lt(above, zero));
      alive = hn::AndNot(beside, alive);
    }
  }

  /// Position of a sample: a whole number of fixed-point units.
  HWY_INLINE VD Fixed(VD t, int axis) const
  {
    const VD low = this->Set(this->Setup.Low[axis]);
    const VD high = this->Set(this->Setup.High[axis]);
    const VD position = hn::Add(this->Origin[axis], hn::Mul(this->Direction[axis], t));
    const VD inside = hn::Min(hn::Max(position, low), high);
    return hn::Min(hn::Floor(hn::Mul(inside, this->Set(Unit))), this->Highest(axis));
  }

  HWY_INLINE VD Lowest(int axis) const
  {
    return this->Set(std::ceil(this->Setup.Low[axis] * Unit));
  }
  HWY_INLINE VD Highest(int axis) const
  {
    return this->Set(std::ceil(this->Setup.High[axis] * Unit) - 1.0);
  }

  /// Splits fixed-point numbers into cells and positions modulo 256 cells.
  HWY_INLINE void StoreFixed(VD fixed, std::int32_t* cells, std::uint32_t* positions) const
  {
    const DHalf half;
    const VD cell = hn::Floor(hn::Mul(fixed, this->Set(1.0 / Unit)));
    const auto fraction = hn::DemoteTo(half, hn::Sub(fixed, hn::Mul(cell, this->Set(Unit))));
    const auto whole = hn::DemoteTo(half, cell);
    const auto position = hn::Or(hn::ShiftLeft<FractionBits>(whole), fraction);
    if (cells)
    {
      hn::Store(whole, half, cells);
    }
    hn::Store(position, half, reinterpret_cast<std::int32_t*>(positions));
  }

  HWY_INLINE void StoreEnd(
    int slot, VD enter, VD exit, hn::Mask<DD> exists, RayTile::Ends& ends) const
  {
    const DD d;
    const VD fraction = hn::Mul(hn::Sub(exit, enter), this->Set(this->Setup.PerDistance));
    exists = hn::And(exists, hn::Gt(fraction, hn::Zero(d)));
    const VD kept = hn::IfThenElseZero(exists, hn::Min(fraction, this->Set(1.0)));
    hn::Store(hn::DemoteTo(DFloat(), kept), DFloat(), ends.Fraction + slot);
    const VD middle = hn::Mul(this->Set(0.5), hn::Add(enter, exit));
    for (int axis = 0; axis < 3; ++axis)
    {
      this->StoreFixed(
        this->Fixed(middle, axis), ends.Cell[axis] + slot, ends.Position[axis] + slot);
    }
  }

  HWY_INLINE void StoreWhole(int slot, VD first, VD count, hn::Mask<DD> alive)
  {
    const DD d;
    const VD infinity = this->Set(std::numeric_limits<double>::infinity());
    const VD distance = this->Set(this->Setup.Distance);
    const VD half = this->Set(0.5);
    const VD steps = hn::Sub(count, this->Set(1.0));
    const auto some = hn::Gt(count, hn::Zero(d));
    const VD longest = this->Set(RayTile::LongestStep * Unit / this->Setup.SmallestPerCell);
    for (int axis = 0; axis < 3; ++axis)
    {
      const VD base = this->Fixed(hn::Mul(hn::Add(first, half), distance), axis);
      VD step = hn::Mul(hn::Mul(this->Direction[axis], distance), this->Set(Unit));
      step = hn::Floor(hn::Add(hn::IfThenElseZero(some, step), half));
      // Keeps the last sample inside the domain too, whatever was rounded on the way.
      const VD end = hn::Add(base, hn::Mul(steps, step));
      const VD inside = hn::Min(hn::Max(end, this->Lowest(axis)), this->Highest(axis));
      const auto bent = hn::And(hn::Gt(steps, hn::Zero(d)), hn::Ne(end, inside));
      if (!hn::AllFalse(d, bent))
      {
        step = hn::IfThenElse(bent, hn::Trunc(hn::Div(hn::Sub(inside, base), steps)), step);
      }
      this->StoreFixed(base, nullptr, this->Tile.Base[axis] + slot);
      this->StoreFixed(step, nullptr, this->Tile.Step[axis] + slot);
      hn::Store(step, d, this->Tile.WholeStep[axis] + slot);
      this->Tile.PacketsFit &= hn::AllTrue(d, hn::Le(hn::Abs(step), longest));
      // Where a ray runs along a face, distances to faces are infinite, with the right sign: no
      // product of 0 and infinity. Rays of a head or tail alone always count as near; empty ones
      // never.
      const auto along = hn::Eq(step, hn::Zero(d));
      const VD cell = hn::Mul(base, this->Set(1.0 / Unit));
      const VD offset = hn::IfThenElseZero(along, this->Set(0.25 / Unit));
      const VD inverse = hn::IfThenElse(along, infinity, hn::Div(this->Set(Unit), step));
      const VD start =
        hn::IfThenElse(alive, hn::IfThenElseZero(some, hn::Add(cell, offset)), this->Set(FarAway));
      hn::Store(start, d, this->Tile.Start[axis] + slot);
      hn::Store(hn::IfThenElse(alive, hn::IfThenElseZero(some, inverse), infinity), d,
        this->Tile.Inverse[axis] + slot);
    }
  }

  HWY_INLINE void StoreNothing(int slot)
  {
    const DD d;
    for (int axis = 0; axis < 3; ++axis)
    {
      hn::Store(this->Set(FarAway), d, this->Tile.Start[axis] + slot);
      hn::Store(
        this->Set(std::numeric_limits<double>::infinity()), d, this->Tile.Inverse[axis] + slot);
    }
    hn::Store(hn::Zero(DHalf()), DHalf(), this->Tile.Count + slot);
    hn::Store(hn::Zero(DFloat()), DFloat(), this->Tile.Head.Fraction + slot);
    hn::Store(hn::Zero(DFloat()), DFloat(), this->Tile.Tail.Fraction + slot);
  }

  static constexpr double Unit = 1 << FractionBits;
  static constexpr double FarAway = -1e9;

  const LatticeSetup Setup;
  RayTile& Tile;
  VD Origin[3];
  VD Direction[3];
  VD Near;
  VD Far;
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
