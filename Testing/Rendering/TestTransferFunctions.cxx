// SPDX-License-Identifier: BSD-3-Clause
// Tables of random maps of VTK against VTK's own evaluation of them, value by value; and what a
// logarithmic opacity function over 0 is told.
#include "MapperTesting.h"

#include "Base/Error.h"
#include "Render/Scene/TabulateFunction.h"
#include "TransferFunctionTable.h"

#include "vtkDiscretizableColorTransferFunction.h"
#include "vtkVariant.h"

#include <algorithm>
#include <functional>
#include <random>

namespace
{

using namespace mapper_testing;

/// A property with random functions, and the values at which they are likely to be wrong.
class RandomProperty
{
public:
  explicit RandomProperty(unsigned seed)
    : Random(seed)
  {
    const bool logarithmic = this->Below(4) == 0;
    this->Logarithmic = logarithmic;
    this->Low = logarithmic ? std::pow(10.0, -this->Below(10)) : this->Unit() * 20.0 - 10.0;
    this->High = logarithmic ? std::pow(10.0, 1 + this->Below(4))
                             : this->Low + std::pow(10.0, this->Below(8) - 2);
    this->MakeOpacity(logarithmic);
    switch (this->Below(4))
    {
      case 0:
        this->MakeGreys();
        break;
      case 1:
        this->MakeCategories();
        break;
      default:
        this->MakeColours(logarithmic);
    }
    this->Property->SetScalarOpacity(this->Opacity);
  }

  vtkVolumeProperty* Get() { return this->Property; }

  float Value()
  {
    const double node =
      this->Nodes[static_cast<std::size_t>(this->Below(static_cast<int>(this->Nodes.size())))];
    switch (this->Below(4))
    {
      case 0:
        return static_cast<float>(node);
      case 1:
        return std::nextafter(static_cast<float>(node), this->Below(2) == 0 ? -1e30f : 1e30f);
      case 2:
        return static_cast<float>(std::round(node + 4.0 * this->Unit() - 2.0));
      default:
        return static_cast<float>(
          this->Low + (this->High - this->Low) * (1.4 * this->Unit() - 0.2));
    }
  }

  /// The map in VTK's own form.
  glm::dvec4 At(double value) const
  {
    // VTK has none for what has no logarithm: that of all values below the range.
    const double positive = this->Logarithmic && value <= 0.0 ? 1e-30 : value;
    double rgb[3];
    if (this->Greys)
    {
      std::fill(rgb, rgb + 3, this->Greys->GetValue(value));
    }
    else
    {
      this->Colours->GetColor(this->Colours->GetIndexedLookup() ? value : positive, rgb);
    }
    return { rgb[0], rgb[1], rgb[2], std::clamp(this->Opacity->GetValue(positive), 0.0, 1.0) };
  }

private:
  double Unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(this->Random); }
  int Below(int n) { return static_cast<int>(this->Random() % static_cast<unsigned>(n)); }
  double Midpoint() { return this->Below(2) == 0 ? 0.5 : 0.1 + 0.8 * this->Unit(); }
  glm::dvec3 Colour()
  {
    const double blue = this->Unit();
    const double green = this->Unit();
    return { this->Unit(), green, blue };
  }
  double Sharpness()
  {
    const double some[] = { 0.0, 0.0, 1.0, this->Unit() };
    return some[this->Below(4)];
  }

  double Node(int i, int count)
  {
    const double inside = this->Low + (this->High - this->Low) * this->Unit();
    const double node = i == 0 ? this->Low : i + 1 == count ? this->High : inside;
    this->Nodes.push_back(node);
    return node;
  }

  void AddPoints(vtkPiecewiseFunction* function, bool opacity)
  {
    // Calls of Random stand apart: compilers differ in the order of arguments.
    const auto add = [&](double x, const std::function<double()>& value)
    {
      const double sharpness = this->Sharpness();
      const double midpoint = this->Midpoint();
      function->AddPoint(x, value(), midpoint, sharpness);
    };
    function->AllowDuplicateScalarsOn();
    const int count = 2 + this->Below(6);
    for (int i = 0; i < count; ++i)
    {
      const double x = this->Node(i, count);
      const double y = opacity && this->Below(3) == 0 ? 0.0 : this->Unit();
      add(x, [y] { return y; });
      if (this->Below(4) == 0)
      {
        add(x, [this] { return this->Unit(); }); // a step
      }
    }
  }

