// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkBanyanVolume_h
#define vtkBanyanVolume_h

#include "BanyanRepresentationsModule.h" // for export macro
#include "vtkPVLODVolume.h"
#include "vtkSmartPointer.h" // for member
#include "vtkWeakPointer.h"  // for members

#include <array>  // for member
#include <memory> // for member
#include <string> // for member
#include <vector> // for member

namespace banyan
{
class CoarseMark;
class FramebufferExchange;
class PicturesAtHand;
class WallBox;
struct DepthPicture;
struct DrawnPart;
}

class vtkBanyanVolumeMapper;
class vtkDataObject;
class vtkOpenGLFXAAFilter;
class vtkPVRenderView;
class vtkRenderer;

/**
 * @class vtkBanyanVolume
 * @brief the prop of the representation "Banyan Volume": draws collectively in the overlay pass
 *
 * ParaView composites opaque and translucent geometry of all ranks by IceT after everything is
 * drawn. This prop composites by itself before that: on every rank, whatever data it has, in the
 * overlay pass, which runs exactly once per rank and frame (the volumetric pass does not, under
 * depth peeling). Documentation/architecture.md tells the whole story.
 */
class BANYANREPRESENTATIONS_EXPORT vtkBanyanVolume : public vtkPVLODVolume
{
public:
  static vtkBanyanVolume* New();
  vtkTypeMacro(vtkBanyanVolume, vtkPVLODVolume);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /** The mapper that draws; not owned. */
  void SetBanyanMapper(vtkBanyanVolumeMapper* mapper);

  /** The view that draws this prop; decides how pixels of other ranks combine. Not owned. */
  void SetView(vtkPVRenderView* view);

  /** Pictures that this prop shows in place of drawing; null (default) to draw. */
  void SetPictures(const std::shared_ptr<banyan::PicturesAtHand>& pictures);
  bool HasPictures() const { return this->Pictures != nullptr; }

  /** Whether the view is on a tile display, or in a CAVE. */
  bool IsOnWall() const;

  /**
   * Shows the box of the volume in place of the volume: on a client whose server has displays.
   * @param corners what ranks have sent of their pieces
   */
  void ShowBox(vtkDataObject* corners);

  /** Whether a mark in the corner of the view says that the picture is not exact yet. */
  void SetMarksCoarse(bool marks) { this->MarksCoarse = marks; }

  /**
   * Draws on tile displays and in CAVEs when a renderer of the view has ended: there, ranks have
   * pictures of their own, and their passes are not called alike. Null for none.
   */
  void DrawWhenEnded(vtkRenderer* renderer);

  int RenderOpaqueGeometry(vtkViewport* viewport) override;
  int RenderVolumetricGeometry(vtkViewport* viewport) override;
  int RenderTranslucentPolygonalGeometry(vtkViewport* viewport) override;
  int RenderOverlay(vtkViewport* viewport) override;
  vtkTypeBool HasTranslucentPolygonalGeometry() override;

  /** Bounds of the whole volume on every rank: IceT drops pixels outside a rank's own bounds. */
  double* GetBounds() VTK_SIZEHINT(6) override;
  using Superclass::GetBounds;

  void ReleaseGraphicsResources(vtkWindow* window) override;

protected:
  vtkBanyanVolume();
  ~vtkBanyanVolume() override;

private:
  vtkBanyanVolume(const vtkBanyanVolume&) = delete;
  void operator=(const vtkBanyanVolume&) = delete;

  void ShowPictures(vtkRenderer* renderer);
  void MarkUnless(bool exact, vtkRenderer* renderer);
  bool DrawsOnWall(vtkRenderer* renderer);
  bool DrawsForAll(vtkRenderer* renderer);
  void KeepDrawnPart(vtkRenderer* renderer);
  void ReadDepths(vtkObject* caller, unsigned long event, void* data);
  void DrawOnWall(vtkObject* caller, unsigned long event, void* data);
  void SmoothEdges(vtkObject* caller, unsigned long event, void* data);

  vtkWeakPointer<vtkBanyanVolumeMapper> BanyanMapper;
  vtkWeakPointer<vtkPVRenderView> View;
  vtkSmartPointer<vtkOpenGLFXAAFilter> EdgeFilter;
  std::shared_ptr<banyan::PicturesAtHand> Pictures;
  std::unique_ptr<banyan::WallBox> Box;     ///< null where the volume is drawn
  std::unique_ptr<banyan::CoarseMark> Mark; ///< null until there was one
  bool MarksCoarse = false;
  unsigned long SmoothAtEnd = 0;
  vtkWeakPointer<vtkRenderer> Watched;
  std::array<unsigned long, 2> OfWatched{};
  std::unique_ptr<banyan::FramebufferExchange> Framebuffer; ///< null until a display was read
  std::unique_ptr<banyan::DepthPicture> Depths;             ///< of a CAVE's display
  std::vector<banyan::DrawnPart> Drawn;                     ///< for tiles, since the last picture
  std::string WallNote;                                     ///< that was told
};

#endif
