// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMBanyanSourceProxy.h"

#include "PythonErrors.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkSMBanyanSourceProxy);

void vtkSMBanyanSourceProxy::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

void vtkSMBanyanSourceProxy::UpdatePipelineInformation()
{
  this->Superclass::UpdatePipelineInformation();
  banyan::RaiseErrorOf(this);
}

void vtkSMBanyanSourceProxy::UpdatePipeline()
{
  this->Superclass::UpdatePipeline();
  banyan::RaiseErrorOf(this);
}

void vtkSMBanyanSourceProxy::UpdatePipeline(double time)
{
  this->Superclass::UpdatePipeline(time);
  banyan::RaiseErrorOf(this);
}
