// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkBanyanVolumeMapper_h
#define vtkBanyanVolumeMapper_h

#include "BanyanRenderingModule.h" // for export macro
#include "vtkSmartPointer.h"       // for member
#include "vtkVolumeMapper.h"

#include <functional> // for argument
#include <memory>     // for member
#include <vector>     // for argument

namespace banyan
{
class Backdrop;
class DepthOrder;
struct CompositeStatistics;
struct FloatImage;
struct VolumeOnScreen;
}

class vtkBanyanFrameStatistics;
class vtkDataArray;
class vtkDataObject;
class vtkMultiProcessController;

/**
 * @class vtkBanyanVolumeMapper
 * @brief draws image data, encoded or plain, meshes of hexahedra that are the leaves of an octree,
 * hyper tree grids and overlapping AMR, on one rank or many, with Banyan's own ray caster
 *
 * Use it like any volume mapper: give it image data (the output of vtkBanyanSeriesReader draws
 * without being decoded), or an unstructured grid of axis-aligned hexahedra or voxels (each is
 * drawn as the trilinear element that it is; vtkBanyanHexOctree says what is wrong with others), a
 * vtkHyperTreeGrid or a vtkOverlappingAMR (their visible leaves are such elements), and put it into
 * a vtkVolume with a colour and an opacity function. Rays end at opaque geometry that was drawn
 * before.
 *
 * With a controller of several ranks, Render() is collective: each rank draws its zone and rank 0
 * receives the finished picture, opaque geometry of all ranks included; the other ranks are left
 * blank where the volume may be, so that a sort-last compositor keeps rank 0's pixels.
 *
 * The picture does not depend on the number of ranks or threads: at most 1/255 per channel.
 *
 * With several volumes in one renderer, on the same ranks, the first that is rendered draws all, in
 * the order of depth, wherever a plane separates their boxes; for others, and for translucent
 * surfaces or other volumes that are not behind them, a warning says once what is not exact.
 *
 * Blend modes composite, maximum, minimum and average intensity; clipping planes, and cropping to
 * the inside of a box; shading; linear interpolation or, as vtkVolumeProperty has it by default,
 * that of the nearest point. All as VTK's own volume mappers know them, and the same on all ranks.
 *
 * @par Limits: point data, and cell data of what is not image data, made nodal (see
 * banyan::CellNodes); component 0 of the property, which draws one component of the data or
 * their magnitude, as the vector mode of its colour function says; lights other than the viewer's
 * are ignored, and so is shading in modes other than composite. Averages are grey, from the lowest
 * to the highest value of the data (of all steps of an encoded series). Options that are set and
 * have no effect (gradient opacity, 2D transfer functions, and more: see banyan::IgnoredOptions)
 * are named in a warning, once. vtkVolumePicker and vtkCellPicker pick image data; hardware
 * selection (vtkPropPicker, vtkHardwareSelector) does not see the volume. SetAbortExecute(1) stops
 * what a general mesh takes before its first picture: it is not drawn until the mesh, or an option
 * of it, is another.
 *
 * @par Errors: Render() throws nothing. What cannot be drawn is said by an ErrorEvent, once as long
 * as it stays the same; nothing of the volume is drawn then, on any rank.
 */
