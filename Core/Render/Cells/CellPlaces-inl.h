// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see CellKernels.cxx.
#if defined(banyan_Render_Cells_CellPlaces_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Render_Cells_CellPlaces_inl_h
#undef banyan_Render_Cells_CellPlaces_inl_h
#else
#define banyan_Render_Cells_CellPlaces_inl_h
#endif

#include "Render/Bricks/PacketVectors-inl.h"
#include "Render/Cells/CellSetup.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// A point, a direction or a place per lane.
struct Triple
{
  VF X;
  VF Y;
  VF Z;
};

// No fused operations: all targets give the same bits.
HWY_INLINE VF DotOf(const Triple& a, const Triple& b)
{
  return hn::Add(hn::Add(hn::Mul(a.X, b.X), hn::Mul(a.Y, b.Y)), hn::Mul(a.Z, b.Z));
}

HWY_INLINE Triple CrossOf(const Triple& a, const Triple& b)
{
  return { hn::Sub(hn::Mul(a.Y, b.Z), hn::Mul(a.Z, b.Y)),
    hn::Sub(hn::Mul(a.Z, b.X), hn::Mul(a.X, b.Z)), hn::Sub(hn::Mul(a.X, b.Y), hn::Mul(a.Y, b.X)) };
}

HWY_INLINE Triple Minus(const Triple& a, const Triple& b)
{
  return { hn::Sub(a.X, b.X), hn::Sub(a.Y, b.Y), hn::Sub(a.Z, b.Z) };
}

HWY_INLINE Triple Plus(const Triple& a, const Triple& b)
{
  return { hn::Add(a.X, b.X), hn::Add(a.Y, b.Y), hn::Add(a.Z, b.Z) };
}

HWY_INLINE Triple Times(const Triple& a, VF factor)
{
  return { hn::Mul(a.X, factor), hn::Mul(a.Y, factor), hn::Mul(a.Z, factor) };
}

HWY_INLINE Triple InAllLanes(const float (&v)[3])
{
  const D d;
  return { hn::Set(d, v[0]), hn::Set(d, v[1]), hn::Set(d, v[2]) };
}

/// Finds places of positions in one cell, and what fields are there.
class CellPlaces
{
public:
  static constexpr int MostSteps = 8;

  explicit CellPlaces(const CellSetup& cell)
    : Cell(cell)
  {
  }

  /// Finds places of several vectors of positions: while one waits for a division, another goes on.
  /// @param positions from the cell's middle on
  /// @param places set in lanes that are inside
  /// @param inside lanes that are
  template <int count>
  HWY_INLINE void Find(
    const Triple (&positions)[count], Triple (&places)[count], hn::Mask<D> (&inside)[count]) const
  {
    for (int i = 0; i < count; ++i)
    {
      places[i] = this->LinearPlace(positions[i]);
    }
    switch (this->Cell.Shape)
    {
      case CellShape::Tetrahedron:
        for (int i = 0; i < count; ++i)
        {
          inside[i] = this->InTetrahedron(places[i]);
        }
        break;
      case CellShape::Wedge:
        this->Refine<CellShape::Wedge>(positions, places, inside);
        break;
      case CellShape::Pyramid:
        this->Refine<CellShape::Pyramid>(positions, places, inside);
        break;
      default:
        this->Refine<CellShape::Hexahedron>(positions, places, inside);
    }
  }

  /// A field at places.
  HWY_INLINE VF At(const CellTerms& terms, const Triple& p) const
  {
    const VF linear = hn::Add(Set(terms.Base), DotOf(InAllLanes(terms.Linear), p));
    switch (this->Cell.Shape)
    {
      case CellShape::Tetrahedron:
        return linear;
      case CellShape::Wedge:
        return hn::Add(linear, hn::Mul(p.Z, hn::Add(hn::Mul(p.X, Set(terms.Bent[0])),
                                              hn::Mul(p.Y, Set(terms.Bent[1])))));
      case CellShape::Pyramid:
        return hn::Add(
          linear, hn::Mul(hn::Mul(p.X, hn::Div(p.Y, HeightAt(p))), Set(terms.Bent[0])));
      default:
      {
        const VF st = hn::Mul(p.Y, p.Z);
        const VF r =
          hn::Add(hn::Add(hn::Mul(p.Y, Set(terms.Bent[0])), hn::Mul(p.Z, Set(terms.Bent[2]))),
            hn::Mul(st, Set(terms.Bent[3])));
        return hn::Add(linear, hn::Add(hn::Mul(p.X, r), hn::Mul(st, Set(terms.Bent[1]))));
      }
    }
  }

