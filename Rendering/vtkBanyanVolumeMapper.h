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
class PictureServer;
class VolumesOnWall;
class VolumesPicture;
struct DepthPicture;
struct MapperState;
struct WallPicture;
}

class vtkBanyanFrameStatistics;
class vtkDataArray;
class vtkDataObject;
class vtkMultiProcessController;
class vtkRenderWindow;

// clang-format off
/// The table of the settings that ParaView offers. A row has the name, the unit, the default, the
/// least and the most that is allowed, where ParaView's slider ends, whether panels have it as
/// "default" or "advanced", and which panels: all, those of images, of cells (meshes, hyper trees
/// and AMR) or of meshes. The last word is the sentence that ParaView shows.
/// CMake/BanyanTables.cmake makes ParaView's XML of it; a Choice has its own XML by hand.
#define BANYAN_VOLUME_SETTINGS(Real, Whole, Switch, Choice)                                        \
  Real(ImageErrorTolerance, 1/255, 1, 0.05, 255, 32, default, all,                                 \
    "Largest error of a pixel that is wanted in still pictures, in 1/255. It decides how "         \
    "closely the volume is sampled, and from which level of an encoded series: smaller is more "   \
    "accurate and slower. Samples get no closer than 1/8 of a voxel: EstimatedImageError has "     \
    "the error that is expected, and ImageErrorLimit says what keeps it above the tolerance. "     \
    "Errors of encoded values are apart (EncodingErrorOfValues).")                                 \
  Real(InteractiveImageErrorTolerance, 1/255, 8, 0.05, 255, 255, advanced, all,                    \
    "Largest error of a pixel while the camera moves, in 1/255, where the window waits for "       \
    "pictures (see Decoupled). Default: 8.")                                                       \
  Real(InteractiveFrameSeconds, seconds, 0.2, 0, 3600, 10, advanced, all,                          \
    "Seconds per frame while the camera moves, where the window waits for pictures (see "          \
    "Decoupled). Default: 0.2; 0 sets no limit. Slower frames raise the tolerance, up to "         \
    "16-fold. Projections, nearest points and fixed sample distances leave out rays and levels "   \
    "instead.")                                                                                    \
  Real(TemporalEnhancement, strength, 0, 0, 1, 1, default, all,                                    \
    "Brings out motion between steps, however weak: waves stay visible while they lose "           \
    "amplitude by decades. 0 (default) draws plain values, 1 the relative change only; 0.5 "       \
    "to 0.7 suit waves. Colours then mean enhanced values: switch it off to read "                 \
    "amplitudes.")                                                                                 \
  Real(SampleDistanceVoxels, edges, 0, 0, 100, 4, advanced, all,                                   \
    "Fixed distance between samples along a ray, in edges of the smallest cell; of meshes that "   \
    "are no octrees, in edges of the median cell. Default: 0, the tolerance decides.")             \
  Real(ScreenErrorPixels, pixels, 0, 0, 1024, 64, advanced, all,                                   \
    "Longest edge of a cell on the screen, in pixels. Everything is drawn from the coarsest "      \
    "levels that keep it, with one sample per cell. Default: 0, the tolerance decides.")           \
  Real(MaxElementsPerPixel, elements, 0, 0, 1000000, 1000000, advanced, cells,                     \
    "Octree meshes: most elements side by side in a pixel. Where there are more, a "               \
    "coarser level is drawn, whatever the tolerance. Default: 0, the tolerance decides.")          \
  Real(MeshTolerance, edges, 0.0009765625, 0, 0.0625, 0.0625, advanced, cells,                     \
    "Octree meshes: largest distance of points from the lattice of the octree, in edges "          \
    "of the smallest cell. Default: 1/1024. They are drawn on the lattice. Raise it for "          \
    "meshes whose points were moved by displacements.")                                            \
  Choice(CellValues, 0, 0, 1, advanced, meshes,                                                    \
    "How values of cells are drawn. Means (default): each point has the mean of the cells around " \
    "it, weighted by size. As they are: the value is the same all over a cell.")                   \
  Switch(MixVolumes, true, advanced, all,                                                          \
    "Volumes that share space are mixed along each ray: densities add up, and colours count by "   \
    "density. Default: on, for volumes that all have it on. Off: the one whose middle is nearer "  \
    "is drawn before the whole of the other one, which is quicker. Projections are not mixed.")    \
  Switch(CompositeInFewBits, false, advanced, all,                                                 \
    "Sends pixels between ranks in as few bits as keep them within 1/255, about a ninth of "       \
    "the bytes of floats. Default: off. ParaView blends the background later in 8 bits, so "       \
    "a few pixels may differ by 2/255.")                                                           \
  Whole(NumberOfThreads, threads, 0, 0, 1024, advanced, all,                                       \
    "Threads per process for casting rays and decoding. Default: 0, the cores of a machine "       \
    "are divided by its ranks.")                                                                   \
  Switch(ReuseFrames, true, advanced, all,                                                         \
    "Takes from earlier frames what is the same: a scene that was drawn, in this view and step, "  \
    "is not drawn again, and steps of a series that plays share how finely they are sampled. "     \
    "Default: on; off casts all rays and plans each frame, to measure.")                           \
  Switch(Decoupled, true, advanced, all,                                                          \
    "The window does not wait for pictures that take long: a coarse one is shown at once, and "    \
    "the exact one when it is there (PictureIsExact). Default: on, in ParaView's window and "       \
    "without stereo; screenshots, animations, scripts and steps of a play wait.")              \
  Switch(ReadAhead, true, advanced, images,                                                        \
    "Encoded image data: decodes bricks of the next frames in the background, on cores that "      \
    "nobody else wants. While the series plays these are bricks of the next four steps, while "   \
    "the camera moves bricks that come onto the screen. Default: on.")                             \
  Choice(LoadBalancing, 2, 0, 2, advanced, all,                                                    \
    "Measured cost (default): the zones of the ranks follow the cost of the last frames. "         \
    "Off: equal zones. 'Slice step' remains for older scripts and balances as 'Measured "          \
    "cost'.")                                                                                      \
  Choice(Division, 0, 0, 2, advanced, all,                                                         \
    "What ranks divide among them. By data: each draws a zone, and pictures are composited. By "   \
    "picture: each draws all cells under a part of the pixels; where each rank can read all, as "  \
    "it can of an encoded series and of octrees. Automatic (default): by picture where several "   \
    "tiles of a wall show parts of it, otherwise by data.")