  void MakeOpacity(bool logarithmic)
  {
    this->AddPoints(this->Opacity, true);
    this->Opacity->SetUseLogScale(logarithmic && this->Below(2) == 0);
    this->Opacity->SetClamping(this->Opacity->GetUseLogScale() || this->Below(4) != 0);
  }

  void MakeGreys()
  {
    this->Greys = vtkSmartPointer<vtkPiecewiseFunction>::New();
    this->AddPoints(this->Greys, false);
    this->Property->SetColor(this->Greys);
  }

  void AddSpecialColours()
  {
    this->Colours->SetUseBelowRangeColor(this->Below(2));
    this->Colours->SetBelowRangeColor(0.1, 0.9, 0.2);
    this->Colours->SetUseAboveRangeColor(this->Below(2));
    this->Colours->SetAboveRangeColor(0.9, 0.9, 0.1);
    this->Colours->SetNanColor(0.5, 0.0, 0.4);
  }

  void MakeColours(bool logarithmic)
  {
    this->Colours = vtkSmartPointer<vtkDiscretizableColorTransferFunction>::New();
    this->AddSpecialColours();
    const int count = 2 + this->Below(6);
    for (int i = 0; i < count; ++i)
    {
      const double x = this->Node(i, count);
      const double sharpness = this->Below(4) == 0 ? 1.0 : 0.0;
      const double midpoint = this->Midpoint();
      const glm::dvec3 colour = this->Colour();
      this->Colours->AddRGBPoint(x, colour.r, colour.g, colour.b, midpoint, sharpness);
    }
    if (logarithmic)
    {
      this->Colours->SetUseLogScale(1);
      this->Colours->SetScaleToLog10();
    }
    this->Colours->SetDiscretize(this->Below(2));
    const int numbers[] = { 1, 2, 5, 16, 100, 256, 1024 };
    this->Colours->SetNumberOfValues(numbers[this->Below(7)]);
    this->Finish();
  }

  void MakeCategories()
  {
    this->Colours = vtkSmartPointer<vtkDiscretizableColorTransferFunction>::New();
    this->AddSpecialColours();
    this->Colours->AddRGBPoint(this->Low, 0, 0, 0);
    this->Colours->AddRGBPoint(this->High, 1, 1, 1);
    this->Colours->SetIndexedLookup(1);
    const int count = 1 + this->Below(60);
    const int gap = this->Below(2) == 0 ? 1 : 1 + this->Below(500);
    int label = this->Below(2) == 0 ? 0 : -this->Below(1000);
    for (int i = 0; i < count; ++i, label += 1 + this->Below(gap))
    {
      this->Colours->SetAnnotation(vtkStdString(std::to_string(label)), "some part");
      const glm::dvec3 colour = this->Colour();
      this->Colours->SetIndexedColor(static_cast<unsigned>(i), colour.r, colour.g, colour.b);
      this->Nodes.push_back(label);
    }
    this->Colours->SetNumberOfIndexedColors(static_cast<unsigned>(count));
    this->Finish();
  }

  void Finish()
  {
    this->Colours->Build();
    this->Property->SetColor(this->Colours);
  }

  std::mt19937 Random;
  bool Logarithmic = false;
  double Low = 0.0;
  double High = 1.0;
  std::vector<double> Nodes;
  vtkNew<vtkVolumeProperty> Property;
  vtkNew<vtkPiecewiseFunction> Opacity;
  vtkSmartPointer<vtkPiecewiseFunction> Greys;
  vtkSmartPointer<vtkDiscretizableColorTransferFunction> Colours;
};