  /// Lanes with places inside the cell that are nearer than `NearFace` to one of some faces.
  /// @param faces bits, by the numbers of FacesOf
  HWY_INLINE hn::Mask<D> AreNear(unsigned faces, const Triple& p) const
  {
    VF nearest = Set(NearFace);
    for (; faces != 0; faces &= faces - 1)
    {
      nearest = hn::Min(nearest, this->DistanceFrom(__builtin_ctz(faces), p));
    }
    return hn::Lt(nearest, Set(NearFace));
  }
  /// Of places: more than those beyond a face of the same size that belong to the other cell.
  static constexpr float NearFace = 1.0f / (1 << 10);

private:
  /// How far a place is inside of a face, in places.
  HWY_INLINE VF DistanceFrom(int face, const Triple& p) const
  {
    const VF one = Set(1.0f);
    const auto rest = [&](VF sum) HWY_ATTR { return hn::Sub(one, sum); };
    switch (this->Cell.Shape)
    {
      case CellShape::Tetrahedron:
      {
        const VF far = rest(hn::Add(hn::Add(p.X, p.Y), p.Z));
        return face == 0 ? p.Z : face == 1 ? p.Y : face == 2 ? far : p.X;
      }
      case CellShape::Wedge:
        return face == 0   ? hn::Add(one, p.Z)
               : face == 1 ? rest(p.Z)
               : face == 2 ? p.Y
               : face == 3 ? rest(hn::Add(p.X, p.Y))
                           : p.X;
      case CellShape::Pyramid:
        return face == 0   ? rest(p.Z)
               : face == 1 ? hn::Add(p.Z, p.Y)
               : face == 2 ? hn::Sub(p.Z, p.X)
               : face == 3 ? hn::Sub(p.Z, p.Y)
                           : hn::Add(p.Z, p.X);
      default:
      {
        const VF along = face / 2 == 0 ? p.X : face / 2 == 1 ? p.Y : p.Z;
        return face % 2 == 0 ? hn::Add(one, along) : rest(along);
      }
    }
  }

  static HWY_INLINE VF Set(float value) { return hn::Set(D(), value); }
  /// Lanes in which a number is at least, or at most, what the cell has along an axis.
  HWY_INLINE hn::Mask<D> IsFrom(VF x, int axis) const
  {
    return hn::Ge(x, Set(this->Cell.Least[axis]));
  }
  HWY_INLINE hn::Mask<D> IsUpTo(VF x, int axis) const
  {
    return hn::Le(x, Set(this->Cell.Most[axis]));
  }

  HWY_INLINE Triple LinearPlace(const Triple& position) const
  {
    const Triple from = Minus(position, InAllLanes(this->Cell.Base));
    return { DotOf(InAllLanes(this->Cell.Inverse[0]), from),
      DotOf(InAllLanes(this->Cell.Inverse[1]), from),
      DotOf(InAllLanes(this->Cell.Inverse[2]), from) };
  }

  HWY_INLINE hn::Mask<D> InTetrahedron(const Triple& p) const
  {
    const VF sum = hn::Add(hn::Add(p.X, p.Y), p.Z);
    return hn::And(hn::And(this->IsFrom(p.X, 0), this->IsFrom(p.Y, 1)),
      hn::And(this->IsFrom(p.Z, 2), hn::Le(sum, Set(this->Cell.MostSum))));
  }

  HWY_INLINE hn::Mask<D> InWedge(const Triple& p) const
  {
    const auto within = hn::Le(hn::Add(p.X, p.Y), Set(this->Cell.MostSum));
    return hn::And(hn::And(hn::And(this->IsFrom(p.X, 0), this->IsFrom(p.Y, 1)), within),
      hn::And(this->IsFrom(p.Z, 2), this->IsUpTo(p.Z, 2)));
  }

  HWY_INLINE hn::Mask<D> InPyramid(const Triple& p) const
  {
    const auto between = [&](VF x, int axis) HWY_ATTR
    { return hn::And(this->IsFrom(hn::Add(x, p.Z), axis), this->IsUpTo(hn::Sub(x, p.Z), axis)); };
    return hn::And(hn::And(between(p.X, 0), between(p.Y, 1)),
      hn::And(this->IsFrom(p.Z, 2), this->IsUpTo(p.Z, 2)));
  }

  HWY_INLINE hn::Mask<D> InCube(const Triple& p) const
  {
    return hn::And(hn::And(hn::And(this->IsFrom(p.X, 0), this->IsUpTo(p.X, 0)),
                     hn::And(this->IsFrom(p.Y, 1), this->IsUpTo(p.Y, 1))),
      hn::And(this->IsFrom(p.Z, 2), this->IsUpTo(p.Z, 2)));
  }

