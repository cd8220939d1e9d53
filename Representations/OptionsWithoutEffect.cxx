// SPDX-License-Identifier: BSD-3-Clause
#include "OptionsWithoutEffect.h"

#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSourceProxy.h"
#include "vtkType.h"

#include <algorithm>
#include <sstream>

namespace banyan
{
namespace
{

struct Option
{
  const char* Property;
  double WithoutEffectAt; ///< the value that asks for nothing
  const char* Advice;
};

constexpr Option Options[] = {
  { "UseTransfer2D", 0.0,
    "colours and opacities follow the one array that is coloured by. For a two-dimensional "
    "transfer "
    "function choose 'Volume'" },
  { "UseSeparateOpacityArray", 0.0,
    "the array that is coloured by decides the opacity, too. For an opacity array choose "
    "'Volume'" },
  { "MultiComponentsMapping", 0.0,
    "one component, or the magnitude, decides colour and opacity. For two components choose "
    "'Volume'" },
  { "GlobalIlluminationReach", 0.0, "there are no shadows. For shadows choose 'Volume'" },
  { "VolumetricScatteringBlending", 0.0,
    "light is not scattered. For scattered light choose 'Volume'" },
  { "VolumeAnisotropy", 0.0, "light is not scattered. For scattered light choose 'Volume'" },
  { "VolumeRenderingMode", 0.0,
    "it has one way of drawing, on the processor. To choose between ParaView's choose 'Volume'" },
  { "Compositing", 0.0, "all methods made the same picture, and one is left" },
  { "Opacity", 1.0,
    "it is as opaque as the opacity function says. Edit that in the Color Map Editor, or set "
    "'Scalar "
    "Opacity Unit Distance'" },
};

std::string Sentence(vtkSMProperty* property, const std::string& advice)
{
  const char* const label = property->GetXMLLabel();
  return "'" + std::string(label ? label : property->GetXMLName()) +
         "' has no effect on 'Banyan Volume': " + advice + ".";
}

vtkPVDataInformation* DataOf(vtkSMPVRepresentationProxy* display)
{
  vtkSMPropertyHelper input(display, "Input");
  auto* const source = vtkSMSourceProxy::SafeDownCast(input.GetAsProxy());
  return source ? source->GetDataInformation(input.GetOutputPort()) : nullptr;
}

/// What is to be said of numbers that are drawn as colours, if anything.
std::string OfColours(vtkPVArrayInformation* array)
{
  double low = 0.0;
  double high = 0.0;
  for (int i = 0; i < array->GetNumberOfComponents(); ++i)
  {
    const double* const range = array->GetComponentFiniteRange(i);
    low = std::min(low, range[0]);
    high = std::max(high, range[1]);
  }
  const bool real = array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE;
  if (low >= 0.0 && high <= 255.0 && !(real && high <= 1.0))
  {
    return {};
  }
  std::ostringstream sentence;
  sentence << "Colours are drawn from 0 to 255, and the numbers of '" << array->GetName()
           << "' lie from " << low << " to " << high
           << ": scale them with the filter 'Calculator'.";
  return sentence.str();
}

/// What is to be said where components are meant as colours, if anything.
std::string OfComponents(vtkSMPVRepresentationProxy* display)
{
  vtkSMProperty* const map = display->GetProperty("MapScalars");
  vtkPVArrayInformation* const array = display->GetArrayInformationForColorArray();
  if (!map || !array || vtkSMPropertyHelper(map).GetAsInt() != 0)
  {
    return {};
  }
  const std::string name = "'" + std::string(array->GetName()) + "'";
  const int components = array->GetNumberOfComponents();
  if (components == 1)
  {
    return Sentence(map, name + " has one component, and colours have three or four");
  }
  const std::string mapped =
    "the magnitude (or one component) of " + name + " is coloured by its map. ";
  if (components != 3 && components != 4)
  {
    return Sentence(map, mapped + "Colours have three components, or four with their opacity");
  }
  vtkPVDataInformation* const data = DataOf(display);
  if (data && !data->DataSetTypeIsA("vtkImageData"))
  {
    return Sentence(map, mapped + "Colours are drawn of image data: use 'Resample To Image'");
  }
  for (const char* const blending : { "Projection", "BlendMode" })
  {
    if (vtkSMPropertyHelper(display, blending, true).GetAsInt() != 0)
    {
      return Sentence(map, mapped + "Colours have no projection: set 'Projection' to 'Composite'");
    }
  }
  return OfColours(array);
}

/// Whether motion is asked for of data that do not move.
bool HasNoMotion(vtkSMPVRepresentationProxy* display)
{
  vtkSMProperty* const strength = display->GetProperty("TemporalEnhancement");
  if (!strength || vtkSMPropertyHelper(strength).GetAsDouble() <= 0.0)
  {
    return false;
  }
  vtkPVDataInformation* const data = DataOf(display);
  return data && data->GetNumberOfTimeSteps() < 2;
}

} // namespace

std::map<std::string, std::string> OptionsWithoutEffect(
  vtkSMPVRepresentationProxy* display, vtkSMProxy* view)
{
  std::map<std::string, std::string> sentences;
  for (const Option& option : Options)
  {
    vtkSMProperty* const property = display->GetProperty(option.Property);
    if (property && vtkSMPropertyHelper(property).GetAsDouble() != option.WithoutEffectAt)
    {
      sentences[option.Property] = Sentence(property, option.Advice);
    }
  }
  vtkSMProperty* const balancing = display->GetProperty("LoadBalancing");
  if (balancing && vtkSMPropertyHelper(balancing).GetAsInt() == 1)
  {
    sentences["LoadBalancing"] = "'Slice step' of '" + std::string(balancing->GetXMLLabel()) +
                                 "' has no effect any more: 'Measured cost' balances in its place.";
  }
  for (const char* const name : { "SelectMapper", "ResamplingMode" })
  {
    vtkSMProperty* const property = display->GetProperty(name);
    if (property && !property->IsValueDefault())
    {
      sentences[name] = Sentence(
        property, "it draws cells and blocks as they are. To resample them choose 'Volume'");
    }
  }
  const std::string components = OfComponents(display);
  if (!components.empty())
  {
    sentences["MapScalars"] = components;
  }
  if (HasNoMotion(display))
  {
    sentences["TemporalEnhancement"] = Sentence(display->GetProperty("TemporalEnhancement"),
      "the data has no other time steps to tell motion from");
  }
  vtkSMProperty* const lights = view ? view->GetProperty("AdditionalLights") : nullptr;
  if (lights && vtkSMPropertyHelper(display, "Shade", true).GetAsInt() != 0 &&
      vtkSMPropertyHelper(lights).GetNumberOfElements() > 0)
  {
    sentences["AdditionalLights"] =
      Sentence(lights, "'Shade' lights it in white, from the viewer. For lights choose 'Volume'");
  }
  return sentences;
}

} // namespace banyan
