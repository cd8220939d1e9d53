// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see CellKernels.cxx.
#if defined(banyan_Render_Cells_FacePackets_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Render_Cells_FacePackets_inl_h
#undef banyan_Render_Cells_FacePackets_inl_h
#else
#define banyan_Render_Cells_FacePackets_inl_h
#endif

#include "Render/Cells/CellPackets-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// A face at the border of the mesh, as a fan of triangles around its middle, or as one triangle.
/// Seen from outside its corners go round against the clock.
struct BorderPatch
{
  double Middle[3] = {}; ///< fixed-point, whole
  int Count = 0;         ///< of corners: 3, or 4 with a centre
  float Corners[4][3] = {};
  float Values[4] = {};
  float Centre[3] = {};
  float CentreValue = 0.0f;
  // Where they are wanted.
  float Gradients[4][3] = {};
  float CentreGradient[3] = {};
};

/// Finds where rays cross the border of the mesh.
class FacePackets
{
public:
  explicit FacePackets(const SlabJob& job)
    : Job(job)
  {
  }

  void Draw(const BorderPatch& patch, const PixelRect& packets, double row)
  {
    for (int y = packets.Lo.y; y < packets.Hi.y; ++y)
    {
      for (int x = packets.Lo.x; x < packets.Hi.x; ++x)
      {
        const int first = (y * RayTile::PacketsPerRow + x) * RayTile::PacketSize;
        for (int i = 0; i < RayTile::PacketSize; i += Lanes)
        {
          const RayLanes rays = RaysAt(this->Job, first + i, row, patch.Middle);
          patch.Count == 4 ? this->CrossFan(patch, rays, first + i, row)
                           : this->CrossTriangle(patch, rays, first + i, row);
        }
      }
    }
  }

private:
  static constexpr int Lanes = static_cast<int>(hn::MaxLanes(D()));

  /// On which side of the edge from a to b the ray goes by: above 0 where it enters, if the edge is
  /// one of a triangle that it meets.
  static HWY_INLINE VF SideOf(const RayLanes& rays, const Triple& a, const Triple& b)
  {
    return DotOf(rays.Step, CrossOf(b, a));
  }

  HWY_INLINE void CrossTriangle(
    const BorderPatch& patch, const RayLanes& rays, int slot, double row)
  {
    const D d;
    Triple corners[3];
    for (int i = 0; i < 3; ++i)
    {
      corners[i] = Minus(InAllLanes(patch.Corners[i]), rays.At);
    }
    const VF sides[3] = { SideOf(rays, corners[1], corners[2]),
      SideOf(rays, corners[2], corners[0]), SideOf(rays, corners[0], corners[1]) };
    const float values[3] = { patch.Values[0], patch.Values[1], patch.Values[2] };
    const float* const gradients[3] = { patch.Gradients[0], patch.Gradients[1],
      patch.Gradients[2] };
    const VF zero = hn::Zero(d);
    const auto positive = [&](int i) HWY_ATTR { return hn::Ge(sides[i], zero); };
    const auto in = hn::And(hn::And(positive(0), positive(1)), positive(2));
    const auto out =
      hn::And(hn::And(hn::Not(positive(0)), hn::Not(positive(1))), hn::Not(positive(2)));
    this->Take({ corners, sides, values, gradients }, rays, hn::Or(in, out), in, slot, row);
  }

  /// Edges from the centre are looked at once, so that a ray crosses one of the triangles there.
  HWY_INLINE void CrossFan(const BorderPatch& patch, const RayLanes& rays, int slot, double row)
  {
    const D d;
    const VF zero = hn::Zero(d);
    const Triple centre = Minus(InAllLanes(patch.Centre), rays.At);
    Triple corners[4];
    VF spokes[4];
    for (int i = 0; i < 4; ++i)
    {
      corners[i] = Minus(InAllLanes(patch.Corners[i]), rays.At);
      spokes[i] = SideOf(rays, centre, corners[i]);
    }
    for (int i = 0; i < 4; ++i)
    {
      const int next = (i + 1) % 4;
      const VF rim = SideOf(rays, corners[i], corners[next]);
      const auto from = hn::Ge(spokes[i], zero);
      const auto to = hn::Ge(spokes[next], zero);
      const auto beyond = hn::Ge(rim, zero);
      const auto in = hn::And(hn::And(from, beyond), hn::Not(to));
      const auto out = hn::And(hn::And(hn::Not(from), hn::Not(beyond)), to);
      const auto hit = hn::Or(in, out);
      if (hn::AllFalse(d, hit))
      {
        continue;
      }
      const Triple triangle[3] = { centre, corners[i], corners[next] };
      const VF sides[3] = { rim, hn::Neg(spokes[next]), spokes[i] };
      const float values[3] = { patch.CentreValue, patch.Values[i], patch.Values[next] };
      const float* const gradients[3] = { patch.CentreGradient, patch.Gradients[i],
        patch.Gradients[next] };
      this->Take({ triangle, sides, values, gradients }, rays, hit, in, slot, row);
    }
  }

  /// A triangle that some lanes meet.
  struct Met
  {
    const Triple* Corners;         ///< 3, from the rays on
    const VF* Sides;               ///< of the edge opposite to each: its part of the point
    const float* Values;           ///< of corners
    const float* const* Gradients; ///< of corners
  };

