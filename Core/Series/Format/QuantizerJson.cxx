// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Format/QuantizerJson.h"

#include "Base/Error.h"
#include "Series/Format/JsonMembers.h"

#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

using namespace json_members;

constexpr const char* RangeNames[] = { "data", "percentiles", "given" };

void OpacityFromJson(const Json& json, ComponentIndex& component)
{
  for (const Json& knot : ListMember(json, "opacity"))
  {
    if (!knot.is_array() || knot.size() != 2)
    {
      WrongType("opacity");
    }
    component.Opacity.push_back({ Real(knot[0], "opacity"), Real(knot[1], "opacity") });
  }
  (void)OpacityFunction(component.Opacity); // throws when it is none
  component.InvisibleCount = CountMember(json, "invisibleCount");
  const Json& sum = Member(json, "sumWeightedError");
  component.SumWeightedError =
    sum.is_null() ? std::numeric_limits<double>::infinity() : Real(sum, "sumWeightedError");
}

} // namespace

void QuantizerToJson(const ComponentIndex& component, Json& json)
{
  if (component.RangeFrom != RangeRule::Source::Data)
  {
    json["rangeFrom"] = RangeNames[static_cast<int>(component.RangeFrom)];
  }
  if (component.ClampOutside)
  {
    json["clampedCount"] = component.ClampedCount;
  }
  if (!component.FillValues.empty())
  {
    json["fillValues"] = component.FillValues;
    json["fillCount"] = component.FillCount;
  }
  if (!component.Opacity.empty())
  {
    json["opacity"] = Json::array();
    for (const OpacityKnot& knot : component.Opacity)
    {
      json["opacity"].push_back(Json::array({ knot.Value, knot.Opacity }));
    }
    json["invisibleCount"] = component.InvisibleCount;
    const bool finite = std::isfinite(component.SumWeightedError);
    json["sumWeightedError"] = finite ? Json(component.SumWeightedError) : Json(nullptr);
    const double share = component.OpacityWeightedError();
    json["opacityWeightedError"] = std::isfinite(share) ? Json(share) : Json(nullptr);
  }
}

void QuantizerFromJson(const Json& json, ComponentIndex& component)
{
  if (json.contains("rangeFrom"))
  {
    const std::string name = TextMember(json, "rangeFrom");
    if (name != RangeNames[1] && name != RangeNames[2])
    {
      WrongType("rangeFrom");
    }
    component.RangeFrom =
      name == RangeNames[1] ? RangeRule::Source::Percentiles : RangeRule::Source::Given;
  }
  component.ClampOutside = json.contains("clampedCount");
  if (component.ClampOutside)
  {
    component.ClampedCount = CountMember(json, "clampedCount");
  }
  if (json.contains("fillValues"))
  {
    component.FillValues = Reals(json, "fillValues", ListMember(json, "fillValues").size());
    component.FillCount = CountMember(json, "fillCount");
  }
  if (json.contains("opacity"))
  {
    OpacityFromJson(json, component);
  }
}

} // namespace banyan
