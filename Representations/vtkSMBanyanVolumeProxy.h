// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMBanyanVolumeProxy
 * @brief   the proxy of "Banyan Volume", which chooses an array as ParaView's own "Volume" does
 *
 * When the representation type of the display that this proxy is a part of becomes "Banyan Volume",
 * and the display has no array to colour by, the first point array (else the first array) is
 * chosen, with its colour map and opacity function. Their range becomes that of the data, or grows
 * to it where another display uses the map and the map may be rescaled. An array that was chosen
 * stays, and so does what a state file says.
 *
 * ParaView does this itself, in vtkSMPVRepresentationProxy::SetRepresentationType, but only for
 * types that it knows by name.
 *
 * In ParaView's window, whose panel shows statistics of the last frame, they are fetched after each
 * frame but those that are drawn while the camera moves.
 *
 * It also says, once each, which properties of the display are set and have no effect on this type:
 * here, because proxies are where the user is, whatever processes draw.
 */
#ifndef vtkSMBanyanVolumeProxy_h
#define vtkSMBanyanVolumeProxy_h

#include "BanyanRepresentationsModule.h" // For export macro
#include "vtkSMRepresentationProxy.h"
#include "vtkWeakPointer.h" // for members

#include <set>    // for members
#include <string> // for members

class vtkSMPVRepresentationProxy;

class BANYANREPRESENTATIONS_EXPORT vtkSMBanyanVolumeProxy : public vtkSMRepresentationProxy
{
public:
  static vtkSMBanyanVolumeProxy* New();
  vtkTypeMacro(vtkSMBanyanVolumeProxy, vtkSMRepresentationProxy);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void ViewUpdated(vtkSMProxy* view) override;

protected:
  vtkSMBanyanVolumeProxy() = default;
  ~vtkSMBanyanVolumeProxy() override;

  void CreateVTKObjects() override;

private:
  vtkSMBanyanVolumeProxy(const vtkSMBanyanVolumeProxy&) = delete;
  void operator=(const vtkSMBanyanVolumeProxy&) = delete;

  vtkSMPVRepresentationProxy* Display();
  bool IsShown();
  void TypeChanged();
  /// Hides the scalar bar that was shown for the chosen array, once nothing has its colours: the
  /// window does so only where the colours are changed by hand, not by a script that runs in it.
  void ColorsChanged();
  void FrameDrawn(vtkObject* view, unsigned long event, void* interactive);

  std::set<std::string> Said;      ///< properties without effect
  vtkWeakPointer<vtkSMProxy> View; ///< whose frames are observed
  unsigned long ViewObserver = 0;
  vtkWeakPointer<vtkSMProxy> MapOfBar; ///< whose scalar bar was shown when the array was chosen
};

#endif