  /// @param in lanes that enter the mesh, of those that hit
  HWY_INLINE void Take(
    const Met& met, const RayLanes& rays, hn::Mask<D> hit, hn::Mask<D> in, int slot, double row)
  {
    const D d;
    const VF sum = hn::Add(hn::Add(met.Sides[0], met.Sides[1]), met.Sides[2]);
    const VF inverse = hn::Div(hn::Set(d, 1.0f), sum);
    const VF parts[3] = { hn::Mul(met.Sides[0], inverse), hn::Mul(met.Sides[1], inverse),
      hn::Mul(met.Sides[2], inverse) };
    const auto mixed = [&](auto&& of) HWY_ATTR
    {
      return hn::Add(
        hn::Add(hn::Mul(hn::Set(d, of(0)), parts[0]), hn::Mul(hn::Set(d, of(1)), parts[1])),
        hn::Mul(hn::Set(d, of(2)), parts[2]));
    };
    const Triple at = Plus(Plus(Times(met.Corners[0], parts[0]), Times(met.Corners[1], parts[1])),
      Times(met.Corners[2], parts[2]));
    const VF rows = hn::Div(DotOf(at, rays.Step), DotOf(rays.Step, rays.Step));
    const VF value = mixed([&](int i) { return met.Values[i]; });
    VF cosine = hn::Zero(d);
    if (this->Job.Shading)
    {
      const Direction direction{ hn::Load(d, this->Job.Rays.Direction[0] + slot),
        hn::Load(d, this->Job.Rays.Direction[1] + slot),
        hn::Load(d, this->Job.Rays.Direction[2] + slot) };
      cosine = CosineOf(*this->Job.Shading, mixed([&](int i) { return met.Gradients[i][0]; }),
        mixed([&](int i) { return met.Gradients[i][1]; }),
        mixed([&](int i) { return met.Gradients[i][2]; }), direction);
    }
    alignas(64) float crossed[RayTile::PacketSize];
    alignas(64) float values[RayTile::PacketSize];
    alignas(64) float cosines[RayTile::PacketSize];
    hn::Store(rows, d, crossed);
    hn::Store(value, d, values);
    hn::Store(cosine, d, cosines);
    std::uint64_t hits = 0;
    std::uint64_t enters = 0;
    hn::StoreMaskBits(d, hit, reinterpret_cast<std::uint8_t*>(&hits));
    hn::StoreMaskBits(d, in, reinterpret_cast<std::uint8_t*>(&enters));
    for (; hits != 0; hits &= hits - 1)
    {
      const int lane = __builtin_ctzll(hits);
      this->Cross(slot + lane, row, crossed[lane],
        { (enters >> lane & 1) != 0, values[lane], cosines[lane] });
    }
  }

  /// @param from row that `rows` counts from; a sample's interval goes from -1/2 to 1/2 around it
  HWY_INLINE void Cross(int slot, double from, float rows, const BorderCrossing& crossing)
  {
    const TileRows& all = this->Job.Rows;
    if (this->Job.Rays.Count[slot] == 0)
    {
      this->CrossEnds(slot, rows, crossing);
      return;
    }
    const float away = std::floor(rows + 0.5f);
    const double place = from + away - this->Job.FirstRow;
    if (!(place >= 0.0 && place < SampleSlab::Rows))
    {
      return;
    }
    const auto inSlab = static_cast<int>(place);
    const int row = this->Job.FirstRow + inSlab;
    // From the beginning of the row's interval on.
    const float at = rows - away + 0.5f;
    float begin = 0.0f;
    float end = 1.0f;
    if (row == all.Head[slot])
    {
      begin = 1.0f - this->Job.Rays.Head.Fraction[slot];
    }
    else if (row == all.Tail[slot])
    {
      end = this->Job.Rays.Tail.Fraction[slot];
    }
    else if (row < all.First[slot] || row >= all.End[slot])
    {
      return;
    }
    if (at >= begin && at < end)
    {
      this->Job.Slab.Cross(slot, inSlab, crossing, at - begin, end - begin);
    }
  }

  /// Of rays without whole samples.
  /// @param rows from the middle of the head on, or of the tail if there is no head
  HWY_INLINE void CrossEnds(int slot, float rows, const BorderCrossing& crossing)
  {
    const float head = this->Job.Rays.Head.Fraction[slot];
    const float tail = this->Job.Rays.Tail.Fraction[slot];
    // From the beginning of the ray on.
    const float at = rows + 0.5f * (head > 0.0f ? head : tail);
    const bool inHead = at < head;
    // None is in no slab.
    const int row = inHead ? this->Job.Rows.Head[slot] : this->Job.Rows.Tail[slot];
    const int inSlab = row - this->Job.FirstRow;
    const float before = inHead ? at : at - head;
    const float length = inHead ? head : tail;
    if (inSlab >= 0 && inSlab < SampleSlab::Rows && before >= 0.0f && before < length)
    {
      this->Job.Slab.Cross(slot, inSlab, crossing, before, length);
    }
  }

  const SlabJob& Job;
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
