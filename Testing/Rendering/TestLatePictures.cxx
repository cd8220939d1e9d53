// SPDX-License-Identifier: BSD-3-Clause
// Decoupled: a window shows a coarse picture at once, and by itself the exact one when it is there.

#include "MapperTesting.h"

#include "vtkBanyanFrameStatistics.h"
#include "vtkBanyanVolumeMapper.h"

#include "vtkCommand.h"
#include "vtkRTAnalyticSource.h"
#include "vtkRenderWindowInteractor.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <iostream>
#include <set>
#include <thread>

using namespace mapper_testing;

/// Has the name of that of ParaView's windows, and timers that the test turns.
class QVTKInteractor : public vtkRenderWindowInteractor
{
public:
  static QVTKInteractor* New();
  vtkTypeMacro(QVTKInteractor, vtkRenderWindowInteractor);

  std::set<int> Timers;

  /// What the loop of a window does.
  void Turn()
  {
    for (int timer : std::set<int>(this->Timers))
    {
      this->InvokeEvent(vtkCommand::TimerEvent, &timer);
    }
  }

protected:
  int InternalCreateTimer(int timer, int, unsigned long) override
  {
    this->Timers.insert(timer);
    return timer;
  }
  int InternalDestroyTimer(int timer) override
  {
    return static_cast<int>(this->Timers.erase(timer));
  }
};
vtkStandardNewMacro(QVTKInteractor);

namespace
{

struct Window
{
  vtkNew<vtkRTAnalyticSource> Source;
  vtkNew<vtkBanyanVolumeMapper> Mapper;
  vtkNew<QVTKInteractor> Interactor;
  Stage Shown{ Mapper };
  const double Bounds[6] = { -60, 60, -60, 60, -60, 60 };
  int Renders = 0;
  bool TurnsInside = false;

  Window()
  {
    this->Source->SetWholeExtent(-60, 60, -60, 60, -60, 60);
    this->Mapper->SetInputConnection(this->Source->GetOutputPort());
    this->Mapper->SetImageErrorTolerance(0.03); // takes longer than one waits for
    this->Mapper->SetNumberOfThreads(1);
    this->Shown.Volume->GetProperty()->ShadeOn();
    Check(!this->Mapper->GetDecoupled(), "programs wait for pictures by default");
    this->Mapper->DecoupledOn();
    this->Interactor->SetRenderWindow(this->Shown.Window);
    this->Interactor->Enable();
    this->Shown.Window->SetSize(900, 900);
    this->Shown.LookAt(this->Bounds);
    this->Shown.Renderer->AddObserver(vtkCommand::StartEvent, this, &Window::Begins);
    this->Shown.Renderer->AddObserver(vtkCommand::EndEvent, this, &Window::Ends);
  }

  void Begins()
  {
    if (this->TurnsInside)
    {
      this->Interactor->Turn();
    }
  }
  void Ends() { ++this->Renders; }

  bool IsExact() { return this->Mapper->GetStatistics()->GetPictureIsExact() != 0; }

  /// Turns the loop until the picture is exact, or half a minute is over.
  bool BecomesExact(const std::function<bool()>& others = [] { return true; })
  {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!(this->IsExact() && others()) && std::chrono::steady_clock::now() < end)
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      this->Interactor->Turn();
    }
    return this->IsExact() && others();
  }

  std::vector<unsigned char> Synchronous()
  {
    this->Mapper->DecoupledOff();
    std::vector<unsigned char> pixels = this->Shown.Draw();
    this->Mapper->DecoupledOn();
    return pixels;
  }
};

void TheExactPictureComesByItself(Window& window)
{
  const std::vector<unsigned char> first = window.Shown.Draw();
  Check(!window.IsExact(), "the first picture is a coarse one");
  Check(window.Interactor->Timers.size() == 1, "a timer looks for the exact one");
  Check(window.BecomesExact(), "and shows it");
  std::cout << "an exact picture takes " << window.Mapper->GetStatistics()->GetRenderSeconds()
            << " s\n";
  Check(window.Interactor->Timers.empty(), "the timer is gone then");
  const std::vector<unsigned char> exact = window.Shown.Draw();
  Check(window.IsExact(), "it stays");
  Check(exact == window.Synchronous(), "it is the picture that one may wait for, bit for bit");
}

void OtherScenesStopIt(Window& window)
{
  for (int turn = 0; turn < 5; ++turn)
  {
    window.Shown.Renderer->GetActiveCamera()->Azimuth(3.0);
    window.Shown.Draw();
  }
  Check(window.BecomesExact(), "the last of several pictures becomes exact");
  const std::vector<unsigned char> exact = window.Shown.Draw();
  Check(exact == window.Synchronous(), "and is that of the last camera");
  window.Source->SetStandardDeviation(0.3);
  window.Shown.Draw();
  window.Source->SetStandardDeviation(0.7); // while the thread reads what it was
  window.Shown.Draw();
  Check(window.BecomesExact(), "other data become exact, too");
  const std::vector<unsigned char> data = window.Shown.Draw();
  Check(data == window.Synchronous(), "and are the last ones");
}

