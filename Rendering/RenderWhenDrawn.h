// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_RenderWhenDrawn_h
#define banyan_Rendering_RenderWhenDrawn_h

#include "vtkWeakPointer.h"

#include <functional>
#include <utility>

class vtkRenderWindow;
class vtkRenderWindowInteractor;

namespace banyan
{

/// Renders a window again when a picture that was late is there: a timer of its interactor looks.
class RenderWhenDrawn
{
public:
  /// Milliseconds from look to look.
  static constexpr unsigned long Pause = 10;

  RenderWhenDrawn() = default;
  ~RenderWhenDrawn() { this->Stop(); }
  RenderWhenDrawn(const RenderWhenDrawn&) = delete;
  RenderWhenDrawn& operator=(const RenderWhenDrawn&) = delete;

  /// Whether somebody turns the window's event loop, so that timers run: ParaView's windows have an
  /// interactor of Qt. That of a script has none.
  static bool CanWatch(vtkRenderWindow* window);

  /// Begins to look, in place of what was looked at.
  /// @param isDrawn whether the picture is there; not asked while the window renders, or is busy
  void Watch(vtkRenderWindow* window, std::function<bool()> isDrawn);
  void Stop();

  /// Timers also run inside of longer work that shows its progress, where nothing may be rendered.
  /// @param isBusy whether that is so now; by default never
  void SetIsBusy(std::function<bool()> isBusy) { this->IsBusy = std::move(isBusy); }

private:
  void Look(int timer);

  vtkWeakPointer<vtkRenderWindowInteractor> Interactor; ///< null while nothing is looked at
  std::function<bool()> IsDrawn;
  std::function<bool()> IsBusy = [] { return false; };
  int Timer = 0;
  unsigned long Observer = 0;
};

} // namespace banyan

#endif
