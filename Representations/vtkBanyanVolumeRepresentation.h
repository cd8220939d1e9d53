// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkBanyanVolumeRepresentation_h
#define vtkBanyanVolumeRepresentation_h

#include "BanyanRepresentationsModule.h" // for export macro
#include "vtkBanyanVolume.h"             // for members
#include "vtkBanyanVolumeMapper.h"       // for the table of settings
#include "vtkNew.h"                      // for members
#include "vtkSmartPointer.h"             // for members
#include "vtkVolumeRepresentation.h"

#include <memory> // for members

class vtkBanyanFrameStatistics;
class vtkBanyanVolume;
class vtkDataArray;
class vtkDataObject;
class vtkPVRenderView;

namespace banyan
{
class DefaultFunctions;
class FunctionWatch;
class MergedBlocks;
class PictureServer;
class PicturesAtHand;
class StepWindow;
}

/**
 * @class vtkBanyanVolumeRepresentation
 * @brief ParaView's representation "Banyan Volume" of image data, encoded or plain, and of
 * meshes of any cells
 *
 * Draws in parallel with its own compositing; data is never redistributed. Colour map, opacity
 * function and opacity unit distance are those of ParaView's own "Volume". With no array selected
 * ("Solid Color") the active or first point array is drawn with a default colour map.
 *
 * @par Limits: as vtkBanyanVolumeMapper; tile displays and CAVEs are refused with a message.
 */
class BANYANREPRESENTATIONS_EXPORT vtkBanyanVolumeRepresentation : public vtkVolumeRepresentation
{
public:
  static vtkBanyanVolumeRepresentation* New();
  vtkTypeMacro(vtkBanyanVolumeRepresentation, vtkVolumeRepresentation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  int ProcessViewRequest(
    vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo) override;

  ///@{
  /**
   * Whether a server draws for the window of its client, which shows pictures as they come
   * (banyan::ServedWindow): told to the client and all ranks of the server before an update of the
   * view, of which this is the only data.
   */
  void SetServed(bool served);
  /**
   * Collective over the ranks of a server: what the client wants, as numbers and depths of
   * banyan::PictureTicket.
   */
  void TakeTicket(double* numbers, unsigned int words, unsigned int* depths);
  /** Of all settings and functions. */
  vtkMTimeType GetPictureMTime();
  /** Of a client that is served, else null. */
  std::shared_ptr<banyan::PicturesAtHand> GetPictures() const { return this->Pictures; }
  /** Where the user has placed the volume: from its data's space to the world. */
  vtkMatrix4x4* GetPlace() { return this->Prop->GetMatrix(); }
  ///@}

  ///@{
  /** Colour map and opacity function; null takes a default over the range of the data. */
  void SetColor(vtkColorTransferFunction* colors);
  void SetScalarOpacity(vtkPiecewiseFunction* opacity);
  ///@}

  /**
   * Whether the colour map colours what is drawn (default), or three and four components of image
   * data are the colours: see vtkBanyanVolumeMapper.
   */
  void SetMapScalars(bool map);

  ///@{
  /** The settings of vtkBanyanVolumeMapper's table are handed on to it. */
#define BANYAN_REAL(Name, ...) void Set##Name(double value);
#define BANYAN_WHOLE(Name, ...) void Set##Name(int value);
#define BANYAN_SWITCH(Name, ...) void Set##Name(bool value);
  BANYAN_VOLUME_SETTINGS(BANYAN_REAL, BANYAN_WHOLE, BANYAN_SWITCH, BANYAN_WHOLE)
#undef BANYAN_REAL
#undef BANYAN_WHOLE
#undef BANYAN_SWITCH
  ///@}

  ///@{
  /** Gradient shading with the light at the viewer, and its coefficients: as vtkVolumeProperty. */
  void SetShade(bool shade);
  void SetAmbient(double coefficient);
  void SetDiffuse(double coefficient);
  void SetSpecular(double coefficient);
  void SetSpecularPower(double power);
  ///@}

  /** Whether a mark in the corner of the view says that the picture is not exact yet. */
  void SetMarkCoarsePictures(bool marks);

  ///@{
  /**
   * Between points the value of the nearest one is drawn, if either says so. InterpolationType (a
   * number of vtkVolumeProperty; more than linear is drawn as linear, the default) is a property of
   * ParaView's own volumes, but on no panel.
   */
  void SetInterpolationType(int type);
  void SetNearestPoint(bool nearest);
  ///@}

  ///@{
  /**
   * How samples along a ray become a pixel: a number of vtkVolumeMapper. BlendMode is the property
   * of ParaView's own volumes, whose panel offers composite, isosurface and slice only; where it is
   * composite (default), Projection counts. Isosurfaces and slices are refused with a message.
   */
  void SetBlendMode(int mode);
  void SetProjection(int mode);
  ///@}

  ///@{
  /**
   * Shows the inside of a box only, in the coordinates of the data: the bounds of the data (of all
   * ranks) times the scale, plus the origin, as ParaView's own volumes do.
   */
  void SetCropping(int cropping);
  void SetCroppingOrigin(double x, double y, double z);
  void SetCroppingOrigin(double origin[3]);
  void SetCroppingScale(double x, double y, double z);
  void SetCroppingScale(double scale[3]);
  ///@}

  /** Where the statistics of each frame go. */
  void SetStatistics(vtkBanyanFrameStatistics* statistics);

protected:
  vtkBanyanVolumeRepresentation();
  ~vtkBanyanVolumeRepresentation() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  bool AddToView(vtkView* view) override;
  bool RemoveFromView(vtkView* view) override;

private:
  bool IsNumber(const char* property, double value, bool mayBeNegative = false);

  vtkBanyanVolumeRepresentation(const vtkBanyanVolumeRepresentation&) = delete;
  void operator=(const vtkBanyanVolumeRepresentation&) = delete;

  void NoteStepsNeeded();
  void TakeSteps();
  void AddSteps(vtkDataArray* array);
  vtkSmartPointer<vtkDataObject> PieceIn(vtkPVRenderView* view);
  void PrepareRender(vtkDataObject* piece);
  void ShowProgress();
  void PlaceCroppingBox();
  void SelectArray();
  void FunctionChanged();

  vtkNew<vtkBanyanVolumeMapper> Mapper;
  vtkSmartPointer<vtkBanyanVolume> Prop;
  vtkSmartPointer<vtkDataObject> Piece;
  std::unique_ptr<banyan::MergedBlocks> Blocks; ///< of blocks that are drawn as one mesh
  std::unique_ptr<banyan::DefaultFunctions> Defaults;
  std::unique_ptr<banyan::StepWindow> Steps; ///< around the one drawn, if motion is brought out
  int InterpolationType = 1;
  bool NearestPoint = false;
  int BlendMode = 0;
  int Projection = 0;
  double CroppingOrigin[3] = { 0.0, 0.0, 0.0 };
  double CroppingScale[3] = { 1.0, 1.0, 1.0 };
  std::unique_ptr<banyan::FunctionWatch> Colors; ///< changes are shown at once
  std::unique_ptr<banyan::FunctionWatch> Opacity;
  bool ColorGiven = false;
  bool OpacityGiven = false;
  bool WallTold = false;
  bool StepsNeeded = false; ///< around the one drawn
  bool Served = false;
  std::shared_ptr<banyan::PicturesAtHand> Pictures; ///< on a client
  std::unique_ptr<banyan::PictureServer> Server;    ///< of a client, where this is its server
};

#endif