void WhoSavesAPictureWaits(Window& window)
{
  window.Shown.Renderer->GetActiveCamera()->Azimuth(3.0);
  window.Shown.Window->SwapBuffersOff();
  const std::vector<unsigned char> saved = window.Shown.Draw();
  window.Shown.Window->SwapBuffersOn();
  Check(window.IsExact(), "a window that does not swap its buffers is waited for");
  Check(saved == window.Synchronous(), "and exact");
}

/// While somebody moves the camera and holds still, the exact picture comes, too.
void APauseIsEnough(Window& window)
{
  window.Shown.Window->SetDesiredUpdateRate(5.0);
  window.Shown.Renderer->GetActiveCamera()->Azimuth(3.0);
  window.Shown.Draw();
  Check(!window.IsExact(), "a picture of a moving camera is a coarse one");
  Check(window.BecomesExact(), "and becomes exact when nothing moves");
  const std::vector<unsigned char> held = window.Shown.Draw();
  window.Shown.Window->SetDesiredUpdateRate(0.001);
  Check(held == window.Synchronous(), "bit for bit");
}

/// Timers also run inside of a render, and of work that shows its progress.
void NothingIsRenderedInsideOfOtherWork(Window& window)
{
  window.Shown.Renderer->GetActiveCamera()->Azimuth(3.0);
  window.Shown.Draw();
  std::this_thread::sleep_for(std::chrono::seconds(2)); // the picture is there, or soon
  window.Renders = 0;
  bool busy = true;
  window.Mapper->SetIsBusy([&busy] { return busy; });
  window.Interactor->Turn();
  Check(window.Renders == 0, "nothing is rendered while other work is at it");
  busy = false;
  window.TurnsInside = true;
  window.Shown.Renderer->GetActiveCamera()->Azimuth(3.0);
  window.Shown.Draw();
  window.TurnsInside = false;
  Check(window.Renders == 1, "and nothing inside of a render");
  Check(window.BecomesExact(), "it comes later");
  window.Mapper->SetIsBusy([] { return false; });
}

/// Two volumes of one window: each has a thread of its own.
void TwoVolumesBecomeExact(Window& window)
{
  vtkNew<vtkRTAnalyticSource> source;
  source->SetWholeExtent(-60, 60, -60, 60, -60, 60);
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetInputConnection(source->GetOutputPort());
  mapper->SetImageErrorTolerance(0.03);
  mapper->DecoupledOn();
  mapper->SetNumberOfThreads(1);
  vtkNew<vtkVolume> volume;
  volume->SetMapper(mapper);
  volume->SetProperty(window.Shown.Volume->GetProperty());
  volume->SetPosition(200.0, 0.0, 0.0);
  window.Shown.Renderer->AddViewProp(volume);
  window.Shown.Renderer->GetActiveCamera()->Azimuth(3.0);
  window.Shown.Draw();
  const auto exact = [&] { return mapper->GetStatistics()->GetPictureIsExact() != 0; };
  Check(!window.IsExact() && !exact(), "both begin coarse");
  Check(window.BecomesExact(exact), "both become exact");
  const std::vector<unsigned char> late = window.Shown.Draw();
  mapper->DecoupledOff();
  Check(late == window.Synchronous(), "and are what one may wait for");
  window.Shown.Renderer->RemoveViewProp(volume);
}

/// A volume that two renderers of a window show is waited for: it would begin both in turns.
void TwoRenderersWait(Window& window)
{
  window.BecomesExact();
  vtkNew<vtkRenderer> second;
  second->SetViewport(0.0, 0.0, 0.4, 0.4);
  second->SetLayer(0);
  second->AddViewProp(window.Shown.Volume);
  window.Shown.Window->AddRenderer(second);
  second->ResetCamera();
  for (int i = 0; i < 3; ++i)
  {
    window.Shown.Renderer->GetActiveCamera()->Azimuth(3.0);
    window.Shown.Draw();
    Check(i == 0 || window.IsExact(), "a volume in two renderers is exact at once");
  }
  window.Shown.Window->RemoveRenderer(second);
}

} // namespace

int main()
{
  Window window;
  TheExactPictureComesByItself(window);
  OtherScenesStopIt(window);
  WhoSavesAPictureWaits(window);
  APauseIsEnough(window);
  NothingIsRenderedInsideOfOtherWork(window);
  TwoVolumesBecomeExact(window);
  TwoRenderersWait(window);
  return Failures() == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
