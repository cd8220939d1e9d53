// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see BlockEncoder.cxx.
#if defined(banyan_Codec_BlockAt_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_BlockAt_inl_h
#undef banyan_Codec_BlockAt_inl_h
#else
#define banyan_Codec_BlockAt_inl_h
#endif

#include "Codec/BlockJob.h"
#include "Codec/BlockUnits-inl.h"
#include "Codec/SliceEncoder-inl.h"

#include <utility>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Memory of units whose magnitudes and residuals are cleared only where some were kept.
template <class Number, int D>
struct UnitMemory : block::Scratch<Number, D>
{
  using block::Scratch<Number, D>::Scratch;
  bool Used = false; ///< to be set where some residual was not zero

  void Clean()
  {
    if (this->Used)
    {
      this->Clear();
      this->Used = false;
    }
  }
};

/// What a thread encodes blocks with.
template <class Number>
struct BlockMemory
{
  explicit BlockMemory(int edge)
    : Edges(edge)
    , EdgesTarget(edge)
    , Faces(edge)
    , FacesTarget(edge)
    , Interior(edge)
    , InteriorTarget(edge)
    , Tokens(edge)
    , Boxes(3 * static_cast<std::size_t>((edge + 1) * (edge + 1) * (edge + 1)))
  {
  }
  UnitMemory<Number, 1> Edges, EdgesTarget;
  UnitMemory<Number, 2> Faces, FacesTarget;
  UnitMemory<Number, 3> Interior, InteriorTarget;
  UnitTokens Tokens;
  std::vector<Number> Boxes;                               ///< of the target and both references
  std::vector<std::pair<std::int64_t, std::size_t>> Costs; ///< of candidates, by their numbers
  std::size_t Likely = 0; ///< the candidate that the block before took
};

/// Takes units with their borders from what is decoded, and from what they are to become, less what
/// both refer to: as LoadUnit does, both at once, as what they refer to is the same.
/// @param w their sample 0, and @param target the same of what they are to become
template <int D, class Edge, class Number>
HWY_INLINE void LoadBoth(const View<const Number>& decoded, const View<const Number>& wanted,
  const References<Number>& from, const Edge& edge, Number* w, Number* target)
{
  const block::Shape<D> shape{ edge() };
  const int n = edge();
  if (wanted.Stride.x != 1 || n < Width)
  {
    LoadUnit<D>(decoded, from, edge, false, w);
    LoadUnit<D>(wanted, from, edge, true, target);
    return;
  }
  WithReference<Number>(from.From,
    [&](auto reference)
    {
      for (int z = 0; z <= (D > 2 ? n : 0); ++z)
      {
        for (int y = 0; y <= (D > 1 ? n : 0); ++y)
        {
          const auto row = RowOf(wanted, from, y, z);
          const Number* const known = decoded.Row(y, z);
          const std::ptrdiff_t to = z * shape.Z() + y * shape.Y();
          const auto take = [&](int at)
          {
            const auto subtracted =
              reference.Of(LoadSamples<Number>(row.A + at), LoadSamples<Number>(row.B + at));
            StoreVector(LoadSamples<Number>(known + at) - subtracted, w + to + at);
            StoreVector(LoadSamples<Number>(row.X + at) - subtracted, target + to + at);
          };
          for (int x = 0; x + Width <= n; x += Width)
          {
            take(x);
          }
          take(n - Width + 1); // the rest, and some once more
        }
      }
    });
}

/// A block of a plane that is being encoded.
template <class Edge, class Number>
struct BlockAt
{
  Edge B;
  const PlaneJob& Job;
  glm::ivec3 Position;
  BlockMemory<Number>& Work;

  const PlaneToEncode& Plane() const { return *this->Job.Plane; }

  /// How far it is to the block that comes next on one thread, in samples: its memory is asked for
  /// in time.
  std::int64_t NextBlock() const
  {
    const PlaneNumbers& plane = *this->Plane().Target;
    return plane.IndexOf(plane.BlockBefore(this->Position) * this->B()) -
           plane.IndexOf(this->Position * this->B());
  }

  View<Number> ViewOf(PlaneNumbers& plane) const
  {
    const glm::ivec3 origin = this->Position * this->B();
    return { plane.Data<Number>() + plane.IndexOf(origin),
      { 1, plane.Padded.x, std::int64_t{ plane.Padded.x } * plane.Padded.y } };
  }
  View<const Number> ViewOf(const PlaneNumbers& plane) const
  {
    const View<Number> view = this->ViewOf(const_cast<PlaneNumbers&>(plane));
    return { view.Base, view.Stride };
  }

  References<Number> ReferencesOf(block::Reference from) const
  {
    References<Number> result;
    result.From = from;
    if (from != block::Reference::None)
    {
      result.A = this->ViewOf(*this->Plane().A);
      result.B = this->ViewOf(*this->Plane().B);
    }
    return result;
  }

  template <class P>
  RowQuantizer<P, Edge, Number> RowsOf(
    Unit<Number, P::D>& unit, Interpolation by, const Number* target) const
  {
    return { unit, this->B, by, target,
      static_cast<Number>(P::S == 2 ? this->Plane().CoarseBin : this->Plane().FineBin) };
  }
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
