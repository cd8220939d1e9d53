// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkBanyanSeriesReader
 * @brief   reads a Banyan series (name.banyan) with time steps: image data, a grid, or a mesh
 *
 * The output is vtkImageData with the extent, origin, spacing, direction, arrays and times of what
 * was encoded. Any piece or sub-extent can be asked for; only bricks that it touches are read.
 * Points and cells that were hidden are so again (vtkGhostType), whatever arrays are chosen.
 * With DeferDecoding (the default) nothing is decoded until somebody asks for a value, as long as
 * all that is connected reads such arrays: see DeferredConsumers.h, vtkBanyanArray, and
 * vtkBanyanDeferred for renderers that draw from the series itself. Everybody else, and who takes
 * GetOutput() of a reader without consumers, gets plain arrays (vtkBanyanDecodedArray). The reader
 * executes again when the first of them is connected to one that is up to date.
 *
 * A series of a curvilinear or rectilinear grid gives back a vtkStructuredGrid or
 * vtkRectilinearGrid with plain arrays, and with points of the same type, bit by bit. A coarser
 * level has the points of the samples that it keeps, the last one along each axis among them.
 *
 * A series of a mesh gives back the vtkUnstructuredGrid that was encoded: its points and cells in
 * their order, with plain arrays. Level L merges cells into cubes of 2^L finest ones. A piece is a
 * run of cells with the points that they use. MeshAsHyperTreeGrid gives a vtkHyperTreeGrid instead.
 * All values of a step are decoded on each rank.
 *
 * A time between two steps gives the earlier one, or values between both: see InterpolateInTime. A
 * time before the first step gives the first.
 *
 * Each integer and floating-point array comes back in its own width and signedness: int64 as long,
 * int8 as signed char.
 *
 * @par Exactness:
 * Every finite value is bounded by the error bound in the index; NaN, infinities and values at
 * hidden points are bit-exact.
 *
 * @par Errors:
 * vtkErrorMacro on the first rank, and GetErrorCode() and GetErrorMessage() on all; the update
 * fails. The sentence names the file, the array and the rank. All ranks of the controller fail
 * together, so that no filter waits for a rank that has no input: RequestData() and the first
 * RequestInformation() after SetFileName() or Refresh() are collective. Set the controller to
 * nullptr where only some ranks use a reader.
 */
#ifndef vtkBanyanSeriesReader_h
#define vtkBanyanSeriesReader_h

#include "BanyanReadersModule.h" // For export macro
#include "vtkImageAlgorithm.h"

#include <cstdint> // For std::int64_t
#include <memory>  // For Internals

class vtkDataArraySelection;
class vtkMultiProcessController;

namespace banyan
{
class SeriesFile;
}