// clang-format on

/**
 * @class vtkBanyanVolumeMapper
 * @brief draws image data, encoded or plain, meshes of any cells, hyper tree grids and overlapping
 * AMR, on one rank or many, with Banyan's own ray caster
 *
 * Use it like any volume mapper: give it image data (the output of vtkBanyanSeriesReader draws
 * without being decoded), an unstructured, structured, rectilinear or explicit structured grid
 * (each cell in three dimensions is drawn as it is), a vtkHyperTreeGrid or a vtkOverlappingAMR
 * (their visible leaves are trilinear elements), and put it into a vtkVolume with a colour and an
 * opacity function. Rays end at opaque geometry that was drawn before.
 *
 * With a controller of several ranks, Render() is collective: each rank draws its zone and rank 0
 * receives the finished picture, opaque geometry of all ranks included; the other ranks are left
 * blank where the volume may be, so that a sort-last compositor keeps rank 0's pixels.
 *
 * The picture does not depend on the number of ranks or threads: at most 1/255 per channel.
 *
 * With several volumes in one renderer, on the same ranks, the first that is rendered draws all, in
 * the order of depth, wherever a plane separates their boxes. Others are mixed along each ray
 * (MixVolumes), and with translucent surfaces that are not behind all of them. For projections
 * among these, and for texts in space or other volumes that are not behind them, a warning says
 * once what is not exact.
 *
 * Blend modes composite, maximum, minimum and average intensity; clipping planes, and cropping to
 * the inside of a box; shading; linear interpolation or, as vtkVolumeProperty has it by default,
 * that of the nearest point. All as VTK's own volume mappers know them, and the same on all ranks.
 *
 * Where the components of the property are not independent (IndependentComponentsOff), three or
 * four components on points of image data are colours: red, green, blue and alpha, rounded to 0 to
 * 255. No map colours them, and the opacity function is asked for alpha, or for the luminance (0.30
 * red + 0.59 green + 0.11 blue, rounded) of three components. They are composited only.
 *
 * @par Limits: point data, and cell data of what is not image data (CellValues); component 0 of the
 * property, which draws one component of the data or their magnitude, as the vector mode of its
 * colour function says; lights other than the viewer's are ignored, and so is shading in modes
 * other than composite. Averages are grey, from the lowest to the highest value of the data (of all
 * steps of an encoded series). Options that are set and have no effect (gradient opacity, 2D
 * transfer functions, and more: see banyan::IgnoredOptions) are named in a warning, once.
 * vtkVolumePicker and vtkCellPicker pick image data; hardware selection (vtkPropPicker,
 * vtkHardwareSelector) does not see the volume. SetAbortExecute(1) stops what a general mesh takes
 * before its first picture: it is not drawn until the mesh, or an option of it, is another.
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
   * The settings of the table above. A Real refuses NaN, infinities and negative numbers with an
   * error message, and keeps others within its limits, as a Whole and a Choice do.
   *
   * - Tolerances: errors are estimated (banyan::PlanSamplings) and go to the statistics. Frames are
   *   interactive while the window asks for more than one per second. Without effect on projections
   *   and nearest interpolation, as is ScreenErrorPixels.
   * - SampleDistanceVoxels: opacities are corrected for it. With 0, projections and nearest
   *   interpolation take 1.
   * - ScreenErrorPixels: decided for each tile of 32 x 32 pixels (banyan::SamplingsByScreen), with
   *   samples as far apart as SampleDistanceVoxels says, if it does. No error is estimated.
   * - MaxElementsPerPixel: decided for each tile (banyan::FinestLevelsOfTiles). Without effect on
   *   other data, and with SampleDistanceVoxels.
   * - TemporalEnhancement: see banyan::TemporalEnhancement. Its scale is the largest magnitude that
   *   the opacity function knows. For plain data the steps around must be there as point arrays
   *   (banyan::MotionEnhancement); the representation sees to that.
   * - CompositeInFewBits: without effect on projections, and while several volumes are on the
   *   screen.
   * - Decoupled: off by default in VTK, unlike in ParaView. It counts where the interactor of the
   *   window is Qt's (banyan::RenderWhenDrawn), and the window swaps its buffers. Look at
   *   PictureIsExact before you read such a window. A timer of the interactor renders again. See
   *   banyan::LateFrames.
   * - ReadAhead: takes half of what the cache has for decoded bricks, if the series plays, and a
   *   quarter, if the camera moves.
   * - Division: 0 automatic, 1 by data, 2 by picture
   * - CellValues: 0 means, 1 as they are
   * - LoadBalancing: 0 not at all, 2 to where measured costs balance, and 1, which was another way,
   *   the same. The same on all ranks. The picture does not change.
   */
