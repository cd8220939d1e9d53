// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Format/TransformJson.h"

#include "Base/Error.h"
#include "Series/Format/JsonMembers.h"

namespace banyan
{

using namespace json_members;

Json TransformToJson(const Transform& transform)
{
  Json json;
  switch (transform.Kind())
  {
    case TransformKind::Uniform:
      json["kind"] = "uniform";
      break;
    case TransformKind::Asinh:
      json["kind"] = "asinh";
      json["scale"] = transform.Scale();
      break;
    case TransformKind::Table:
      json["kind"] = "table";
      json["x"] = Json::array();
      json["y"] = Json::array();
      for (const TransformKnot& knot : transform.Knots())
      {
        json["x"].push_back(knot.X);
        json["y"].push_back(knot.Y);
      }
      break;
  }
  return json;
}

Transform TransformFromJson(const Json& json)
{
  if (!json.is_object())
  {
    WrongType("transform");
  }
  const std::string kind = TextMember(json, "kind");
  if (kind == "uniform")
  {
    return {};
  }
  if (kind == "asinh")
  {
    return Transform::Asinh(Real(Member(json, "scale"), "scale"));
  }
  if (kind != "table")
  {
    throw Error("The kind of transform '" + kind + "' is not known to this Banyan");
  }
  const std::size_t count = ListMember(json, "x").size();
  if (count > MonotoneTable::GreatestKnots)
  {
    throw Error("The table of a transform has too many knots",
      { {}, {}, count, MonotoneTable::GreatestKnots });
  }
  const std::vector<double> x = Reals(json, "x", count);
  const std::vector<double> y = Reals(json, "y", count);
  std::vector<TransformKnot> knots(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    knots[i] = { x[i], y[i] };
  }
  return Transform::Table(std::move(knots));
}

} // namespace banyan