  /// Where four triangles end the cell in place of a bilinear face.
  static HWY_INLINE hn::Mask<D> InFan(const FanBound& fan, const Triple& p)
  {
    const D d;
    const VF u = hn::Add(DotOf({ Set(fan.U[0]), Set(fan.U[1]), Set(fan.U[2]) }, p), Set(fan.U[3]));
    const VF v = DotOf(InAllLanes(fan.V), p);
    const VF smaller = hn::Min(hn::Abs(u), hn::Abs(v));
    const VF larger = hn::Max(hn::Abs(u), hn::Abs(v));
    const VF away =
      hn::CopySign(hn::Mul(smaller, hn::Sub(hn::Set(d, 1.0f), larger)), hn::Mul(u, v));
    const VF out = DotOf(InAllLanes(fan.Out), p);
    return hn::Le(hn::Sub(out, hn::Mul(away, Set(fan.Bulge))), Set(fan.Most));
  }

  /// What u v is divided by: h, but not much less than u and v just outside of the apex, where the
  /// bent term would have no bound. 1 in the apex itself.
  static HWY_INLINE VF HeightAt(const Triple& p)
  {
    const D d;
    const VF across = hn::Max(hn::Abs(p.X), hn::Abs(p.Y));
    const VF height = hn::Max(p.Z, hn::Min(hn::Set(d, 1.0f / (1 << 10)), across));
    return hn::IfThenElse(hn::Gt(height, hn::Zero(d)), height, hn::Set(d, 1.0f));
  }

  /// A point of the cell, and how it moves with the place.
  struct Tangent
  {
    Triple At;
    Triple Along[3];
  };

  template <CellShape shape>
  HWY_INLINE Tangent TangentAt(const Triple& p) const
  {
    const CellSetup& c = this->Cell;
    const Triple base = InAllLanes(c.Base);
    const Triple l0 = InAllLanes(c.Linear[0]);
    const Triple l1 = InAllLanes(c.Linear[1]);
    const Triple l2 = InAllLanes(c.Linear[2]);
    const Triple b0 = InAllLanes(c.Bent[0]);
    Tangent result;
    if constexpr (shape == CellShape::Hexahedron)
    {
      const Triple b1 = InAllLanes(c.Bent[1]);
      const Triple b2 = InAllLanes(c.Bent[2]);
      const Triple b3 = InAllLanes(c.Bent[3]);
      const Triple rs = Plus(b0, Times(b3, p.Z));
      const Triple s = Plus(l1, Times(b1, p.Z));
      result.Along[0] = Plus(Plus(l0, Times(rs, p.Y)), Times(b2, p.Z));
      result.Along[1] = Plus(s, Times(rs, p.X));
      result.Along[2] = Plus(Plus(l2, Times(b1, p.Y)), Times(Plus(b2, Times(b3, p.Y)), p.X));
      result.At =
        Plus(Plus(base, Times(result.Along[0], p.X)), Plus(Times(s, p.Y), Times(l2, p.Z)));
    }
    else if constexpr (shape == CellShape::Wedge)
    {
      const Triple b1 = InAllLanes(c.Bent[1]);
      result.Along[0] = Plus(l0, Times(b0, p.Z));
      result.Along[1] = Plus(l1, Times(b1, p.Z));
      result.Along[2] = Plus(l2, Plus(Times(b0, p.X), Times(b1, p.Y)));
      result.At = Plus(
        Plus(base, Times(result.Along[0], p.X)), Plus(Times(result.Along[1], p.Y), Times(l2, p.Z)));
    }
    else
    {
      const VF height = HeightAt(p);
      const VF u = hn::Div(p.X, height);
      const VF v = hn::Div(p.Y, height);
      result.Along[0] = Plus(l0, Times(b0, v));
      result.Along[1] = Plus(l1, Times(b0, u));
      result.Along[2] = Minus(l2, Times(b0, hn::Mul(u, v)));
      result.At =
        Plus(Plus(base, Times(result.Along[0], p.X)), Plus(Times(l1, p.Y), Times(l2, p.Z)));
    }
    return result;
  }

