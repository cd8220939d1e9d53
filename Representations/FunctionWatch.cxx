// SPDX-License-Identifier: BSD-3-Clause
#include "FunctionWatch.h"

#include "vtkCommand.h"
#include "vtkObject.h"

namespace banyan
{

void FunctionWatch::Watch(vtkObject* function)
{
  if (this->Function == function)
  {
    return;
  }
  if (this->Function)
  {
    this->Function->RemoveObserver(this->Observer);
  }
  this->Function = function;
  if (function)
  {
    this->Observer = function->AddObserver(vtkCommand::ModifiedEvent, this, &FunctionWatch::Tell);
  }
}

} // namespace banyan
