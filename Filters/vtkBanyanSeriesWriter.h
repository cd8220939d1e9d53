// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkBanyanSeriesWriter
 * @brief   writes a time series of image data, a grid, or a mesh, as a Banyan series (name.banyan)
 *
 * All steps of the input go into one series, each rank asking for its own piece of every step.
 * Groups of KeyframeInterval steps are dealt out to the ranks of the controller in turn: a rank
 * encodes its group in a thread of its own, while the steps that follow are read. The files are the
 * same, byte for byte, on any number of ranks and threads. With a relative error bound the input is
 * updated twice per step: once to learn the ranges of the whole series, once to encode.
 *
 * What is written: point arrays of numbers, of any scalar type and any number of components; the
 * extent, origin, spacing, direction and times; which points and cells of an image are hidden. Of
 * ghost arrays nothing else is written. Cell arrays, strings and bits are not written, with a
 * warning that names them; when there is nothing else, writing fails. Field data are not written.
 * Arrays that the selection names (all of the first step, if it names none) must be there in all
 * steps. If it names all of the first step, a warning names those that come later.
 *
 * vtkStructuredGrid and vtkRectilinearGrid are written as images are, with their points bit by bit:
 * once, and again at each step where they are others. Points must be finite unless they are hidden.
 *
 * Unstructured grids, alone or as blocks that become one, are written as meshes: with the octree
 * whose leaves their cells are (see Documentation/hexahedra.md), else as cells of any type (see
 * Documentation/any-mesh.md), whose points are written again at each step where they are others.
 * Rank 0 gathers them. Global and pedigree ids are not written.
 *
 * @par Exactness:
 * |decoded - original| <= error bound for each finite value, verified in the array's type; NaN,
 * infinities and values at hidden points are bit-exact. ErrorBound 0 keeps every bit. With a
 * Transform the bound is one on the transformed values; with ClampOutside on the clamped ones.
 *
 * @par Errors:
 * Write() returns 0, GetErrorCode() is set and an error message says what is wrong, at which step
 * and on which rank; all ranks fail together. Nothing new is left on the disk, and a series that
 * existed under the name is as it was.
 *
 * @par Limits:
 * Each rank holds one group of whole steps (all chosen arrays) in memory, beside the piece of one
 * step that the pipeline holds.
 */
#ifndef vtkBanyanSeriesWriter_h
#define vtkBanyanSeriesWriter_h

#include "BanyanFiltersModule.h" // For export macro
#include "vtkNew.h"              // For Selection
#include "vtkSmartPointer.h"     // For Controller
#include "vtkWriter.h"

#include <memory> // For Quantizer
#include <string> // For ErrorMessage

class vtkDataArraySelection;
class vtkMultiProcessController;

namespace banyan
{
struct WriterQuantizer;
struct WritingOrder;
}