class BANYANREADERS_EXPORT vtkBanyanSeriesReader : public vtkImageAlgorithm
{
public:
  static vtkBanyanSeriesReader* New();
  vtkTypeMacro(vtkBanyanSeriesReader, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Path of the index file, or of a link to it. The segments lie in a folder of the same name with
   * ".d" at its end, beside the link or what it leads to (see banyan::FindSeriesFolder).
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  /**
   * Whether this is the reader for the file: it begins as the index of a series does, or is named
   * *.banyan (or *.banyan.d). What is damaged or missing is said by the update. Silent, reads some
   * bytes. Not collective.
   */
  int CanReadFile(const char* fileName);

  ///@{
  /**
   * 0 (the default) is the grid as it was encoded; level L keeps the samples that lie exactly on
   * every 2^L-th of it, on an extent that starts at 0. Clamped to the coarsest level there is.
   */
  vtkSetClampMacro(Level, int, 0, 31);
  vtkGetMacro(Level, int);
  ///@}

  /**
   * Number of levels of the series, at least 1; 0 before the file is open.
   */
  int GetNumberOfLevels();

  ///@{
  /**
   * Whether series of meshes come as vtkHyperTreeGrid in place of vtkUnstructuredGrid: with cell
   * data, the values of the elements at their centres (see banyan::TreeOutput). Off by default.
   * Without effect on series of image data.
   */
  vtkSetMacro(MeshAsHyperTreeGrid, bool);
  vtkGetMacro(MeshAsHyperTreeGrid, bool);
  vtkBooleanMacro(MeshAsHyperTreeGrid, bool);
  ///@}

  ///@{
  /**
   * Whether arrays may decode on first touch (default), or all come at once as plain arrays that
   * know nothing of the series.
   */
  vtkSetMacro(DeferDecoding, bool);
  vtkGetMacro(DeferDecoding, bool);
  vtkBooleanMacro(DeferDecoding, bool);
  ///@}

  ///@{
  /**
   * Whether a time between two steps gives values between theirs: linear in time, in the array's
   * own type (see banyan::BetweenSteps). Off by default: it gives the earlier step. Arrays of
   * integers may be labels: they give the earlier step, and a warning says so once. What one of
   * both steps hides is hidden. At the time of a step the values are that step's, bit by bit. All
   * values of both steps are needed, so they are bounded by the error bound against interpolated
   * originals; how far these are from the truth, banyan-info --between estimates.
   */
  vtkSetMacro(InterpolateInTime, bool);
  vtkGetMacro(InterpolateInTime, bool);
  vtkBooleanMacro(InterpolateInTime, bool);
  ///@}

  ///@{
  /**
   * Whether the next step of a series of meshes that plays is decoded while this one is drawn: by
   * threads of low priority, within half of what the cache has for decoded bricks. Default on.
   * Without effect on series of image data, whose bricks the renderer decodes ahead
   * (vtkBanyanVolumeMapper::SetReadAhead).
   */
  vtkSetMacro(ReadAhead, bool);
  vtkGetMacro(ReadAhead, bool);
  vtkBooleanMacro(ReadAhead, bool);
  ///@}

  ///@{
  /**
   * MiB for caches that this series has for itself, those of its displays included; 0 keeps
   * nothing. The default, -1: it shares those of the process, whose budget is BANYAN_CACHE_MB from
   * the environment, or an eighth of the machine's memory divided by its ranks, but 512 MiB at
   * least. Another number opens the series again; arrays that were read before stay valid.
   */
  void SetCacheBudget(int mebibytes);
  vtkGetMacro(CacheBudget, int);
  ///@}

  ///@{
  /**
   * Which point arrays to read; all by default. Filled with the names of the series in
   * RequestInformation().
   */
  vtkDataArraySelection* GetPointArraySelection();
  /** Of series of meshes: which cell arrays are read. */
  vtkDataArraySelection* GetCellArraySelection();
  int GetNumberOfPointArrays();
  const char* GetPointArrayName(int index);
  int GetPointArrayStatus(const char* name);
  void SetPointArrayStatus(const char* name, int status);
  ///@}

  /**
   * Opens the file again at the next update, for a series that has grown since. Collective, as
   * said above.
   */
  void Refresh();

  ///@{
  /**
   * Whose ranks fail together; by default the global controller. nullptr for a reader that only
   * one rank uses.
   */
  void SetController(vtkMultiProcessController* controller);
  vtkMultiProcessController* GetController();
  ///@}

  /**
   * How many bricks of the open series this process has decoded so far, for whomever.
   */
  vtkIdType GetBricksDecoded();

  /**
   * How many bricks that were decoded ahead this process has been asked for since, for whatever
   * series.
   */
  vtkIdType GetBricksReadAhead();

  /**
   * What the last update took on this process: of image data that decodes on first touch nearly
   * nothing.
   */
  double GetLoadSeconds();

  /**
   * What the open series holds, in lines for a person: steps and points, bytes and how many times
   * fewer they are than the values, and for each array its largest error and its error bound, in
   * the units of the data. Empty before the first update of information.
   */
  const char* GetContents();

  /**
   * What went wrong in the last update, as a sentence; empty if nothing did.
   */
  const char* GetErrorMessage();

  vtkMTimeType GetMTime() override;

  /// Later than GetMTime() when somebody was connected who needs plain arrays where deferred ones
  /// are.
  int ComputePipelineMTime(vtkInformation* request, vtkInformationVector** inputs,
    vtkInformationVector* outputs, int port, vtkMTimeType* mtime) override;

protected:
  vtkBanyanSeriesReader();
  ~vtkBanyanSeriesReader() override;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestInformation(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkBanyanSeriesReader(const vtkBanyanSeriesReader&) = delete;
  void operator=(const vtkBanyanSeriesReader&) = delete;

  bool OpenOnAllRanks();
  const banyan::SeriesFile* Series() const;
  int UsedLevel() const;
  bool IsMesh() const;
  bool IsImage() const;
  int MakeOutput(vtkInformationVector* outputs);
  void DecideOnDeferring();
  void FillOutput(vtkInformation* info, vtkDataObject* output);
  void Fail(unsigned long code, const std::string& sentence);
  void Clear();
  std::int64_t CacheBytes() const;

  char* FileName = nullptr;
  int Level = 0;
  bool DeferDecoding = true;
  bool MeshAsHyperTreeGrid = false;
  bool ReadAhead = true;
  bool InterpolateInTime = false;
  int CacheBudget = -1;

  struct Internals;
  std::unique_ptr<Internals> Self;
};

#endif
