#include "TransferFunctionTable.h"

#include "Base/Error.h"
#include "Render/TabulateFunction.h"

#include "vtkColorTransferFunction.h"
#include "vtkDiscretizableColorTransferFunction.h"
#include "vtkPiecewiseFunction.h"
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

  /// Labels that a file keeps in float32 are what they are rounded to.
  double RoomAround(std::size_t label) const
  {
    const double at = this->Labels[label];
    double room = std::min(1e-7 * std::abs(at), 0.25);
    for (const std::size_t other : { label - 1, label + 1 })
    {
      room = other < this->Labels.size() ? std::min(room, 0.25 * std::abs(at - this->Labels[other]))
                                         : room;
    }
    return room;
  }

  void AddCorners(std::vector<double>& corners) const
  {
    for (std::size_t i = 0; i < this->Labels.size(); ++i)
    {
      const double room = this->RoomAround(i);
      corners.insert(corners.end(), { this->Labels[i] - room, this->Labels[i] + room });
    }
  }

  void ColourOf(double value, double (&rgb)[3]) const
  {
    const auto above = std::lower_bound(this->Labels.begin(), this->Labels.end(), value);
    for (const auto label : { above, above == this->Labels.begin() ? above : above - 1 })
    {
      if (label != this->Labels.end() &&
          std::abs(*label - value) <=
            this->RoomAround(static_cast<std::size_t>(label - this->Labels.begin())))
      {
        this->Function->GetColor(*label, rgb);
        return;
      }
    }
    this->Function->GetNanColor(rgb);
  }

private:
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
    auto* const discrete = vtkDiscretizableColorTransferFunction::SafeDownCast(this->Colours);
    if (discrete && discrete->GetIndexedLookup())
    {
      this->Labels.emplace(discrete);
      this->Labels->AddCorners(corners);
      return;
    }
    banyan::AddCorners(this->Colours, corners);
    const double* const range = this->Colours->GetRange();
    corners.insert(corners.end(), { range[0], range[1] });
    if (discrete && discrete->GetDiscretize())
    {
      AddColourSteps(discrete, corners);
    }
  }

  void Get(double value, double (&rgb)[3]) const
  {
    if (this->Greys)
    {
      std::fill(rgb, rgb + 3, this->Greys->GetValue(value));
    }
    else if (this->Labels)
    {
      this->Labels->ColourOf(value, rgb);
    }
    else
    {
      this->Colours->GetColor(value, rgb);
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

TransferFunction MakeTransferFunction(vtkVolumeProperty* property)
{
  vtkPiecewiseFunction* const opacity = property->GetScalarOpacity(0);
  CheckLogScale(opacity->GetUseLogScale(), opacity->GetRange(), "opacity function");
  std::vector<double> corners;
  const ColoursOfProperty colours(property, corners);
  AddCorners(opacity, corners);
  // A logarithm of what is below the range may be none.
  const double lowest = opacity->GetUseLogScale() ? opacity->GetRange()[0] : -VTK_DOUBLE_MAX;
  const auto function = [&](double value)
  {
    double rgb[3];
    colours.Get(value, rgb);
    const bool outside = value < lowest && !opacity->GetClamping();
    const double alpha = outside ? 0.0 : opacity->GetValue(std::max(value, lowest));
    return glm::dvec4(rgb[0], rgb[1], rgb[2], std::clamp(alpha, 0.0, 1.0));
  };
  TransferFunction table = TabulateFunction(function, std::move(corners));
  table.UnitDistance = property->GetScalarOpacityUnitDistance(0);
  return table;
}

const TransferFunction& KeptTransferFunction::Of(vtkVolumeProperty* property)
{
  vtkObject* color = GreysOf(property);
  color = color ? color : property->GetRGBTransferFunction(0);
  vtkPiecewiseFunction* const opacity = property->GetScalarOpacity(0);
  const std::uint64_t times[] = { color->GetMTime(), opacity->GetMTime() };
  if (this->Function.Entries.empty() || this->Made[0] != color || this->Made[1] != opacity ||
      !std::equal(times, times + 2, this->Times))
  {
    this->Function = MakeTransferFunction(property);
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
