// SPDX-License-Identifier: BSD-3-Clause
#include "OptionsWithoutEffect.h"

#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSourceProxy.h"

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

/// Whether the components of the array are meant as colours.
std::string OfComponents(vtkSMPVRepresentationProxy* display)
{
  vtkSMProperty* const map = display->GetProperty("MapScalars");
  vtkPVArrayInformation* const array = display->GetArrayInformationForColorArray();
  const int components = array ? array->GetNumberOfComponents() : 1;
  if (!map || vtkSMPropertyHelper(map).GetAsInt() != 0 || components < 2)
  {
    return {};
  }
  const std::string colored = "the magnitude (or one component) of '" +
                              std::string(array->GetName()) + "' is coloured by its map. ";
  switch (components)
  {
    case 2:
      return Sentence(map, colored + "For components that are drawn as they are choose 'Volume'");
    case 4:
      return "RGBA data are not drawn as colours: " + colored +
             "For the colours themselves choose 'Volume'.";
    default:
      return Sentence(map, colored + "For the colours themselves add their opacity as a fourth "
                                     "component, and choose 'Volume'");
  }
}

/// Whether motion is asked for of data that do not move.
bool HasNoMotion(vtkSMPVRepresentationProxy* display)
{
  vtkSMProperty* const strength = display->GetProperty("TemporalEnhancement");
  if (!strength || vtkSMPropertyHelper(strength).GetAsDouble() <= 0.0)
  {
    return false;
  }
  vtkSMPropertyHelper input(display, "Input");
  auto* const source = vtkSMSourceProxy::SafeDownCast(input.GetAsProxy());
  return source && source->GetDataInformation(input.GetOutputPort())->GetNumberOfTimeSteps() < 2;
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