#define BANYAN_REAL(Name, Unit, Default, Least, Most, ...)                                         \
  virtual void Set##Name(double number);                                                           \
  vtkGetMacro(Name, double);
#define BANYAN_WHOLE(Name, Unit, Default, Least, Most, ...)                                        \
  vtkSetClampMacro(Name, int, Least, Most);                                                        \
  vtkGetMacro(Name, int);
#define BANYAN_SWITCH(Name, Default, ...)                                                          \
  vtkSetMacro(Name, bool);                                                                         \
  vtkGetMacro(Name, bool);                                                                         \
  vtkBooleanMacro(Name, bool);
#define BANYAN_CHOICE(Name, Default, Least, Most, ...)                                             \
  vtkSetClampMacro(Name, int, Least, Most);                                                        \
  vtkGetMacro(Name, int);
  BANYAN_VOLUME_SETTINGS(BANYAN_REAL, BANYAN_WHOLE, BANYAN_SWITCH, BANYAN_CHOICE)
#undef BANYAN_REAL
#undef BANYAN_WHOLE
#undef BANYAN_SWITCH
#undef BANYAN_CHOICE
  ///@}

  /**
   * Tells when a window may not be rendered again for a late picture (Decoupled), as timers also
   * run inside of longer work that shows its progress. By default never.
   */
  void SetIsBusy(const std::function<bool()>& isBusy);

  /**
   * With Decoupled, and where somebody turns the loop of the window: renders it when the loop turns
   * next. For what changes while somebody drags it.
   */
  void RenderSoon(vtkRenderWindow* window);

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

  /** Whether the last picture is a coarse one, after which the exact one comes by itself. */
  bool ShowsCoarsePicture() const;

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
   * Whether that array is drawn as the colours that it has where the components of the property are
   * not independent. False on ranks without data.
   */
  bool CanDrawColours(vtkDataObject* data);

  /**
   * Bounds of the whole field, over all ranks, once UpdateField() or Render() was called; those of
   * the input before. Of a rank that is alone also those of another input, or one that has changed.
   */
  double* GetBounds() VTK_SIZEHINT(6) override;
  using Superclass::GetBounds;

  void Render(vtkRenderer* renderer, vtkVolume* volume) override;

  /**
   * Collective: draws the volume, and other visible ones of this kind, for displays of ranks, over
   * what these show.
   * @param pictures the same on all ranks
   * @param own for each picture, at which depths other data are in it, as far as this rank knows
   */
  void RenderOnWall(vtkRenderer* renderer, vtkVolume* volume,
    const std::vector<banyan::WallPicture>& pictures, const std::vector<banyan::DepthPicture>& own);
  void ReleaseGraphicsResources(vtkWindow* window) override;

