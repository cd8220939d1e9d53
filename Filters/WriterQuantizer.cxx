// SPDX-License-Identifier: BSD-3-Clause
#include "WriterQuantizer.h"

#include "Base/Error.h"
#include "Base/PropertyNumber.h"

#include <sstream>
#include <utility>

namespace banyan
{
namespace
{

template <class Knot>
std::vector<Knot> Pairs(const std::vector<double>& numbers, const char* property)
{
  if (numbers.size() % 2 != 0)
  {
    throw Error(CalledInMessages(property) + " needs pairs of numbers.");
  }
  std::vector<Knot> knots;
  for (std::size_t i = 0; i < numbers.size(); i += 2)
  {
    knots.push_back({ numbers[i], numbers[i + 1] });
  }
  return knots;
}

void Print(std::ostringstream& text, const char* name, const std::vector<double>& numbers)
{
  if (!numbers.empty())
  {
    text << name << ":";
    for (const double number : numbers)
    {
      text << " " << number;
    }
    text << "\n";
  }
}

} // namespace

QuantizerOptions WriterQuantizer::Options() const
{
  RequireNumber("AsinhScale", this->AsinhScale);
  for (const double share : this->RangePercentiles)
  {
    RequireNumber("RangePercentiles", share);
  }
  for (const double end : this->Range)
  {
    RequireNumber("Range", end, true);
  }
  const std::pair<const char*, const std::vector<double>*> lists[] = { { "TransformTable",
                                                                         &this->TransformTable },
    { "FillValues", &this->FillValues }, { "OpacityFunction", &this->OpacityFunction } };
  for (const auto& [property, numbers] : lists)
  {
    for (const double number : *numbers)
    {
      RequireNumber(property, number, true);
    }
  }
  QuantizerOptions options;
  options.Map = static_cast<TransformChoice>(this->Transform);
  options.AsinhScale = this->AsinhScale;
  options.Knots = Pairs<TransformKnot>(this->TransformTable, "TransformTable");
  options.Range.From = static_cast<RangeRule::Source>(this->RangeMode);
  options.Range.LowShare = this->RangePercentiles[0] / 100.0;
  options.Range.HighShare = this->RangePercentiles[1] / 100.0;
  options.Range.Given = { this->Range[0], this->Range[1] };
  options.Range.ClampOutside = this->ClampOutside;
  options.FillValues = this->FillValues;
  options.Opacity = Pairs<OpacityKnot>(this->OpacityFunction, "OpacityFunction");
  options.Check();
  return options;
}

std::string WriterQuantizer::Text() const
{
  std::ostringstream text;
  text << "Transform: " << this->Transform << "\nAsinhScale: " << this->AsinhScale
       << "\nRangeMode: " << this->RangeMode << "\nRangePercentiles: " << this->RangePercentiles[0]
       << " " << this->RangePercentiles[1] << "\nRange: " << this->Range[0] << " " << this->Range[1]
       << "\nClampOutside: " << this->ClampOutside << "\n";
  Print(text, "TransformTable", this->TransformTable);
  Print(text, "FillValues", this->FillValues);
  Print(text, "OpacityFunction", this->OpacityFunction);
  return text.str();
}

} // namespace banyan
