// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_SeriesEncoder_h
#define banyan_Series_Encode_SeriesEncoder_h

#include "Series/Encode/AblationSwitches.h"
#include "Series/Format/QuantizerOptions.h"
#include "Series/Format/SeriesIndex.h"
#include "Series/Quantize/Histogram.h"

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace banyan
{

class ThreadPool;
struct PointsView;

/// Says what encoding aims at. Every profile keeps the bound and is read by every reader.
enum class EncodeProfile
{
  Fast,     ///< in situ: few ways to predict are looked at
  Balanced, ///< the default
  Compact   ///< archives: all of them, and those that look best are tried out
};

/// Holds what encoding has to know of the mesh that images stand for.
struct MeshPlan
{
  MeshIndex Index;
  /// By sample of an image, x fastest: 0 where it stands for no point of the mesh. Such a sample
  /// may decode to anything, and is not counted.
  std::shared_ptr<const std::vector<std::uint8_t>> Needed;
  /// The same for cells: what counts in arrays that are values of cells.
  std::shared_ptr<const std::vector<std::uint8_t>> NeededOfCells;
  /// The arrays whose values are those of cells, by their names in the series: the names that they
  /// have as cell arrays.
  std::map<std::string, std::string> CellArrays;
};

struct EncodeOptions
{
  /// > 0 and finite, or 0 for bit-exact. See ErrorBoundMode.
  double ErrorBound = 1.0 / 512.0;
  ErrorBoundMode Mode = ErrorBoundMode::RelativeToSeriesRange;
  int KeyframeInterval = 8; ///< steps per segment, in [1, 1024]
  /// Whether any brick of any step takes its own segment alone; else also the last step of the one
  /// before, where that makes series smaller.
  bool ClosedGroups = false;
  int BrickCells = 0;       ///< 16 or 32; 0 chooses by the size of the grid
  int CompressionLevel = 3; ///< of zstd (exceptions), in [1, 19]
  EncodeProfile Profile = EncodeProfile::Balanced;
  AblationSwitches Ablation;  ///< for measurements: all of them, otherwise
  QuantizerOptions Quantizer; ///< of all arrays
  std::map<std::string, QuantizerOptions> QuantizerOfArray; ///< instead, of arrays by name
  std::shared_ptr<const MeshPlan> Mesh;                     ///< null: the series is of images
  std::optional<PointsForm> Points; ///< of a grid that is not regular: see SetPoints

  const QuantizerOptions& QuantizerFor(const std::string& array) const;
  /// Whether an array needs ArrayDescription::Histograms.
  bool NeedsHistogram(const std::string& array) const;
};

/// Describes an array of a series. Ranges are needed only for relative error bounds, histograms
/// where a transform or a range is chosen from the values (EncodeOptions::NeedsHistogram).
struct ArrayDescription
{
  std::string Name;
  ScalarType Type = ScalarType::Float32;
  std::vector<std::string> ComponentNames; ///< one per component, may hold empty strings
  std::vector<ValueRange> SeriesRanges; ///< one per component: of the finite values over all steps
  /// One per component, or none: of all finite values over all steps but fill values
  /// (CountComponent). Ranges of the data come from here when there are histograms.
  std::vector<ValueHistogram> Histograms{};
  /// Flags are bytes with the bits of HiddenPointBits or HiddenCellBits alone, kept bit-exact. They
  /// come before all other arrays, and none of the other members but name and type counts.
  ArrayFlags Flags = ArrayFlags::None;
};

/// Says which points of an image, or which cells, are hidden.
ArrayDescription DescriptionOfFlags(ArrayFlags flags);

/// Values of one array at one step: `[nz][ny][nx][components]`, x (and components) fastest, the
/// whole extent. Borrowed, not owned.
struct ArrayValues
{
  const void* Values = nullptr;
};

/// Writes a series step by step: one segment per `KeyframeInterval` steps.
///
/// The index file appears (and grows) with each whole segment when no series of that name existed;
/// an existing series stays untouched until `Finish()` replaces it. An encoder that is destroyed
/// without `Finish()` removes what it wrote. A killed process leaves the segments that were indexed
/// readable. From its construction to Finish() it holds the series' lock (see SeriesLock).
///
/// Exactness: every finite voxel is bounded by ErrorBoundAbsolute in its own type, verified here
/// voxel by voxel (with a transform, in what it makes of them); NaN (payload bits included),
/// infinities, fill values and values at hidden points are bit-exact.
///
/// Threads: `AddStep` uses the pool; one thread at a time may use an encoder.
class SeriesEncoder
{
public:
  /// @param path of the index file; segments go to `path + ".d"`. Where it is a symbolic link, the
  /// series that it leads to is written or replaced. Throws Error when the description or an option
  /// is out of range, the folder cannot be made, or another save of the series is under way.
  SeriesEncoder(const std::string& path, const Grid& grid,
    const std::vector<ArrayDescription>& arrays, const EncodeOptions& options, ThreadPool& pool);
  ~SeriesEncoder();
  SeriesEncoder(const SeriesEncoder&) = delete;
  SeriesEncoder& operator=(const SeriesEncoder&) = delete;

  /// Which array is coloured by at first; default is the first one.
  void SetActiveScalars(const std::string& name);

  /// The points of the steps from the next one on. A series whose options have Points needs them
  /// before its first step, and again before each step whose points are others.
  /// @param points as options and grid say; they are kept bit by bit. Throws Error.
  void SetPoints(const PointsView& points);

  /// The file of the points of a mesh of cells from the next step on, where they have moved. It is
  /// in the folder of the series (see WriteMovedPoints). Throws Error.
  void SetMovedPoints(PointsFile points);

  /// @param time greater than the one before
  /// @param arrays one per description, same order
  /// Throws Error on bad input or when the disk is full; the encoder can then only be destroyed.
  void AddStep(double time, const std::vector<ArrayValues>& arrays);

  /// Writes what is left, replaces the index atomically and returns it. At least one step is
  /// needed.
  SeriesIndex Finish();

  /// Called with a value in [0, 1) that says how much of the present step is encoded; may return
  /// false to interrupt: AddStep then throws Error.
  void SetProgress(std::function<bool(double)> progress);

private:
  struct Internals;
  std::unique_ptr<Internals> Self;
};

} // namespace banyan

#endif
