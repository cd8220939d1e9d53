// SPDX-License-Identifier: BSD-3-Clause
#include "VtkScene.h"

#include "BenchScene.h"

#include <vtkColorTransferFunction.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>

namespace banyan::bench
{

vtkSmartPointer<vtkVolumeProperty> PropertyOf(const BenchScene& scene)
{
  vtkNew<vtkColorTransferFunction> colors;
  vtkNew<vtkPiecewiseFunction> opacities;
  for (std::size_t i = 0; i < scene.Nodes.size(); ++i)
  {
    const double part = static_cast<double>(i) / static_cast<double>(scene.Nodes.size() - 1);
    const double value = scene.Low + part * (scene.High - scene.Low);
    const glm::dvec4& node = scene.Nodes[i];
    colors->AddRGBPoint(value, node.r, node.g, node.b);
    opacities->AddPoint(value, node.a);
  }
  auto property = vtkSmartPointer<vtkVolumeProperty>::New();
  property->SetColor(colors);
  property->SetScalarOpacity(opacities);
  property->SetScalarOpacityUnitDistance(scene.UnitDistance);
  property->SetInterpolationTypeToLinear();
  property->SetShade(scene.Shaded ? 1 : 0);
  property->SetAmbient(0.3);
  property->SetDiffuse(0.7);
  property->SetSpecular(0.0);
  return property;
}

} // namespace banyan::bench
