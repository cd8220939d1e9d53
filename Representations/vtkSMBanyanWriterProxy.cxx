// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMBanyanWriterProxy.h"

#include "PythonErrors.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkSMBanyanWriterProxy);

void vtkSMBanyanWriterProxy::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

void vtkSMBanyanWriterProxy::UpdatePipeline()
{
  banyan::ForgetGarbageOfPython();
  this->Superclass::UpdatePipeline();
  banyan::RaiseErrorOf(this);
}

void vtkSMBanyanWriterProxy::UpdatePipeline(double time)
{
  banyan::ForgetGarbageOfPython();
  this->Superclass::UpdatePipeline(time);
  banyan::RaiseErrorOf(this);
}
