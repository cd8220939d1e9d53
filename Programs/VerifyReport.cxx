// SPDX-License-Identifier: BSD-3-Clause
#include "VerifyReport.h"

#include "Series/Quantize/QuantizationError.h"
#include "SeriesReport.h"
#include "TextTable.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

using Json = nlohmann::ordered_json;

// A table that fits on a screen; JSON has all steps.
constexpr std::size_t ShownSteps = 12;

Json Number(const std::optional<double>& value)
{
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

std::optional<double> OverBound(const ValueErrors& errors, double bound)
{
  return bound > 0.0 ? std::optional<double>(errors.GreatestJudged / bound) : std::nullopt;
}

/// @param global range of the whole series
Json ErrorsToJson(const ValueErrors& errors, double bound, const ValueRange& global)
{
  Json json;
  json["finite"] = errors.Finite;
  json["range"] =
    errors.Range.Empty() ? Json(nullptr) : Json::array({ errors.Range.Low, errors.Range.High });
  json["maxError"] = Number(errors.Greatest);
  json["maxErrorOverBound"] = Number(OverBound(errors, bound));
  json["outOfBound"] = errors.OutOfBound;
  json["invisible"] = errors.Invisible;
  json["fill"] = errors.Fill;
  json["rmse"] = Number(errors.Rmse());
  json["psnr"] = Number(Decibels(global.Width(), errors.Rmse()));
  json["psnrOfOwnRange"] = Number(Decibels(errors.Range.Width(), errors.Rmse()));
  json["otherClassShare"] = errors.OtherClassShare();
  json["equation1"] = Number(errors.MeanSquared());
  json["equation2"] = Number(errors.Weighted());
  json["equation1OfRange"] = Number(RootShareOfRange(errors.MeanSquared(), global));
  json["equation2OfRange"] = Number(RootShareOfRange(errors.Weighted(), global));
  json["nonFinite"] = errors.NonFinite;
  json["nonFiniteChanged"] = errors.NonFiniteChanged;
  return json;
}

Json WorstToJson(const WorstValue& worst)
{
  return { { "step", worst.Step }, { "index", { worst.Index.x, worst.Index.y, worst.Index.z } },
    { "original", worst.Original }, { "decoded", worst.Decoded },
    { "error", Number(worst.Error) } };
}

std::string Times(std::int64_t count, const std::string& noun)
{
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::vector<std::string> Row(
  const std::string& name, const ValueErrors& errors, double bound, const ValueRange& global)
{
  const auto share = [](const std::optional<double>& value)
  { return value ? Percent(*value) : std::string("-"); };
  return { name, Digits(errors.Greatest), share(OverBound(errors, bound)), Digits(errors.Rmse()),
    Digits(Decibels(global.Width(), errors.Rmse())),
    Digits(Decibels(errors.Range.Width(), errors.Rmse())), Percent(errors.OtherClassShare()),
    Digits(errors.MeanSquared()), Digits(errors.Weighted()), std::to_string(errors.NonFinite),
    std::to_string(errors.OutOfBound + errors.NonFiniteChanged) };
}

std::string Table(const ComponentVerification& component)
{
  const ValueRange& range = component.All.Range;
  TextTable table({ component.Name + ", bound " + Digits(component.Bound), "max |error|",
    "of bound", "RMSE", "PSNR dB", "of own range", "other class", "equation 1", "equation 2",
    "non-finite", "wrong" });
  table.AddRow(Row("all steps", component.All, component.Bound, range));
  const std::size_t count = component.Steps.size();
  const std::size_t shown = std::min(count, ShownSteps);
  for (std::size_t i = 0; i < shown && count > 1; ++i)
  {
    const std::size_t step = shown < 2 ? 0 : i * (count - 1) / (shown - 1);
    table.AddRow(
      Row("  step " + std::to_string(step), component.Steps[step], component.Bound, range));
  }
  return table.Text() + "\n";
}

std::string Shares(const ComponentVerification& component)
{
  const ValueErrors& all = component.All;
  const double uniform = UniformQuantizerError(all.Range, 256);
  return "  " + component.Name + ": root of equation 1 is " +
         Digits(100.0 * RootShareOfRange(all.MeanSquared(), all.Range)) +
         " % of the range, of equation 2 " +
         Digits(100.0 * RootShareOfRange(all.Weighted(), all.Range)) +
         " %; rounding to 8 bits gives " + Digits(100.0 * RootShareOfRange(uniform, all.Range)) +
         " %\n";
}

/// Values that were not judged by the bound, or not as they were.
std::string Exempt(const ComponentVerification& component)
{
  std::string text;
  const auto line = [&](std::int64_t count, const std::string& what)
  {
    text +=
      count > 0 ? "  " + component.Name + ": " + Times(count, "value") + " " + what + "\n" : "";
  };
  line(component.All.Invisible, "beyond the bound, invisible in the source and in the series");
  line(component.All.Fill, "without meaning (fill values), compared bit by bit");
  line(component.Clamped, "outside the range, judged by the end that they were clamped to");
  return text;
}

std::string Complaint(const ComponentVerification& component, const std::vector<double>& times)
{
  std::string text = "  " + component.Name + ": ";
  if (!component.TooLoose.empty())
  {
    text += component.TooLoose + ". ";
  }
  if (component.All.OutOfBound > 0)
  {
    text += Times(component.All.OutOfBound, "value") + " out of bound. ";
  }
  if (component.All.NonFiniteChanged > 0)
  {
    text += Times(component.All.NonFiniteChanged, "value") +
            " that are NaN, infinite or hidden did not keep their bits. ";
  }
  if (component.Worst && !component.All.Proven())
  {
    const WorstValue& worst = *component.Worst;
    text += "Worst: step " + std::to_string(worst.Step) + " (time " +
            Digits(times[static_cast<std::size_t>(worst.Step)]) +
            "), i j k = " + std::to_string(worst.Index.x) + " " + std::to_string(worst.Index.y) +
            " " + std::to_string(worst.Index.z) + ", original " + worst.Original + ", decoded " +
            worst.Decoded;
    if (std::isfinite(worst.Error))
    {
      text +=
        ", error " + Digits(worst.Error) + " where " + Digits(component.Bound) + " is allowed";
    }
    text += ".";
  }
  return text + "\n";
}

} // namespace

std::string VerificationToText(const Verification& result, const std::string& file)
{
  std::string text;
  ValueErrors sum;
  for (const ComponentVerification& component : result.Components)
  {
    text += Table(component);
    sum.Merge(component.All, 0);
  }
  for (const ComponentVerification& component : result.Components)
  {
    text += Shares(component);
  }
  for (const ComponentVerification& component : result.Components)
  {
    text += Exempt(component);
  }
  if (result.Proven())
  {
    const std::string odd = Times(sum.NonFinite, "value");
    return text + "\nPROVEN: in " + file + " all " + std::to_string(sum.Finite) +
           " finite values of " + Times(static_cast<std::int64_t>(result.Times.size()), "step") +
           " are within the bound" +
           (sum.NonFinite == 0 ? ", and there are no others.\n"
                               : "; NaN and infinities (" + odd + ") have the same bits.\n");
  }
  text += "\nNOT AS PROMISED: " + file + "\n";
  for (const ComponentVerification& component : result.Components)
  {
    text += component.Proven() ? "" : Complaint(component, result.Times);
  }
  return text;
}

std::string VerificationToJson(const Verification& result, const std::string& file)
{
  Json json;
  json["file"] = file;
  json["proven"] = result.Proven();
  json["times"] = result.Times;
  json["components"] = Json::array();
  for (const ComponentVerification& component : result.Components)
  {
    Json one;
    one["name"] = component.Name;
    one["bound"] = component.Bound;
    one["transformed"] = component.Transformed;
    one["clamped"] = component.Clamped;
    one["proven"] = component.Proven();
    one["tooLoose"] = component.TooLoose.empty() ? Json(nullptr) : Json(component.TooLoose);
    one["worst"] = component.Worst ? WorstToJson(*component.Worst) : Json(nullptr);
    one["all"] = ErrorsToJson(component.All, component.Bound, component.All.Range);
    one["steps"] = Json::array();
    for (const ValueErrors& errors : component.Steps)
    {
      one["steps"].push_back(ErrorsToJson(errors, component.Bound, component.All.Range));
    }
    json["components"].push_back(std::move(one));
  }
  return json.dump(2) + "\n";
}

} // namespace banyan
