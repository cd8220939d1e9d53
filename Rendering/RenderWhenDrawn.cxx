// SPDX-License-Identifier: BSD-3-Clause
#include "RenderWhenDrawn.h"

#include "vtkCallbackCommand.h"
#include "vtkRenderWindow.h"
#include "vtkRenderWindowInteractor.h"

#include <utility>

namespace banyan
{

bool RenderWhenDrawn::CanWatch(vtkRenderWindow* window)
{
  vtkRenderWindowInteractor* const interactor = window ? window->GetInteractor() : nullptr;
  return interactor && interactor->IsA("QVTKInteractor") != 0;
}

void RenderWhenDrawn::Watch(vtkRenderWindow* window, std::function<bool()> isDrawn)
{
  vtkRenderWindowInteractor* const interactor = window->GetInteractor();
  this->IsDrawn = std::move(isDrawn);
  if (this->Interactor == interactor)
  {
    return;
  }
  this->Stop();
  this->Interactor = interactor;
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(this);
  command->SetCallback([](vtkObject*, unsigned long, void* self, void* timer)
    { static_cast<RenderWhenDrawn*>(self)->Look(*static_cast<int*>(timer)); });
  this->Observer = interactor->AddObserver(vtkCommand::TimerEvent, command);
  this->Timer = interactor->CreateRepeatingTimer(Pause);
}

void RenderWhenDrawn::Stop()
{
  if (this->Interactor)
  {
    this->Interactor->RemoveObserver(this->Observer);
    this->Interactor->DestroyTimer(this->Timer);
  }
  this->Interactor = nullptr;
}

void RenderWhenDrawn::Look(int timer)
{
  if (!this->Interactor || timer != this->Timer)
  {
    return;
  }
  vtkRenderWindow* const window = this->Interactor->GetRenderWindow();
  if (window && window->CheckInRenderStatus() == 0 && !this->IsBusy() && this->IsDrawn())
  {
    vtkRenderWindowInteractor* const interactor = this->Interactor;
    this->Stop();
    interactor->Render();
  }
}

} // namespace banyan
