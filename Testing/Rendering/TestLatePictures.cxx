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
#include <thread>

using namespace mapper_testing;

/// Has the name of that of ParaView's windows, and timers that the test turns.
class QVTKInteractor : public vtkRenderWindowInteractor
{
public:
  static QVTKInteractor* New();
  vtkTypeMacro(QVTKInteractor, vtkRenderWindowInteractor);

  int Timers = 0;

  /// What the loop of a window does.
  void Turn() { this->InvokeEvent(vtkCommand::TimerEvent, &this->LastTimer); }

protected:
  int InternalCreateTimer(int timer, int, unsigned long) override
  {
    this->LastTimer = timer;
    return ++this->Timers;
  }
  int InternalDestroyTimer(int) override { return --this->Timers >= 0; }

private:
  int LastTimer = 0;
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

  Window()
  {
    this->Source->SetWholeExtent(-60, 60, -60, 60, -60, 60);
    this->Mapper->SetInputConnection(this->Source->GetOutputPort());
    this->Mapper->SetImageErrorTolerance(0.1); // takes longer than one waits for
    this->Mapper->SetNumberOfThreads(1);
    this->Mapper->DecoupledOn();
    this->Interactor->SetRenderWindow(this->Shown.Window);
    this->Interactor->Enable();
    this->Shown.Window->SetSize(500, 500);
    this->Shown.LookAt(this->Bounds);
  }

  bool IsExact() { return this->Mapper->GetStatistics()->GetPictureIsExact() != 0; }

  /// Turns the loop until the picture is exact, or half a minute is over.
  bool BecomesExact()
  {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!this->IsExact() && std::chrono::steady_clock::now() < end)
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      this->Interactor->Turn();
    }
    return this->IsExact();
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
  Check(window.Interactor->Timers == 1, "a timer looks for the exact one");
  Check(window.BecomesExact(), "and shows it");
  Check(window.Interactor->Timers == 0, "the timer is gone then");
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

} // namespace

int main()
{
  Window window;
  TheExactPictureComesByItself(window);
  OtherScenesStopIt(window);
  WhoSavesAPictureWaits(window);
  return Failures() == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
