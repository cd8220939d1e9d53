/**
 * @class   vtkSMBanyanVolumeProxy
 * @brief   the proxy of "Banyan Volume", which chooses an array as ParaView's own "Volume" does
 *
 * When the representation type of the display that this proxy is a part of becomes "Banyan Volume",
 * and the display has no array to colour by, the first point array (else the first array) is chosen,
 * with its colour map and opacity function. Their range becomes that of the data, or grows to it where
 * another display uses the map and the map may be rescaled. An array that was chosen stays, and so does
 * what a state file says.
 *
 * ParaView does this itself, in vtkSMPVRepresentationProxy::SetRepresentationType, but only for types
 * that it knows by name.
 */
#ifndef vtkSMBanyanVolumeProxy_h
#define vtkSMBanyanVolumeProxy_h

#include "BanyanRepresentationsModule.h" // For export macro
#include "vtkSMRepresentationProxy.h"

class vtkSMPVRepresentationProxy;

class BANYANREPRESENTATIONS_EXPORT vtkSMBanyanVolumeProxy : public vtkSMRepresentationProxy
{
public:
  static vtkSMBanyanVolumeProxy* New();
  vtkTypeMacro(vtkSMBanyanVolumeProxy, vtkSMRepresentationProxy);
  void PrintSelf(ostream& os, vtkIndent indent) override;

protected:
  vtkSMBanyanVolumeProxy() = default;
  ~vtkSMBanyanVolumeProxy() override = default;

  void CreateVTKObjects() override;

private:
  vtkSMBanyanVolumeProxy(const vtkSMBanyanVolumeProxy&) = delete;
  void operator=(const vtkSMBanyanVolumeProxy&) = delete;

  vtkSMPVRepresentationProxy* Display();
  void TypeChanged();
};

#endif
