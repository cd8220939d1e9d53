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

#include <memory> // for members
#include <set>    // for members
#include <string> // for members
#include <vector> // for members

namespace banyan
{
class PicturesAtHand;
class ServedVolume;
struct PictureTicket;
struct PlacedBox;
}

class vtkSMPVRepresentationProxy;

class BANYANREPRESENTATIONS_EXPORT vtkSMBanyanVolumeProxy : public vtkSMRepresentationProxy
{
public:
  static vtkSMBanyanVolumeProxy* New();
  vtkTypeMacro(vtkSMBanyanVolumeProxy, vtkSMRepresentationProxy);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void ViewUpdated(vtkSMProxy* view) override;

  ///@{
  /** Whether the display is shown as "Banyan Volume", and its window need not wait. */
  bool IsDecoupled();
  /** Tells all processes whether the next pictures of the view come as messages. */
  void SetServed(bool served, vtkSMProxy* view);
  /** Sends a ticket to all ranks of the server; nobody waits for it. */
  void SendTicket(const banyan::PictureTicket& ticket);
  /** Gives the functions of the server the points that those of the client have now. */
  void SendFunctions();
  /** What SetServed has made on the client. */
  std::shared_ptr<banyan::PicturesAtHand> GetPictures();
  /** Whether it is mixed with others of these that share space with it. */
  bool MixesVolumes();
  /** Where the data are in the world, as far as the client knows; nothing where it does not. */
  std::vector<banyan::PlacedBox> GetBody();
  /** Changes with all of the display that a picture shows, but for the camera. */
  vtkMTimeType GetPictureMTime();
  /** Brings the statistics of the last frame to the client. */
  void FetchStatistics();
  ///@}

protected:
  vtkSMBanyanVolumeProxy();
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

  std::unique_ptr<banyan::ServedVolume> Served; ///< in the view; null where it cannot be served
  std::set<std::string> Said;                   ///< properties without effect
  vtkWeakPointer<vtkSMProxy> View;              ///< whose frames are observed
  unsigned long ViewObserver = 0;
  vtkWeakPointer<vtkSMProxy> MapOfBar; ///< whose scalar bar was shown when the array was chosen
};

#endif
