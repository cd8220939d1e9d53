// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Format_SeriesIndex_h
#define banyan_Series_Format_SeriesIndex_h

#include "Base/ScalarType.h"
#include "Series/Grid/Grid.h"
#include "Series/Quantize/OpacityWeight.h"
#include "Series/Quantize/RangeRule.h"
#include "Series/Quantize/Transform.h"
#include "Series/Quantize/ValueRange.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace banyan
{

/// How `ErrorBound` is meant.
enum class ErrorBoundMode
{
  RelativeToSeriesRange, ///< times (maximum - minimum) of the component over the whole series
  Absolute               ///< in the units of the data
};

/// One component of one array: its lattice and what was measured while encoding.
struct ComponentIndex
{
  std::string Name; ///< may be empty
  ValueRange Range; ///< of the decoded finite values over the whole series
  /// The range that the encoder was told beforehand, or the one that a rule chose, which values may
  /// leave. Empty when there was neither.
  ValueRange PromisedRange;
  /// |f(decoded) - f(original)| <= this, f = ValueTransform, for every finite voxel, verified: but
  /// clamped voxels are measured against what they were clamped to, and invisible ones (see
  /// Opacity) may become others.
  double ErrorBoundAbsolute = 0;
  /// The largest |decoded - original| met while encoding, of the voxels that the bound holds for.
  double MeasuredMaxError = 0;
  /// The largest error in the transformed domain, where the bound holds; MeasuredMaxError when the
  /// transform is the identity.
  double MeasuredMaxErrorTransformed = 0;
  double SumSquaredError = 0; ///< over all finite voxels of all steps; for RMSE and PSNR
  /// Root of the mean squared error of each step, to three digits; empty in series that do not say
  /// it.
  std::vector<double> StepRmse;
  std::int64_t FiniteCount = 0;    ///< voxels (of all steps) that are finite
  std::int64_t NonFiniteCount = 0; ///< NaN and infinities, kept bit-exact
  /// The transform of the values before they were put on the lattice; the identity unless the
  /// encoder was told another one.
  Transform ValueTransform;

  // Other options that the encoder was told; see QuantizerOptions.
  RangeRule::Source RangeFrom = RangeRule::Source::Data;
  bool ClampOutside = false; ///< values were clamped to PromisedRange before they were encoded
  std::vector<double> FillValues;
  std::vector<OpacityKnot> Opacity; ///< empty: every value counts
  std::int64_t ClampedCount = 0;    ///< voxels that clamping changed
  std::int64_t FillCount = 0;       ///< voxels that hold a fill value, kept bit-exact
  std::int64_t InvisibleCount = 0;  ///< out of bound: invisible ones, decoded to invisible ones
  double SumWeightedError = 0;      ///< of opacity times squared error, over all finite voxels

  /// Equation 2 of the study over its squared range (see QuantizationError.h); 0 without Opacity.
  double OpacityWeightedError() const;
  /// Returns the range that errors are given as shares of: PromisedRange if it was chosen or fill
  /// values were left out of it, else Range.
  const ValueRange& ReferenceRange() const;
};

/// The kind of numbers of an array.
enum class ArrayFlags
{
  None,     ///< values
  OfPoints, ///< of an image: not 0 where a point is hidden and has no value
  OfCells   ///< of an image, at the lowest corners of cells: see HiddenCellBits
};

/// Name and bits of flags: vtkGhostType, HIDDENPOINT, and HIDDENCELL with REFINEDCELL of VTK.
constexpr const char* FlagsName = "vtkGhostType";
constexpr const char* CellFlagsName = "vtkGhostType of cells";
constexpr std::uint8_t HiddenPointBits = 2;
constexpr std::uint8_t HiddenCellBits = 32 | 8;

struct ArrayIndex
{
  std::string Name; ///< no two arrays of a series have the same
  /// The name of this cell array of a mesh. Empty: it is a point array.
  std::string CellArray;
  ArrayFlags Flags = ArrayFlags::None;
  ScalarType Type = ScalarType::Float32;
  std::vector<ComponentIndex> Components; ///< at least one
  /// Per step, of the length (L2 norm) of the decoded vectors whose components are finite. None for
  /// arrays with one component.
  std::vector<ValueRange> Magnitudes;
};

/// The kinds of grids whose points a series keeps. Their values are images in i, j, k.
enum class GridKind
{
  Rectilinear, ///< three lists of coordinates, one per axis
  Curvilinear  ///< x, y, z of each sample
};

/// What the points of a grid are made of, at all steps.
struct PointsForm
{
  GridKind Kind = GridKind::Curvilinear;
  /// Of the coordinates along each axis; of curvilinear grids all three the same.
  std::array<ScalarType, 3> Types{ ScalarType::Float32, ScalarType::Float32, ScalarType::Float32 };
  friend bool operator==(const PointsForm& a, const PointsForm& b)
  {
    return a.Kind == b.Kind && a.Types == b.Types;
  }
};

/// The points of a step, and of those behind it up to the next one that has a file.
struct PointsFile
{
  std::string File; ///< name inside `<series>.d/`, without a path
  int FirstStep = 0;
  std::uint64_t Bytes = 0; ///< size of the file
  /// Of the file's head, through which every other byte is checked; of a mesh: of the whole file.
  std::uint64_t HashLow = 0;
  std::uint64_t HashHigh = 0;
};

/// The mesh whose values a series holds as images (see Mesh/Series/StoredMesh.h and
/// Mesh/CellSeries/StoredCells.h).
struct MeshIndex
{
  bool OfCells = false; ///< of any type; else the cells are leaves of an octree
  std::string File;     ///< name inside `<series>.d/`, without a path
  std::uint64_t Bytes = 0;
  std::uint64_t HashLow = 0; ///< of the whole file
  std::uint64_t HashHigh = 0;
  std::int64_t Points = 0;
  std::int64_t Cells = 0;
  /// Points of later steps, where they are others than those in the file of the mesh. Hashes are of
  /// the whole files. Only with OfCells.
  std::vector<PointsFile> Moved{};
};

/// The points of a grid that is not regular (see Points/GridPoints.h).
struct PointsIndex
{
  PointsForm Form;
  std::vector<PointsFile> Files; ///< in the order of steps; the first one is of step 0
  /// Throws Error where there is none.
  const PointsFile& FileOf(int step) const;
};

/// A group of consecutive steps. Groups of equal content have the same file.
struct SegmentIndex
{
  std::string File; ///< name inside `<series>.d/`, without a path
  int FirstStep = 0;
  int Steps = 0;
  std::uint64_t Bytes = 0;   ///< size of the file
  std::uint64_t HashLow = 0; ///< of the file's header, through which every other byte is checked
  std::uint64_t HashHigh = 0;
};

/// Says what encoding a series came to, over all steps, arrays, components and levels.
struct EncodeStatistics
{
  std::int64_t Bricks = 0;
  std::int64_t MacroVoxelBricks = 0; ///< fused: one value everywhere
  std::int64_t UnchangedBricks = 0;  ///< as at the step before, of the same segment
  std::int64_t MergedBricks = 0;     ///< payload shared with an earlier brick of the segment
  std::int64_t RawBricks = 0;        ///< with samples that are kept beside the lattice
  std::uint64_t PayloadBytes = 0;    ///< stored in segments
  std::uint64_t TableBytes = 0;      ///< stored in segments: node tables, directories, headers
  std::int64_t EmptyBlocks = 0;      ///< without payload: as predicted, or of one value
  std::int64_t Blocks = 0;           ///< what payloads are made of: blocks of all planes
  std::int64_t ExceptionVoxels = 0;  ///< of the finest level, kept bit-exact beside the lattice
  std::int64_t ChainSum = 0;         ///< steps to decode for a brick of the finest level, summed
  std::int64_t ChainBricks = 0;      ///< over this many bricks
  std::int64_t ChainMost = 0;        ///< and the greatest
  std::int64_t RepeatedSegments = 0; ///< groups whose segment was there already
  std::uint64_t RepeatedBytes = 0;   ///< that these would take; not among Payload- and TableBytes
};

/// All that the index file says. See Documentation/format.md.
struct SeriesIndex
{
  Grid Domain;
  std::optional<MeshIndex> Mesh; ///< nothing: the series is of the images themselves
  /// Nothing: samples lie where Domain says. Domain then has the origin 0, the spacing 1 and no
  /// direction.
  std::optional<PointsIndex> Points;
  int BrickCells = 16;
  int Levels = 1;
  int KeyframeInterval = 8;
  double ErrorBound = 0; ///< as asked for; the absolute one stands at each component
  ErrorBoundMode Mode = ErrorBoundMode::RelativeToSeriesRange;
  std::string ActiveScalars; ///< name of the array to colour by at first; may be empty
  std::vector<ArrayIndex> Arrays;
  std::vector<double> Times; ///< strictly increasing, one per step that a segment holds
  std::vector<SegmentIndex> Segments;

  std::uint64_t PayloadBytesIn = 0; ///< raw size of everything encoded so far
  EncodeStatistics Statistics;

  int Steps() const { return static_cast<int>(this->Times.size()); }
  /// Index of the array with these flags, or -1.
  int FindFlags(ArrayFlags flags) const;
  /// Index of the array of that name, or -1.
  int FindArray(const std::string& name) const;
  /// Files of points, in the order of steps: of a grid, or of a mesh whose points move.
  const std::vector<PointsFile>& FilesOfPoints() const;
  /// The segment that holds a step. Throws Error when the step does not exist.
  const SegmentIndex& SegmentOf(int step) const;
};

} // namespace banyan

#endif
