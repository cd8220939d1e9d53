// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see PacketMarcher.cxx.
#if defined(banyan_Render_Raycast_LightLanes_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Render_Raycast_LightLanes_inl_h
#undef banyan_Render_Raycast_LightLanes_inl_h
#else
#define banyan_Render_Raycast_LightLanes_inl_h
#endif

#include "Render/Raycast/TableSteps-inl.h"
#include "Render/Scene/ShadingTable.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// The direction of a ray per lane: RayTile::Direction.
struct Direction
{
  VF X;
  VF Y;
  VF Z;
};

/// What the light makes of a sample per lane: as Shade.
struct Light
{
  VF Colour;
  VF Highlight; ///< set if there are highlights
};

/// Of the angle between a gradient and the ray, as ShadingTable::Of has it.
HWY_INLINE VF CosineOf(const ShadingTable& table, VF x, VF y, VF z, const Direction& direction)
{
  const D d;
  const auto metric = [&](int i) HWY_ATTR { return hn::Set(d, table.Metric[i]); };
  const VF along =
    hn::Add(hn::Add(hn::Mul(x, direction.X), hn::Mul(y, direction.Y)), hn::Mul(z, direction.Z));
  const VF mx =
    hn::Add(hn::Add(hn::Mul(x, metric(0)), hn::Mul(y, metric(3))), hn::Mul(z, metric(4)));
  const VF my = hn::Add(hn::Mul(y, metric(1)), hn::Mul(z, metric(5)));
  const VF mz = hn::Mul(z, metric(2));
  const VF length = hn::Add(hn::Add(hn::Mul(x, mx), hn::Mul(y, my)), hn::Mul(z, mz));
  const VF squared = hn::Div(hn::Mul(along, along), length);
  const VF one = hn::Set(d, 1.0f);
  const VF atMost = hn::IfThenElse(hn::Lt(squared, one), squared, one);
  const VF inside = hn::IfThenElseZero(hn::Ge(squared, hn::Zero(d)), atMost);
  return hn::Sqrt(inside);
}

/// As ShadingTable::Of.
HWY_INLINE Light LightOf(const ShadingTable& table, VF cosine)
{
  const D d;
  Light light;
  light.Colour = hn::Add(hn::Set(d, table.Ambient), hn::Mul(hn::Set(d, table.Diffuse), cosine));
  if (table.HasHighlights)
  {
    const VF last = hn::Set(d, static_cast<float>(ShadingTable::Entries - 1));
    const VI entry = Truncated(hn::Add(hn::Mul(cosine, last), hn::Set(d, 0.5f)));
    light.Highlight = hn::GatherIndex(d, table.Highlights.data(), entry);
  }
  return light;
}

HWY_INLINE Steps Lit(const Steps& steps, const Light& light, const ShadingTable& table)
{
  Steps lit = steps;
  lit.R = hn::Mul(lit.R, light.Colour);
  lit.G = hn::Mul(lit.G, light.Colour);
  lit.B = hn::Mul(lit.B, light.Colour);
  if (table.HasHighlights)
  {
    const VF opacity = hn::Sub(hn::Set(D(), 1.0f), steps.Transmittance);
    const VF white = hn::Mul(light.Highlight, opacity);
    lit.R = hn::Add(lit.R, white);
    lit.G = hn::Add(lit.G, white);
    lit.B = hn::Add(lit.B, white);
  }
  return lit;
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