class BANYANRENDERING_EXPORT vtkBanyanVolumeMapper : public vtkVolumeMapper
{
public:
  static vtkBanyanVolumeMapper* New();
  vtkTypeMacro(vtkBanyanVolumeMapper, vtkVolumeMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Largest error of a pixel that is wanted, in 1/255 of a channel: of still frames (default 1),
   * and while interacting, that is, while the window asks for more than one frame per second
   * (default 8). It decides how closely each part of the picture is sampled, and from which level
   * of an encoded series or a mesh of hexahedra. The error is estimated (see banyan::PlanSamplings)
   * and goes to the statistics. Allowed [0.05, 255]. Without effect on projections and nearest
   * interpolation.
   */
  virtual void SetImageErrorTolerance(double number);
  vtkGetMacro(ImageErrorTolerance, double);
  virtual void SetInteractiveImageErrorTolerance(double number);
  vtkGetMacro(InteractiveImageErrorTolerance, double);
  ///@}

  ///@{
  /**
   * Seconds that a frame may take while interacting: the tolerance is raised, up to 16-fold, while
   * frames take longer, and projections and labels, which have no tolerance, are drawn from coarser
   * levels. Default 0.2; 0 for as long as it takes.
   */
  virtual void SetInteractiveFrameSeconds(double number);
  vtkGetMacro(InteractiveFrameSeconds, double);
  ///@}

  ///@{
  /**
   * Whether still frames that follow an interaction are drawn in passes: the first with the
   * tolerance of interaction, each next one that RefineNext() asked for with a quarter of the one
   * before, until ImageErrorTolerance is kept. Never worse than the frame before it. Off by
   * default.
   */
  vtkSetMacro(RefineInPasses, bool);
  vtkGetMacro(RefineInPasses, bool);
  vtkBooleanMacro(RefineInPasses, bool);
  ///@}

  /**
   * Makes the next frame the next pass. To be called on all ranks. False when there is none: the
   * last frame kept the tolerance.
   */
  bool RefineNext();

  ///@{
  /**
   * A fixed distance between samples along a ray, in edges of the smallest cell, in place of the
   * tolerance. Opacities are corrected for it. While interacting, frames that take longer than
   * InteractiveFrameSeconds are drawn from coarser levels, whose distances are longer by as much.
   * Default 0: the tolerance decides (projections and nearest interpolation take 1). Allowed
   * [0, 100].
   */
  virtual void SetSampleDistanceVoxels(double number);
  vtkGetMacro(SampleDistanceVoxels, double);
  ///@}

  ///@{
  /**
   * How many pixels long cells may be, in place of the tolerance: each tile of 32 x 32 pixels is
   * drawn from the coarsest level whose cells are no longer where the volume is nearest to the eye
   * (banyan::SamplingsByScreen), one sample per cell, or as far apart as SampleDistanceVoxels says.
   * The size of cells decides, whatever their values are: no error is estimated. Default 0: the
   * tolerance decides. Allowed [0, 1024]. Without effect on projections and nearest interpolation.
   */
  virtual void SetScreenErrorPixels(double number);
  vtkGetMacro(ScreenErrorPixels, double);
  ///@}

  ///@{
  /**
   * How far the points of hexahedra may lie beside the lattice of their octree, in edges of the
   * smallest cell: they are drawn as if they were there. Default 1/1024; allowed [0, 1/16]. More
   * than the default is for meshes whose points were moved by the displacements that they carry.
   */
  virtual void SetMeshTolerance(double number);
  vtkGetMacro(MeshTolerance, double);
  ///@}

  ///@{
  /**
   * How closely hexahedra that are no octree of boxes (curved, warped, with topography) are
   * sampled: the largest difference from their own field that is allowed between samples, as a part
   * of the spread of the values around, whatever they are (banyan::CubeDeviation). Default 1/4;
   * allowed [0, 1]; 0: such meshes are refused with a sentence that says which cell does not fit.
   * The statistic MeshDeviation says what was reached.
   */
  virtual void SetMeshSamplingTolerance(double number);
  vtkGetMacro(MeshSamplingTolerance, double);
  ///@}

  ///@{
  /**
   * How many boxes they may take; where more would be needed, they stay coarser, with a warning.
   * Default 2^20; each takes about 200 bytes.
   */
  vtkSetClampMacro(MeshSamplingBoxes, int, 1024, 1 << 26);
  vtkGetMacro(MeshSamplingBoxes, int);
  ///@}

  ///@{
  /**
   * The most elements of a mesh of hexahedra that may show in a pixel: where more would show under
   * all of a tile of the picture (banyan::FinestLevelsOfTiles), it is drawn from a coarser level,
   * whatever ImageErrorTolerance asks for; the estimated error says what that costs. Default 0: any
   * number, so that the tolerance alone decides. Without effect on other data, and with
   * SampleDistanceVoxels.
   */
  virtual void SetMaxElementsPerPixel(double number);
  vtkGetMacro(MaxElementsPerPixel, double);
  ///@}

  ///@{
  /**
   * Brings out what moves from one step of an encoded series to the next, while it is drawn: the
   * strength of banyan::TemporalEnhancement, in [0, 1]. Its scale is the largest magnitude that the
   * opacity function knows. Of plain data the steps around must be there as point arrays
   * (banyan::MotionEnhancement); the representation sees to that. Default 0: values are drawn as
   * they are. vtkBanyanTemporalEnhancement does the same to data.
   */
  virtual void SetTemporalEnhancement(double number);
  vtkGetMacro(TemporalEnhancement, double);
  ///@}

  ///@{
  /**
   * Whether pixels travel between ranks in as few bits as keep each of them within 1/255 of one
   * rank's, and packed: far fewer bytes than floats. Where a background is blended behind
   * the picture later, in 8 bits, as ParaView does, a few pixels may then differ by 2/255. Default
   * off: floats, which are within 1/255 there too. Without effect on projections, and
   * while several volumes are on the screen.
   */
  vtkSetMacro(CompositeInFewBits, bool);
  vtkGetMacro(CompositeInFewBits, bool);
  vtkBooleanMacro(CompositeInFewBits, bool);
  ///@}

  ///@{
  /**
   * Threads that cast rays and decode in this process; 0 (default) takes the cores divided by the
   * ranks on this machine.
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, 1024);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /**
   * How the zones of the ranks follow what frames cost: 0 not at all, 2 (default) to where
   * measured costs balance, and 1, which was another way, the same. Bricks of plain image data go
   * from rank to rank for it; meshes are on all ranks. The same on all ranks. The picture does not
   * change.
   */
  vtkSetClampMacro(LoadBalancing, int, 0, 2);
  vtkGetMacro(LoadBalancing, int);
  ///@}

  ///@{
  /**
   * Whether what the next frame of an encoded series needs is decoded in the background while a
   * frame is composited and shown. If it plays: the bricks of the next time step that were drawn of
   * this one, within half of what the cache has for decoded bricks. If the camera moves: bricks
   * that come onto the screen when it goes on as it went, within a quarter. Default on.
   */
  vtkSetMacro(ReadAhead, bool);
  vtkGetMacro(ReadAhead, bool);
  vtkBooleanMacro(ReadAhead, bool);
  ///@}

  /**
   * Ranks that draw together; null (default) for this process alone. Collective over the
   * controller's ranks when it changes.
   */
  virtual void SetController(vtkMultiProcessController* controller);
  vtkMultiProcessController* GetController();

  /**
   * Where statistics go after each frame; never null.
   */
  virtual void SetStatistics(vtkBanyanFrameStatistics* statistics);
  vtkBanyanFrameStatistics* GetStatistics();

  /**
   * How the pixels of all ranks that lie behind the volume combine: by depth (empty, the default),
   * or, when the surrounding compositor blends ranks in an order, that order, front first.
   */
  void SetRankOrderBehind(const std::vector<int>& frontToBack);

  /**
   * Collective: agrees on the field with all ranks, so that GetBounds() and Render() can be used.
   * Render() does this by itself when needed.
   */
  void UpdateField(vtkVolume* volume);

  /**
   * The point or cell array of `data` that the mapper's scalar mode selects; with the default mode
   * the active scalars, or the first array of numbers. Of blocks, that of the first one. Null if
   * there is none.
   */
  vtkDataArray* GetArrayToDraw(vtkDataObject* data);

  /**
   * Bounds of the whole field, over all ranks, once UpdateField() or Render() was called; those of
   * the input before. Of a rank that is alone also those of another input, or one that has changed.
   */
  double* GetBounds() VTK_SIZEHINT(6) override;
  using Superclass::GetBounds;

  void Render(vtkRenderer* renderer, vtkVolume* volume) override;
  void ReleaseGraphicsResources(vtkWindow* window) override;

protected:
  vtkBanyanVolumeMapper();
  ~vtkBanyanVolumeMapper() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;

private:
  vtkBanyanVolumeMapper(const vtkBanyanVolumeMapper&) = delete;
  void operator=(const vtkBanyanVolumeMapper&) = delete;

  struct Frame;

  bool PrepareFrame(vtkRenderer* renderer, Frame& frame);
  banyan::FloatImage CastFrame(
    vtkRenderer* renderer, const banyan::Backdrop& backdrop, int volumes, Frame& drawn);
  void FinishFrame(
    const Frame& drawn, const banyan::CompositeStatistics& geometry, double writeSeconds);
  void DrawTogether(vtkRenderer* renderer, std::vector<Frame>& frames);
  void DrawPrepared(vtkRenderer* renderer, std::vector<Frame>& frames);
  void TellNotInDepth(vtkRenderer* renderer, const std::vector<Frame>& frames,
    const std::vector<banyan::VolumeOnScreen>& volumes, const banyan::DepthOrder& order);
  bool Attempt(const std::function<bool()>& work);
  void EndFrame(vtkObject* caller, unsigned long event, void* data);
  void ReportOnce(const std::string& problem);
  void WarnOnce(const std::string& note, std::string& last);

  double ImageErrorTolerance = 1.0;
  double InteractiveImageErrorTolerance = 8.0;
  double InteractiveFrameSeconds = 0.2;
  bool RefineInPasses = false;
  double SampleDistanceVoxels = 0.0;
  double ScreenErrorPixels = 0.0;
  double MeshTolerance = 1.0 / 1024;
  double MeshSamplingTolerance = 0.25;
  int MeshSamplingBoxes = 1 << 20;
  double MaxElementsPerPixel = 0.0;
  double TemporalEnhancement = 0.0;
  bool CompositeInFewBits = false;
  int NumberOfThreads = 0;
  int LoadBalancing = 2;
  bool ReadAhead = true;
  vtkSmartPointer<vtkMultiProcessController> Controller;
  vtkSmartPointer<vtkBanyanFrameStatistics> Statistics;

  struct Internals;
  std::unique_ptr<Internals> Self;
};

#endif
