// SPDX-License-Identifier: BSD-3-Clause
// The part of vtkBanyanVolumeRepresentation that hands settings on.
#include "vtkBanyanVolumeRepresentation.h"

#include "StepWindow.h"
#include "vtkBanyanFrameStatistics.h"
#include "vtkBanyanVolumeMapper.h"

#include "vtkVolumeProperty.h"

#include "Base/PropertyNumber.h"

/// Says what is wrong with a number, if anything is: then the property stays as it was.
bool vtkBanyanVolumeRepresentation::IsNumber(const char* property, double value, bool mayBeNegative)
{
  const std::string problem = banyan::ProblemOfNumber(property, value, mayBeNegative);
  if (!problem.empty())
  {
    vtkErrorMacro(<< problem << ". It stays as it was.");
  }
  return problem.empty();
}

void vtkBanyanVolumeRepresentation::SetImageErrorTolerance(double tolerance)
{
  this->Mapper->SetImageErrorTolerance(tolerance);
}

void vtkBanyanVolumeRepresentation::SetInteractiveImageErrorTolerance(double tolerance)
{
  this->Mapper->SetInteractiveImageErrorTolerance(tolerance);
}

void vtkBanyanVolumeRepresentation::SetInteractiveFrameSeconds(double seconds)
{
  this->Mapper->SetInteractiveFrameSeconds(seconds);
}

void vtkBanyanVolumeRepresentation::SetSampleDistanceVoxels(double voxels)
{
  this->Mapper->SetSampleDistanceVoxels(voxels);
}

void vtkBanyanVolumeRepresentation::SetScreenErrorPixels(double pixels)
{
  this->Mapper->SetScreenErrorPixels(pixels);
}

void vtkBanyanVolumeRepresentation::SetShade(bool shade)
{
  this->Property->SetShade(shade ? 1 : 0);
}

void vtkBanyanVolumeRepresentation::SetAmbient(double coefficient)
{
  if (this->IsNumber("Ambient", coefficient))
  {
    this->Property->SetAmbient(coefficient);
  }
}

void vtkBanyanVolumeRepresentation::SetDiffuse(double coefficient)
{
  if (this->IsNumber("Diffuse", coefficient))
  {
    this->Property->SetDiffuse(coefficient);
  }
}

void vtkBanyanVolumeRepresentation::SetSpecular(double coefficient)
{
  if (this->IsNumber("Specular", coefficient))
  {
    this->Property->SetSpecular(coefficient);
  }
}

void vtkBanyanVolumeRepresentation::SetSpecularPower(double power)
{
  if (this->IsNumber("SpecularPower", power))
  {
    this->Property->SetSpecularPower(power);
  }
}

void vtkBanyanVolumeRepresentation::SetInterpolationType(int type)
{
  this->InterpolationType = type;
}

void vtkBanyanVolumeRepresentation::SetNearestPoint(bool nearest)
{
  this->NearestPoint = nearest;
}

void vtkBanyanVolumeRepresentation::SetBlendMode(int mode)
{
  this->BlendMode = mode;
}

void vtkBanyanVolumeRepresentation::SetProjection(int mode)
{
  this->Projection = mode;
}

void vtkBanyanVolumeRepresentation::SetCropping(int cropping)
{
  this->Mapper->SetCropping(cropping);
}

void vtkBanyanVolumeRepresentation::SetCroppingOrigin(double x, double y, double z)
{
  if (!this->IsNumber("CroppingOrigin", x, true) || !this->IsNumber("CroppingOrigin", y, true) ||
      !this->IsNumber("CroppingOrigin", z, true))
  {
    return;
  }
  this->CroppingOrigin[0] = x;
  this->CroppingOrigin[1] = y;
  this->CroppingOrigin[2] = z;
}

void vtkBanyanVolumeRepresentation::SetCroppingOrigin(double origin[3])
{
  this->SetCroppingOrigin(origin[0], origin[1], origin[2]);
}

void vtkBanyanVolumeRepresentation::SetCroppingScale(double x, double y, double z)
{
  if (!this->IsNumber("CroppingScale", x) || !this->IsNumber("CroppingScale", y) ||
      !this->IsNumber("CroppingScale", z))
  {
    return;
  }
  this->CroppingScale[0] = x;
  this->CroppingScale[1] = y;
  this->CroppingScale[2] = z;
}

void vtkBanyanVolumeRepresentation::SetCroppingScale(double scale[3])
{
  this->SetCroppingScale(scale[0], scale[1], scale[2]);
}

void vtkBanyanVolumeRepresentation::SetMeshTolerance(double tolerance)
{
  this->Mapper->SetMeshTolerance(tolerance);
}

void vtkBanyanVolumeRepresentation::SetMeshSamplingTolerance(double tolerance)
{
  this->Mapper->SetMeshSamplingTolerance(tolerance);
}

void vtkBanyanVolumeRepresentation::SetMeshSamplingBoxes(int boxes)
{
  this->Mapper->SetMeshSamplingBoxes(boxes);
}

void vtkBanyanVolumeRepresentation::SetMaxElementsPerPixel(double most)
{
  this->Mapper->SetMaxElementsPerPixel(most);
}

void vtkBanyanVolumeRepresentation::SetTemporalEnhancement(double strength)
{
  const bool needed = this->Mapper->GetTemporalEnhancement() > 0.0;
  this->Mapper->SetTemporalEnhancement(strength);
  if (needed != (this->Mapper->GetTemporalEnhancement() > 0.0))
  {
    this->MarkModified(); // other steps are needed, or no longer
  }
}

void vtkBanyanVolumeRepresentation::SetCompositeInFewBits(bool few)
{
  this->Mapper->SetCompositeInFewBits(few);
}

void vtkBanyanVolumeRepresentation::SetNumberOfThreads(int threads)
{
  this->Mapper->SetNumberOfThreads(threads);
}

void vtkBanyanVolumeRepresentation::SetReadAhead(bool on)
{
  this->Mapper->SetReadAhead(on);
}

void vtkBanyanVolumeRepresentation::SetLoadBalancing(int mode)
{
  this->Mapper->SetLoadBalancing(mode);
}

void vtkBanyanVolumeRepresentation::SetStatistics(vtkBanyanFrameStatistics* statistics)
{
  this->Mapper->SetStatistics(statistics);
}