class BANYANFILTERS_EXPORT vtkBanyanSeriesWriter : public vtkWriter
{
public:
  static vtkBanyanSeriesWriter* New();
  vtkTypeMacro(vtkBanyanSeriesWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum ErrorBoundModes
  {
    RELATIVE_TO_SERIES_RANGE = 0,
    ABSOLUTE = 1
  };

  ///@{
  /**
   * Path of the index file; the segments go into a folder of the same name with ".d" at its end.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  ///@{
  /**
   * Largest error of a finite value: a part of the range of its component over the whole series,
   * or absolute in the units of the data. Default 1/512, which is 8-bit rounding; 0 is lossless.
   */
  vtkSetMacro(ErrorBound, double);
  vtkGetMacro(ErrorBound, double);
  vtkSetClampMacro(ErrorBoundMode, int, RELATIVE_TO_SERIES_RANGE, ABSOLUTE);
  vtkGetMacro(ErrorBoundMode, int);
  ///@}

  enum Transforms
  {
    UNIFORM = 0,
    ASINH = 1,
    TABLE = 2,
    ADAPTIVE = 3
  };
  ///@{
  /**
   * What the error bound holds in: the values as they are (default), asinh(value / AsinhScale) for
   * values over decades, a table of knots, or a table from the histogram of the whole series, which
   * is more exact where values are dense. A relative bound is relative to the transformed range.
   */
  void SetTransform(int transform);
  int GetTransform();
  ///@}

  ///@{
  /**
   * Below this magnitude asinh is linear, above it logarithmic. 0 (default): chosen from the data.
   */
  void SetAsinhScale(double scale);
  double GetAsinhScale();
  ///@}

  ///@{
  /**
   * Knots of the table: values and what they become, both strictly increasing.
   */
  void AddTransformKnot(double value, double transformed);
  void RemoveAllTransformKnots();
  ///@}

  enum RangeModes
  {
    FROM_DATA = 0,
    PERCENTILES = 1,
    GIVEN = 2
  };
  ///@{
  /**
   * Which range of values a relative error bound refers to: least to greatest (default), the two
   * RangePercentiles, or Range. Values outside keep the bound all the same: bit-exact if far away.
   */
  void SetRangeMode(int mode);
  int GetRangeMode();
  void SetRangePercentiles(double low, double high);
  void SetRange(double low, double high);
  ///@}

  ///@{
  /**
   * Whether values outside the range become its nearer end, and are counted; default off.
   */
  void SetClampOutside(bool clamp);
  bool GetClampOutside();
  ///@}

  ///@{
  /**
   * Values that mean "no value" (1e20, -9999): bit-exact, and never part of a range. Default none.
   */
  void AddFillValue(double value);
  void RemoveAllFillValues();
  ///@}

  ///@{
  /**
   * Opacity (0 to 1) over values, linear between knots: what it makes invisible may become anything
   * invisible of the same interval, and costs next to nothing. Default none: all values count.
   */
  void AddOpacityKnot(double value, double opacity);
  void RemoveAllOpacityKnots();
  ///@}

  enum Profiles
  {
    FAST = 0,
    BALANCED = 1,
    COMPACT = 2
  };
  ///@{
  /**
   * Time against size; the bound is the same. Default BALANCED.
   */
  vtkSetClampMacro(Profile, int, FAST, COMPACT);
  vtkGetMacro(Profile, int);
  ///@}

  ///@{
  /**
   * Steps per segment file, in [1, 1024]; default 8. Each rank encodes one segment at a time, and
   * holds its steps in memory; a killed writer loses those that were not finished.
   */
  vtkSetMacro(KeyframeInterval, int);
  vtkGetMacro(KeyframeInterval, int);
  ///@}

  ///@{
  /**
   * Cells of a brick along each axis: 16 or 32; or 0 (default), which takes 32 from 2^24
   * samples on and 16 below. Larger bricks make smaller files, and whole steps are read faster; of
   * smaller ones more is left out that cannot be seen, and a single one is read faster.
   */
  vtkSetMacro(BrickCells, int);
  vtkGetMacro(BrickCells, int);
  ///@}

  ///@{
  /**
   * Whether each segment file is read by itself. By default (off) its steps are also predicted from
   * the last step of the one before, which makes most series smaller: a brick is then read from two
   * files.
   */
  vtkSetMacro(ClosedGroups, bool);
  vtkGetMacro(ClosedGroups, bool);
  vtkBooleanMacro(ClosedGroups, bool);
  ///@}

  ///@{
  /**
   * Whether all time steps of the input are written (default), or only the present one.
   */
  vtkSetMacro(WriteTimeSteps, bool);
  vtkGetMacro(WriteTimeSteps, bool);
  vtkBooleanMacro(WriteTimeSteps, bool);
  ///@}

  /**
   * Names of the point arrays to write. Empty (the default) means all; otherwise those that are
   * enabled, and it is an error if one of them does not exist.
   */
  vtkDataArraySelection* GetPointArraySelection();

  /**
   * Names of the cell arrays of a mesh to write. If neither point nor cell arrays are named, all
   * are written; otherwise those that are enabled. Cell arrays of images are not written.
   */
  vtkDataArraySelection* GetCellArraySelection();

  ///@{
  /**
   * Of meshes whose points move from step to step: the point array that holds their displacements.
   * Points are then written as they are without these, which must be the same at all steps (to the
   * rounding of float32); the array is written like others. Empty (default): points must not move.
   */
  void SetDisplacementArray(const char* name);
  const char* GetDisplacementArray() { return this->DisplacementArray.c_str(); }
  ///@}

  ///@{
  /**
   * Whose ranks write together; by default the global controller. nullptr: this rank alone.
   */
  void SetController(vtkMultiProcessController* controller);
  vtkMultiProcessController* GetController();
  ///@}

  /**
   * What went wrong in the last Write(), as a sentence; empty if nothing did.
   */
  const char* GetErrorMessage() { return this->ErrorMessage.c_str(); }

  /**
   * Writes the series. Collective over the ranks of the controller. Returns 1 on success.
   */
  int Write() override;

protected:
  vtkBanyanSeriesWriter();
  ~vtkBanyanSeriesWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;

private:
  vtkBanyanSeriesWriter(const vtkBanyanSeriesWriter&) = delete;
  void operator=(const vtkBanyanSeriesWriter&) = delete;

  void WriteSeries();
  void Run(const banyan::WritingOrder& order);
  void Fail(const std::string& sentence);

  char* FileName = nullptr;
  double ErrorBound = 1.0 / 512.0;
  int ErrorBoundMode = RELATIVE_TO_SERIES_RANGE;
  int KeyframeInterval = 8;
  int BrickCells = 0;
  bool ClosedGroups = false;
  int Profile = BALANCED;
  bool WriteTimeSteps = true;
  std::string DisplacementArray;
  std::string ErrorMessage;
  vtkNew<vtkDataArraySelection> Selection;
  vtkNew<vtkDataArraySelection> CellSelection;
  std::unique_ptr<banyan::WriterQuantizer> Quantizer;
  vtkSmartPointer<vtkMultiProcessController> Controller;
};

#endif
