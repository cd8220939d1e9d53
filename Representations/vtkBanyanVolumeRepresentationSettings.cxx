// SPDX-License-Identifier: BSD-3-Clause
// The part of vtkBanyanVolumeRepresentation that hands settings on.
#include "vtkBanyanVolumeRepresentation.h"

#include "StepWindow.h"
#include "vtkBanyanFrameStatistics.h"
#include "vtkBanyanVolume.h"
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

#define BANYAN_FORWARD(Type, Name)                                                                 \
  void vtkBanyanVolumeRepresentation::Set##Name(Type value)                                        \
  {                                                                                                \
    this->Mapper->Set##Name(value);                                                                \
    this->NoteStepsNeeded();                                                                       \
  }
#define BANYAN_REAL(Name, ...) BANYAN_FORWARD(double, Name)
#define BANYAN_WHOLE(Name, ...) BANYAN_FORWARD(int, Name)
#define BANYAN_SWITCH(Name, ...) BANYAN_FORWARD(bool, Name)
BANYAN_VOLUME_SETTINGS(BANYAN_REAL, BANYAN_WHOLE, BANYAN_SWITCH, BANYAN_WHOLE)
#undef BANYAN_REAL
#undef BANYAN_WHOLE
#undef BANYAN_SWITCH
#undef BANYAN_FORWARD

/// Motion is brought out with steps around the one that is drawn: the pipeline must run for them.
void vtkBanyanVolumeRepresentation::NoteStepsNeeded()
{
  const bool needed = this->Mapper->GetTemporalEnhancement() > 0.0;
  if (needed != this->StepsNeeded)
  {
    this->StepsNeeded = needed;
    this->MarkModified();
  }
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

void vtkBanyanVolumeRepresentation::SetMarkCoarsePictures(bool marks)
{
  this->Prop->SetMarksCoarse(marks);
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

void vtkBanyanVolumeRepresentation::SetStatistics(vtkBanyanFrameStatistics* statistics)
{
  this->Mapper->SetStatistics(statistics);
}
