// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see PacketMarcher.cxx.
#if defined(banyan_Render_Raycast_UniformSamples_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Render_Raycast_UniformSamples_inl_h
#undef banyan_Render_Raycast_UniformSamples_inl_h
#else
#define banyan_Render_Raycast_UniformSamples_inl_h
#endif

#include "Render/Raycast/PacketSamples-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Stands in for PacketSamples where all samples are of one value: how many there are is known from
/// where rays enter and leave, what each adds is known as well, and nothing is looked up or loaded.
class UniformSamples
{
public:
  static constexpr bool IsShaded = false;
  struct Place
  {
  };
  struct Found
  {
  };

  /// @param entry of the table
  UniformSamples(const StepTable& table, int entry)
    : Step(table.Steps()[entry])
    , Depth(table.Depths()[entry])
  {
  }

  template <class Mask>
  HWY_INLINE void Locate(const Position&, Mask, Place&) const
  {
  }

  HWY_INLINE void Interpolate(const Place&, const Direction&, Found&) const {}

  HWY_INLINE Steps LookUp(const Found&) const
  {
    const D d;
    return { hn::Set(d, this->Step.r), hn::Set(d, this->Step.g), hn::Set(d, this->Step.b),
      hn::Set(d, this->Step.a) };
  }

  HWY_INLINE Steps LookUp(const Found&, VF fraction) const
  {
    const D d;
    return OverFraction({ { hn::Set(d, this->Depth.r), hn::Set(d, this->Depth.g),
                          hn::Set(d, this->Depth.b), hn::Set(d, this->Depth.a) } },
      fraction);
  }

private:
  glm::vec4 Step;
  glm::vec4 Depth;
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