protected:
  vtkBanyanVolumeMapper();
  ~vtkBanyanVolumeMapper() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;

private:
  vtkBanyanVolumeMapper(const vtkBanyanVolumeMapper&) = delete;
  void operator=(const vtkBanyanVolumeMapper&) = delete;

  friend class banyan::PictureServer;  // draws for a client
  friend class banyan::VolumesOnWall;  // draws volumes of several mappers
  friend class banyan::VolumesPicture; // draws volumes of several mappers

  std::string DivisionNote() const;
  std::string CellValuesNote();
  bool Attempt(const std::function<bool()>& work);
  void EndFrame(vtkObject* caller, unsigned long event, void* data);
  void ReportOnce(const std::string& problem);
  void WarnOnce(const std::string& note, std::string& last);

#define BANYAN_REAL(Name, Unit, Default, ...) double Name = Default;
#define BANYAN_WHOLE(Name, Unit, Default, ...) int Name = Default;
#define BANYAN_SWITCH(Name, Default, ...) bool Name = Default;
#define BANYAN_CHOICE(Name, Default, ...) int Name = Default;
  BANYAN_VOLUME_SETTINGS(BANYAN_REAL, BANYAN_WHOLE, BANYAN_SWITCH, BANYAN_CHOICE)
#undef BANYAN_REAL
#undef BANYAN_WHOLE
#undef BANYAN_SWITCH
#undef BANYAN_CHOICE
  vtkSmartPointer<vtkMultiProcessController> Controller;
  vtkSmartPointer<vtkBanyanFrameStatistics> Statistics;

  std::unique_ptr<banyan::MapperState> State;
};

#endif
