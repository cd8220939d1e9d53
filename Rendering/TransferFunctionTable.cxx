// SPDX-License-Identifier: BSD-3-Clause
#include "TransferFunctionTable.h"

#include "Base/Error.h"
#include "Render/Scene/TabulateFunction.h"

#include "vtkColorTransferFunction.h"
#include "vtkDiscretizableColorTransferFunction.h"
#include "vtkPiecewiseFunction.h"
#include "vtkSmartPointer.h"
#include "vtkVariant.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace banyan
{
namespace
{

/// The function of greys of a property that has one in place of colours; else null.
vtkPiecewiseFunction* GreysOf(vtkVolumeProperty* property)
{
  return property->GetColorChannels(0) == 1 ? property->GetGrayTransferFunction(0) : nullptr;
}

/// Where a function bends or jumps: at its nodes, and between two of them where the first says.
void AddNode(double x, double next, double midpoint, bool logarithmic, std::vector<double>& corners)
{
  corners.push_back(x);
  const bool byRatio = logarithmic && x > 0.0 && next > 0.0;
  corners.push_back(byRatio ? x * std::pow(next / x, midpoint) : x + (next - x) * midpoint);
}

void AddCorners(vtkPiecewiseFunction* function, std::vector<double>& corners)
{
  const int nodes = function->GetSize();
  double node[4];
  double next[4];
  for (int i = 0; i < nodes; ++i)
  {
    function->GetNodeValue(i, node);
    function->GetNodeValue(std::min(i + 1, nodes - 1), next);
    AddNode(node[0], next[0], node[2], function->GetUseLogScale(), corners);
  }
}

void AddCorners(vtkColorTransferFunction* function, std::vector<double>& corners)
{
  const int nodes = function->GetSize();
  double node[6];
  double next[6];
  for (int i = 0; i < nodes; ++i)
  {
    function->GetNodeValue(i, node);
    function->GetNodeValue(std::min(i + 1, nodes - 1), next);
    AddNode(node[0], next[0], node[4], function->GetScale() == VTK_CTF_LOG10, corners);
  }
}

/// Where a colour map of a number of colours goes from one to the next.
void AddColourSteps(vtkDiscretizableColorTransferFunction* function, std::vector<double>& corners)
{
  const double* const range = function->GetRange();
  const int colours = static_cast<int>(function->GetNumberOfValues());
  const bool byRatio = function->UsingLogScale() != 0;
  for (int i = 1; i < colours && range[0] < range[1]; ++i)
  {
    const double part = i / static_cast<double>(colours);
    corners.push_back(byRatio ? range[0] * std::pow(range[1] / range[0], part)
                              : range[0] + (range[1] - range[0]) * part);
  }
}

/// The colours of categories: those of labels, and that of what is none.
class Categories
{
public:
  explicit Categories(vtkDiscretizableColorTransferFunction* function)
    : Function(function)
  {
    const vtkIdType count = function->GetNumberOfAnnotatedValues();
    for (vtkIdType i = 0; i < count; ++i)
    {
      bool isNumber = false;
      const double label = function->GetAnnotatedValue(i).ToDouble(&isNumber);
      if (isNumber && std::isfinite(label))
      {
        this->Labels.push_back(label);
      }
    }
    std::sort(this->Labels.begin(), this->Labels.end());
    this->Labels.erase(std::unique(this->Labels.begin(), this->Labels.end()), this->Labels.end());
  }

  void AddCorners(std::vector<double>& corners) const
  {
    for (const double label : this->Labels)
    {
      corners.insert(corners.end(), { label, Rounded(label) });
    }
  }

  void ColourOf(double value, double (&rgb)[3]) const
  {
    const auto above = std::lower_bound(this->Labels.begin(), this->Labels.end(), value);
    for (const auto label : { above, above == this->Labels.begin() ? above : above - 1 })
    {
      if (label != this->Labels.end() && std::min(*label, Rounded(*label)) <= value &&
          value <= std::max(*label, Rounded(*label)))
      {
        this->Function->GetColor(*label, rgb);
        return;
      }
    }
    this->Function->GetColor(value, rgb);
  }

private:
  /// A label as data in float32 have it.
  static double Rounded(double label) { return static_cast<float>(label); }

  vtkDiscretizableColorTransferFunction* Function;
  std::vector<double> Labels;
};

void CheckLogScale(bool logarithmic, const double* range, const char* which)
{
  if (logarithmic && !(range[0] > 0.0))
  {
    throw Error(std::string("The ") + which + " has a logarithmic scale, but its range begins at " +
                std::to_string(range[0]) +
                ": a logarithmic scale needs a range above 0. Rescale the range to one above 0, or "
                "switch the logarithmic scale off");
  }
}

/// VTK knows no colour and no opacity of what has no logarithm: all values below a range have the
/// same.
double WithLogarithm(double value, double lowest)
{
  return value < lowest && lowest > 0.0 ? 0.5 * lowest : value;
}

/// The values of a piecewise function, as VTK gives them. VTK goes through all nodes from the first
/// one for each value: here a function of two nodes is asked, and the right two are found at once.
class PiecewiseValues
{
public:
  explicit PiecewiseValues(vtkPiecewiseFunction* function)
    : Function(function)
    , Pairs(static_cast<std::size_t>(function->GetSize()))
    , Lowest(function->GetUseLogScale() ? function->GetRange()[0] : -VTK_DOUBLE_MAX)
  {
    double node[4];
    for (int i = 0; i < function->GetSize(); ++i)
    {
      function->GetNodeValue(i, node);
      this->Nodes.push_back(node[0]);
    }
  }

  double operator()(double value)
  {
    const double known = WithLogarithm(value, this->Lowest);
    const auto above = std::lower_bound(this->Nodes.begin(), this->Nodes.end(), known);
    if (above == this->Nodes.begin() || above == this->Nodes.end())
    {
      return this->Function->GetValue(known);
    }
    const auto at = static_cast<int>(above - this->Nodes.begin());
    vtkSmartPointer<vtkPiecewiseFunction>& pair = this->Pairs[static_cast<std::size_t>(at)];
    if (!pair)
    {
      pair = vtkSmartPointer<vtkPiecewiseFunction>::New();
      pair->SetUseLogScale(this->Function->GetUseLogScale());
      for (const int i : { at - 1, at })
      {
        double node[4];
        this->Function->GetNodeValue(i, node);
        pair->AddPoint(node[0], node[1], node[2], node[3]);
      }
    }
    return pair->GetValue(known);
  }

private:
  vtkPiecewiseFunction* Function;
  std::vector<double> Nodes;
  std::vector<vtkSmartPointer<vtkPiecewiseFunction>> Pairs; ///< that end at each node
  double Lowest;
};

/// The colours of a property, as VTK gives them.
class ColoursOfProperty
{
public:
  ColoursOfProperty(vtkVolumeProperty* property, std::vector<double>& corners)
    : Greys(GreysOf(property))
    , Colours(this->Greys ? nullptr : property->GetRGBTransferFunction(0))
  {
    if (this->Greys)
    {
      CheckLogScale(this->Greys->GetUseLogScale(), this->Greys->GetRange(), "function of greys");
      banyan::AddCorners(this->Greys, corners);
      return;
    }
    this->Colours->Build(); // what discretized colours are looked up in
    const double* const range = this->Colours->GetRange();
    corners.insert(corners.end(), { range[0], range[1] });
    auto* const discrete = vtkDiscretizableColorTransferFunction::SafeDownCast(this->Colours);
    if (discrete && discrete->GetIndexedLookup())
    {
      this->Labels.emplace(discrete);
      this->Labels->AddCorners(corners);
      return;
    }
    banyan::AddCorners(this->Colours, corners);
    if (discrete && discrete->GetDiscretize())
    {
      AddColourSteps(discrete, corners);
    }
  }

  /// Equal parts of the range of colours in which these are the same; 0 if there are none.
  int EqualParts() const
  {
    auto* const discrete = vtkDiscretizableColorTransferFunction::SafeDownCast(this->Colours);
    return discrete && discrete->GetDiscretize() && !discrete->UsingLogScale()
             ? static_cast<int>(discrete->GetNumberOfValues())
             : 0;
  }

  void Get(double value, double (&rgb)[3]) const
  {
    if (this->Greys)
    {
      const double lowest =
        this->Greys->GetUseLogScale() ? this->Greys->GetRange()[0] : -VTK_DOUBLE_MAX;
      std::fill(rgb, rgb + 3, this->Greys->GetValue(WithLogarithm(value, lowest)));
    }
    else if (this->Labels)
    {
      this->Labels->ColourOf(value, rgb);
    }
    else
    {
      const bool byRatio = this->Colours->GetScale() == VTK_CTF_LOG10;
      const double lowest = byRatio ? this->Colours->GetRange()[0] : -VTK_DOUBLE_MAX;
      this->Colours->GetColor(WithLogarithm(value, lowest), rgb);
    }
  }

private:
  vtkPiecewiseFunction* Greys;
  vtkColorTransferFunction* Colours;
  std::optional<Categories> Labels;
};

} // namespace

bool ShowsCategories(vtkVolumeProperty* property)
{
  return !GreysOf(property) && property->GetRGBTransferFunction(0)->GetIndexedLookup() != 0;
}

TransferFunction MakeTransferFunction(vtkVolumeProperty* property, bool white)
{
  vtkPiecewiseFunction* const opacity = property->GetScalarOpacity(0);
  CheckLogScale(opacity->GetUseLogScale(), opacity->GetRange(), "opacity function");
  std::vector<double> corners;
  std::optional<ColoursOfProperty> colours;
  if (!white)
  {
    colours.emplace(property, corners);
  }
  AddCorners(opacity, corners);
  PiecewiseValues opacities(opacity);
  const auto function = [&](double value)
  {
    double rgb[3] = { 1.0, 1.0, 1.0 };
    if (colours)
    {
      colours->Get(value, rgb);
    }
    return glm::dvec4(rgb[0], rgb[1], rgb[2], std::clamp(opacities(value), 0.0, 1.0));
  };
  TransferFunction table =
    TabulateFunction(function, std::move(corners), colours ? colours->EqualParts() : 0);
  table.UnitDistance = property->GetScalarOpacityUnitDistance(0);
  return table;
}

const TransferFunction& KeptTransferFunction::Of(vtkVolumeProperty* property, bool white)
{
  vtkObject* color = GreysOf(property);
  color = color ? color : property->GetRGBTransferFunction(0);
  color = white ? nullptr : color;
  vtkPiecewiseFunction* const opacity = property->GetScalarOpacity(0);
  const std::uint64_t times[] = { color ? color->GetMTime() : 0, opacity->GetMTime() };
  if (this->Function.Entries.empty() || this->Made[0] != color || this->Made[1] != opacity ||
      !std::equal(times, times + 2, this->Times))
  {
    this->Function = MakeTransferFunction(property, white);
    this->Made[0] = color;
    this->Made[1] = opacity;
    std::copy(times, times + 2, this->Times);
  }
  this->Function.UnitDistance = property->GetScalarOpacityUnitDistance(0);
  return this->Function;
}

RayShading MakeShading(vtkVolumeProperty* property)
{
  RayShading shading;
  shading.On = property->GetShade(0) != 0;
  shading.Ambient = static_cast<float>(property->GetAmbient(0));
  shading.Diffuse = static_cast<float>(property->GetDiffuse(0));
  shading.Specular = static_cast<float>(property->GetSpecular(0));
  shading.SpecularPower = static_cast<float>(property->GetSpecularPower(0));
  return shading;
}

} // namespace banyan