double HighestOf(const banyan::TransferFunction& table)
{
  double highest = 0.0;
  for (const glm::vec4& entry : table.Entries)
  {
    highest = std::max(highest, double{ entry.a });
  }
  return highest;
}

bool IsWithin(const glm::vec4& entry, const glm::dvec4& exact, double highest)
{
  using Error = banyan::TabulationError;
  const glm::dvec4 error = glm::abs(glm::dvec4(entry) - exact);
  return std::max({ error.r, error.g, error.b }) <= Error::Colour + 1e-6 &&
         error.a <= Error::OpacityOfItself * std::max(double{ entry.a }, exact.a) +
                      1.05 * Error::OpacityOfHighest * highest;
}

void RandomMapsAreThoseOfVtk()
{
  int wrong = 0;
  int withEdges = 0;
  for (unsigned seed = 0; seed < 300; ++seed)
  {
    RandomProperty property(seed);
    const banyan::TransferFunction table = banyan::MakeTransferFunction(property.Get());
    const banyan::StepTable steps(table, 1.0);
    const banyan::VisibleValues visible(table);
    const double highest = HighestOf(table);
    withEdges += table.Edges.empty() ? 0 : 1;
    for (int i = 0; i < 200; ++i)
    {
      const float value = property.Value();
      const auto index = static_cast<std::size_t>(steps.Lookup().IndexOf(value));
      const glm::dvec4 exact = property.At(value);
      // Where equal steps are next to each other, rounding in float may decide.
      const double room = table.Edges.empty() ? 1e-6 * (table.High - table.Low) : 0.0;
      const bool right = IsWithin(table.Entries[index], exact, highest) ||
                         IsWithin(table.Entries[index], property.At(value - room), highest) ||
                         IsWithin(table.Entries[index], property.At(value + room), highest);
      const bool skipped = exact.a > highest / 256.0 && !visible.Any(value, value);
      if ((!right || skipped) && ++wrong <= 5)
      {
        std::cerr << "seed " << seed << ", value " << value << ", entry " << index << " of "
                  << table.Entries.size() << ", colour " << table.Entries[index].r << " for "
                  << exact.r << ", opacity " << table.Entries[index].a << " for " << exact.a
                  << "\n";
      }
    }
  }
  Check(wrong == 0, std::to_string(wrong) + " values of 60000 have another colour than VTK's");
  Check(withEdges > 50 && withEdges < 300, std::to_string(withEdges) + " maps of 300 have edges");
}

/// ParaView's own default: 256 colours over the range of the opacities.
void DefaultMapsHaveEqualSpaces()
{
  vtkNew<vtkDiscretizableColorTransferFunction> colours;
  colours->SetColorSpaceToDiverging();
  colours->AddRGBPoint(37.35, 0.231373, 0.298039, 0.752941);
  colours->AddRGBPoint(157.09, 0.865003, 0.865003, 0.865003);
  colours->AddRGBPoint(276.83, 0.705882, 0.0156863, 0.14902);
  colours->SetDiscretize(1);
  colours->SetNumberOfValues(256);
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(37.35, 0.0);
  opacity->AddPoint(276.83, 1.0);
  vtkNew<vtkVolumeProperty> property;
  property->SetColor(colours);
  property->SetScalarOpacity(opacity);
  Check(banyan::MakeTransferFunction(property).Edges.empty(), "the default map needs no edges");
}

void LogarithmsOfZeroGetASentence()
{
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(0.0, 0.0);
  opacity->AddPoint(10.0, 1.0);
  opacity->SetUseLogScale(true);
  vtkNew<vtkVolumeProperty> property;
  property->SetScalarOpacity(opacity);
  std::string sentence;
  try
  {
    banyan::MakeTransferFunction(property);
  }
  catch (const banyan::Error& error)
  {
    sentence = error.what();
  }
  Check(sentence.find("needs a range above 0") != std::string::npos, "'" + sentence + "'");
}

} // namespace

int main()
{
  RandomMapsAreThoseOfVtk();
  DefaultMapsHaveEqualSpaces();
  LogarithmsOfZeroGetASentence();
  return Failures();
}