  /// Takes the bent terms where a place seems to be away from it: saves a step of Newton's method,
  /// and takes a fourth of its time.
  template <CellShape shape>
  HWY_INLINE void Straighten(Triple& p) const
  {
    const CellSetup& c = this->Cell;
    if constexpr (shape == CellShape::Hexahedron)
    {
      const VF rs = hn::Mul(p.X, p.Y);
      const VF st = hn::Mul(p.Y, p.Z);
      const Triple two = Plus(Times(InAllLanes(c.Lean[0]), rs), Times(InAllLanes(c.Lean[1]), st));
      const Triple other = Plus(Times(InAllLanes(c.Lean[2]), hn::Mul(p.Z, p.X)),
        Times(InAllLanes(c.Lean[3]), hn::Mul(rs, p.Z)));
      p = Minus(p, Plus(two, other));
    }
    else if constexpr (shape == CellShape::Wedge)
    {
      p = Minus(
        p, Times(Plus(Times(InAllLanes(c.Lean[0]), p.X), Times(InAllLanes(c.Lean[1]), p.Y)), p.Z));
    }
    else
    {
      p = Minus(p, Times(InAllLanes(c.Lean[0]), hn::Mul(p.X, hn::Div(p.Y, HeightAt(p)))));
    }
  }

  template <CellShape shape>
  HWY_INLINE hn::Mask<D> Inside(const Triple& place) const
  {
    if constexpr (shape == CellShape::Wedge)
    {
      return this->InWedge(place);
    }
    else if constexpr (shape == CellShape::Pyramid)
    {
      return this->InPyramid(place);
    }
    else
    {
      return this->InCube(place);
    }
  }

  /// The first guess of Newton's method.
  template <CellShape shape>
  HWY_INLINE void Begin(Triple& place) const
  {
    const D d;
    const VF most = hn::Set(d, 1.5f);
    const VF least = hn::Set(d, -1.5f);
    this->Straighten<shape>(place);
    place = { hn::Min(hn::Max(place.X, least), most), hn::Min(hn::Max(place.Y, least), most),
      hn::Min(hn::Max(place.Z, least), most) };
  }

  /// One step of Newton's method.
  /// @param moving lanes that go on; those are left whose steps are not small
  template <CellShape shape>
  HWY_INLINE void Step(const Triple& position, Triple& place, hn::Mask<D>& moving) const
  {
    const D d;
    const Tangent tangent = this->TangentAt<shape>(place);
    const Triple off = Minus(position, tangent.At);
    const Triple across0 = CrossOf(tangent.Along[1], tangent.Along[2]);
    const VF inverse = hn::Div(hn::Set(d, 1.0f), DotOf(tangent.Along[0], across0));
    const Triple by{ hn::Mul(DotOf(off, across0), inverse),
      hn::Mul(DotOf(off, CrossOf(tangent.Along[2], tangent.Along[0])), inverse),
      hn::Mul(DotOf(off, CrossOf(tangent.Along[0], tangent.Along[1])), inverse) };
    place = { hn::IfThenElse(moving, hn::Add(place.X, by.X), place.X),
      hn::IfThenElse(moving, hn::Add(place.Y, by.Y), place.Y),
      hn::IfThenElse(moving, hn::Add(place.Z, by.Z), place.Z) };
    const VF largest = hn::Max(hn::Max(hn::Abs(by.X), hn::Abs(by.Y)), hn::Abs(by.Z));
    // Steps that are no numbers go on to the end, and have met nothing.
    moving = hn::And(moving, hn::Not(hn::Lt(largest, hn::Set(d, CellSetup::LastStep))));
  }

  /// Newton's method. Each lane stops by its own step, so that a place depends on nothing but the
  /// cell and the position.
  /// @param inside set: lanes that have met the position in the cell
  template <CellShape shape, int count>
  HWY_INLINE void Refine(
    const Triple (&positions)[count], Triple (&places)[count], hn::Mask<D> (&inside)[count]) const
  {
    const D d;
    hn::Mask<D> moving[count];
    for (int i = 0; i < count; ++i)
    {
      moving[i] = this->Cell.IsBent ? hn::Eq(places[i].X, places[i].X) : hn::FirstN(d, 0);
    }
    if (this->Cell.IsBent)
    {
      for (int i = 0; i < count; ++i)
      {
        this->Begin<shape>(places[i]);
      }
      for (int step = 0; step < MostSteps; ++step)
      {
        hn::Mask<D> any = hn::FirstN(d, 0);
        for (int i = 0; i < count; ++i)
        {
          this->Step<shape>(positions[i], places[i], moving[i]);
          any = hn::Or(any, moving[i]);
        }
        if (hn::AllFalse(d, any))
        {
          break;
        }
      }
    }
    for (int i = 0; i < count; ++i)
    {
      inside[i] = hn::AndNot(moving[i], this->Inside<shape>(places[i]));
      for (int fan = 0; fan < this->Cell.FanCount; ++fan)
      {
        inside[i] = hn::And(inside[i], InFan(this->Cell.Fans[fan], places[i]));
      }
    }
  }

  const CellSetup& Cell;
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
