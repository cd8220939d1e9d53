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
  block::Scratch<Number, 1> Edges, EdgesTarget;
  block::Scratch<Number, 2> Faces, FacesTarget;
  block::Scratch<Number, 3> Interior, InteriorTarget;
  UnitTokens Tokens;
  std::vector<Number> Boxes; ///< of the target and both references
  std::vector<std::pair<std::int64_t, block::Mode>> Costs;
};

/// A block of a plane that is being encoded.
template <class Edge, class Number>
struct BlockAt
{
  Edge B;
  const PlaneJob& Job;
  glm::ivec3 Position;
  BlockMemory<Number>& Work;

  const PlaneToEncode& Plane() const { return *this->Job.Plane; }

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
