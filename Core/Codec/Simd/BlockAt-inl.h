// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_BlockAt_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_BlockAt_inl_h
#undef banyan_Codec_BlockAt_inl_h
#else
#define banyan_Codec_BlockAt_inl_h
#endif

#include "Codec/BlockJob.h"
#include "Codec/Simd/SliceEncoder-inl.h"
#include "Codec/Simd/Units-inl.h"

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

/// Memory that a thread encodes blocks with.
template <int B, class Number>
struct BlockMemory
{
  UnitMemory<Number, 1> Edges{ B }, EdgesTarget{ B };
  UnitMemory<Number, 2> Faces{ B }, FacesTarget{ B };
  UnitMemory<Number, 3> Interior{ B }, InteriorTarget{ B };
  UnitTokens<B> Tokens;
  /// Boxes of the target and both references.
  std::vector<Number> Boxes =
    std::vector<Number>(3 * static_cast<std::size_t>((B + 1) * (B + 1) * (B + 1)));
  std::vector<std::pair<std::int64_t, std::size_t>> Costs; ///< of candidates, by their numbers
  std::size_t PreviousMode = 0; ///< the candidate that the block before took
};

/// Takes units with their borders from what is decoded, and from what they are to become, less what
/// both refer to: as LoadUnit does, both at once, as what they refer to is the same.
/// @param w their sample 0, and @param target the same of what they are to become
template <int D, int B, class Number>
HWY_INLINE void LoadBoth(const View<const Number>& decoded, const View<const Number>& wanted,
  const References<Number>& from, Number* w, Number* target)
{
  constexpr block::Shape<D> shape{ B };
  if (wanted.Stride.x != 1)
  {
    LoadUnit<D, B>(decoded, from, false, w);
    LoadUnit<D, B>(wanted, from, true, target);
    return;
  }
  WithReference<Number>(from.From,
    [&](auto reference)
    {
      for (int z = 0; z <= (D > 2 ? B : 0); ++z)
      {
        for (int y = 0; y <= (D > 1 ? B : 0); ++y)
        {
          const auto row = RowOf(wanted, from, y, z);
          const Number* const known = decoded.Row(y, z);
          const std::ptrdiff_t to = z * shape.Z() + y * shape.Y();
          ForEachWidth(B,
            [&](int x)
            {
              const Samples<Number> subtracted = row.SubtractedAt(reference, x);
              (Samples<Number>::Load(known + x) - subtracted).Store(w + to + x);
              (Samples<Number>::Load(row.X + x) - subtracted).Store(target + to + x);
            });
        }
      }
    });
}

/// A block of a plane that is being encoded.
template <int B, class Number>
struct BlockAt
{
  const PlaneJob& Job;
  glm::ivec3 Position;
  BlockMemory<B, Number>& Work;

  const PlaneToEncode& Plane() const { return *this->Job.Plane; }

  /// How far it is to the block that comes next on one thread, in samples: its memory is asked for
  /// in time.
  std::int64_t NextBlock() const
  {
    const PlaneNumbers& plane = *this->Plane().Target;
    return plane.IndexOf(plane.BlockBefore(this->Position) * B) - plane.IndexOf(this->Position * B);
  }

  View<Number> ViewOf(PlaneNumbers& plane) const
  {
    const glm::ivec3 origin = this->Position * B;
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
  RowQuantizer<P, B, Number> RowsOf(
    Unit<Number, P::D>& unit, Interpolation by, const Number* target) const
  {
    return { unit, by, target,
      static_cast<Number>(P::S == 2 ? this->Plane().CoarseBin : this->Plane().FineBin) };
  }
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
