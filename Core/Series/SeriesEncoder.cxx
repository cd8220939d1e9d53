#include "Series/SeriesEncoder.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Series/EncodePlan.h"
#include "Series/FieldEncoder.h"
#include "Series/IndexText.h"
#include "Series/Magnitude.h"
#include "Series/NodeTable.h"
#include "Series/SegmentFolder.h"
#include "Series/SegmentWriter.h"

#include <algorithm>
#include <cmath>

#include <sys/stat.h>
#include <unistd.h>

namespace banyan
{
namespace
{

// Bricks encoded between two writes: bounds memory, and says how often progress is told.
constexpr std::int64_t BatchBricks = 512;

/// What is kept of a component from step to step.
struct ComponentState
{
  Quantizer Lattice;
  bool HasLattice = false;
  std::vector<std::vector<PayloadIdentity>> Before; ///< per level: identities of the last step
};

bool Exists(const std::string& path)
{
  struct stat status = {};
  return lstat(path.c_str(), &status) == 0;
}

} // namespace

struct SeriesEncoder::Internals
{
  Internals(const std::string& path, const Grid& grid, const std::vector<ArrayDescription>& arrays,
    const EncodeOptions& options, ThreadPool& pool);
  ~Internals();

  void CheckStep(double time, const std::vector<ArrayValues>& arrays) const;
  void EncodeStep(const std::vector<ArrayValues>& arrays);
  void EncodeComponent(std::size_t array, int component, const void* values, ComponentState& state);
  void EncodeLevel(const FieldToEncode& field, ComponentIndex& index, ComponentState& state);
  void Account(const FieldBrick& brick, bool finest, ComponentIndex& index);
  void Tell();
  void CloseSegment();

  std::string Path;
  EncodeOptions Options;
  ThreadPool& Pool;
  SeriesIndex Index;
  bool KeepOld; ///< a file of that name was there: it stays until Finish
  bool IndexWritten = false;
  bool Failed = false;
  bool Finished = false;
  std::unique_ptr<SegmentFolder> Folder;
  std::unique_ptr<SegmentWriter> Segment;
  std::vector<double> SegmentTimes;                       ///< steps of the segment under way
  std::vector<std::vector<ValueRange>> SegmentMagnitudes; ///< by array and step; of vectors only
  std::vector<std::vector<ComponentState>> States;
  std::function<bool(double)> Progress;
  std::int64_t BricksPerStep = 0;
  std::int64_t BricksDone = 0;
};

SeriesEncoder::Internals::Internals(const std::string& path, const Grid& grid,
  const std::vector<ArrayDescription>& arrays, const EncodeOptions& options, ThreadPool& pool)
  : Path(path)
  , Options(options)
  , Pool(pool)
  , Index(PlanSeries(grid, arrays, options))
  , KeepOld(Exists(path))
{
  for (const ArrayDescription& array : arrays)
  {
    this->States.emplace_back(array.ComponentNames.size());
  }
  this->SegmentMagnitudes.resize(arrays.size());
  (void)IndexToText(this->Index); // says now what could not be written later
  for (int level = 0; level < this->Index.Levels; ++level)
  {
    for (const ArrayIndex& array : this->Index.Arrays)
    {
      this->BricksPerStep +=
        BrickLayout(grid.Samples(), this->Index.BrickCells, level).BrickCount() *
        static_cast<std::int64_t>(array.Components.size());
    }
  }
  this->Folder = std::make_unique<SegmentFolder>(path);
}

SeriesEncoder::Internals::~Internals()
{
  this->Segment.reset();
  if (!this->Finished && this->Folder)
  {
    if (this->IndexWritten)
    {
      (void)unlink(this->Path.c_str());
    }
    this->Folder->RemoveOwn();
  }
}

void SeriesEncoder::Internals::Tell()
{
  const double done =
    static_cast<double>(this->BricksDone) / static_cast<double>(this->BricksPerStep);
  if (this->Progress && !this->Progress(std::min(done, 0.999999)))
  {
    throw Error("Encoding was interrupted");
  }
}

void SeriesEncoder::Internals::Account(const FieldBrick& brick, bool finest, ComponentIndex& index)
{
  EncodeStatistics& statistics = this->Index.Statistics;
  ++statistics.Bricks;
  statistics.MacroVoxelBricks += brick.Code.Mode == BrickMode::MacroVoxel ? 1 : 0;
  statistics.RawBricks += brick.Code.Mode == BrickMode::Raw ? 1 : 0;
  if (finest)
  {
    index.Range.Include(brick.Node.Range);
    index.MeasuredMaxError = std::max(index.MeasuredMaxError, brick.Error.Maximum);
    index.SumSquaredError += brick.Error.SumSquared;
    index.FiniteCount += brick.Error.Finite;
    index.NonFiniteCount += brick.Error.NonFinite;
  }
}

void SeriesEncoder::Internals::EncodeLevel(
  const FieldToEncode& field, ComponentIndex& index, ComponentState& state)
{
  const std::size_t level = static_cast<std::size_t>(field.Layout.Level());
  const std::size_t count = static_cast<std::size_t>(field.Layout.BrickCount());
  std::vector<PayloadIdentity>& before = state.Before[level];
  const bool first = before.empty();
  before.resize(count);
  NodeTable table;
  table.Nodes.reserve(count);
  table.Payloads.reserve(count);
  EncodeStatistics& statistics = this->Index.Statistics;
  std::vector<FieldBrick> batch;
  while (table.Nodes.size() < count)
  {
    const std::size_t done = table.Nodes.size();
    batch.clear();
    batch.resize(std::min(count - done, static_cast<std::size_t>(BatchBricks)));
    EncodeBricks(field, static_cast<std::int64_t>(done), batch, this->Pool);
    for (const FieldBrick& brick : batch)
    {
      PayloadReference payload;
      payload.Mode = static_cast<std::uint8_t>(brick.Code.Mode);
      if (brick.Code.Mode != BrickMode::MacroVoxel)
      {
        bool merged = false;
        payload.Offset = this->Segment->AddPayload(brick.Code.Payload, brick.Node.Identity, merged);
        statistics.MergedBricks += merged ? 1 : 0;
        statistics.PayloadBytes += merged ? 0 : brick.Code.Payload.size();
      }
      PayloadIdentity& last = before[table.Nodes.size()];
      statistics.UnchangedBricks += !first && last == brick.Node.Identity ? 1 : 0;
      last = brick.Node.Identity;
      this->Account(brick, level == 0, index);
      table.Nodes.push_back(brick.Node);
      table.Payloads.push_back(payload);
    }
    this->BricksDone += static_cast<std::int64_t>(batch.size());
    this->Tell();
  }
  segment::TableEntry entry;
  entry.RawBytes = count * segment::NodeBytes;
  entry.Masks = field.Masks;
  entry.QuantizerOrigin = field.Lattice.OriginBits(field.Type);
  entry.QuantizerStep = field.Lattice.StepBits(field.Type);
  this->Segment->AddTable(PackNodeTable(table, this->Options.CompressionLevel), entry);
}

void SeriesEncoder::Internals::EncodeComponent(
  std::size_t array, int component, const void* values, ComponentState& state)
{
  ArrayIndex& arrayIndex = this->Index.Arrays[array];
  ComponentIndex& index = arrayIndex.Components[static_cast<std::size_t>(component)];
  FieldToEncode field;
  field.Type = arrayIndex.Type;
  field.Values = values;
  field.Components = static_cast<int>(arrayIndex.Components.size());
  field.Component = component;
  field.FineSamples = this->Index.Domain.Samples();
  field.CompressionLevel = this->Options.CompressionLevel;
  const ValueRange expected =
    !index.PromisedRange.Empty()
      ? index.PromisedRange
      : RangeOfComponent(field.Type, values, this->Index.Domain.Extent.Count(), field.Components,
          component, this->Pool);
  if (!state.HasLattice)
  {
    state.Lattice = MakeQuantizer(field.Type, index.ErrorBoundAbsolute, expected);
    state.HasLattice = true;
    state.Before.resize(static_cast<std::size_t>(this->Index.Levels));
  }
  field.Lattice = state.Lattice;
  field.Masks = expected.Empty() ? MaskRange{ 0, 0 } : MaskRange{ expected.Low, expected.High };
  for (int level = 0; level < this->Index.Levels; ++level)
  {
    field.Layout = BrickLayout(field.FineSamples, this->Index.BrickCells, level);
    this->EncodeLevel(field, index, state);
  }
}

void SeriesEncoder::Internals::CheckStep(double time, const std::vector<ArrayValues>& arrays) const
{
  const std::vector<double>& times =
    this->SegmentTimes.empty() ? this->Index.Times : this->SegmentTimes;
  if (!std::isfinite(time) || (!times.empty() && !(time > times.back())))
  {
    throw Error("Time values must be finite and increase from step to step", { this->Path });
  }
  if (arrays.size() != this->Index.Arrays.size())
  {
    throw Error("A step must hold as many arrays as were described",
      { this->Path, {}, arrays.size(), this->Index.Arrays.size() });
  }
  for (const ArrayValues& array : arrays)
  {
    if (array.Values == nullptr)
    {
      throw Error("An array of a step has no values", { this->Path });
    }
  }
}

void SeriesEncoder::Internals::EncodeStep(const std::vector<ArrayValues>& arrays)
{
  const int step = this->Index.Steps() + static_cast<int>(this->SegmentTimes.size());
  if (!this->Segment)
  {
    this->Segment = std::make_unique<SegmentWriter>(this->Folder->Path(),
      this->Folder->NameOf(static_cast<int>(this->Index.Segments.size())), step);
  }
  this->BricksDone = 0;
  for (std::size_t a = 0; a < arrays.size(); ++a)
  {
    ArrayIndex& array = this->Index.Arrays[a];
    for (std::size_t c = 0; c < array.Components.size(); ++c)
    {
      this->EncodeComponent(a, static_cast<int>(c), arrays[a].Values, this->States[a][c]);
      this->Index.PayloadBytesIn +=
        static_cast<std::uint64_t>(this->Index.Domain.Extent.Count()) * SizeOf(array.Type);
    }
    if (array.Components.size() > 1)
    {
      std::vector<Quantizer> lattices;
      for (const ComponentState& state : this->States[a])
      {
        lattices.push_back(state.Lattice);
      }
      this->SegmentMagnitudes[a].push_back(MagnitudeRange(
        array.Type, arrays[a].Values, this->Index.Domain.Extent.Count(), lattices, this->Pool));
    }
  }
}

void SeriesEncoder::Internals::CloseSegment()
{
  const SegmentIndex segment = this->Segment->Finish(static_cast<int>(this->SegmentTimes.size()));
  this->Segment.reset();
  this->Index.Segments.push_back(segment);
  this->Index.Times.insert(
    this->Index.Times.end(), this->SegmentTimes.begin(), this->SegmentTimes.end());
  this->SegmentTimes.clear();
  for (std::size_t a = 0; a < this->SegmentMagnitudes.size(); ++a)
  {
    std::vector<ValueRange>& magnitudes = this->SegmentMagnitudes[a];
    std::vector<ValueRange>& known = this->Index.Arrays[a].Magnitudes;
    known.insert(known.end(), magnitudes.begin(), magnitudes.end());
    magnitudes.clear();
  }
  std::uint64_t bytes = 0;
  for (const SegmentIndex& each : this->Index.Segments)
  {
    bytes += each.Bytes;
  }
  this->Index.Statistics.TableBytes = bytes - this->Index.Statistics.PayloadBytes;
  if (!this->KeepOld)
  {
    WriteFileAtomically(this->Path, IndexToText(this->Index));
    this->IndexWritten = true;
  }
}

SeriesEncoder::SeriesEncoder(const std::string& path, const Grid& grid,
  const std::vector<ArrayDescription>& arrays, const EncodeOptions& options, ThreadPool& pool)
  : Self(std::make_unique<Internals>(path, grid, arrays, options, pool))
{
}

SeriesEncoder::~SeriesEncoder() = default;

void SeriesEncoder::SetActiveScalars(const std::string& name)
{
  if (this->Self->Index.FindArray(name) < 0)
  {
    throw Error("The active array '" + name + "' is not among the arrays");
  }
  this->Self->Index.ActiveScalars = name;
}

void SeriesEncoder::AddStep(double time, const std::vector<ArrayValues>& arrays)
{
  Internals& self = *this->Self;
  if (self.Failed || self.Finished)
  {
    throw Error("The series takes no more steps: it is finished or was given up after an error",
      { self.Path });
  }
  // A bad call does not spoil what was encoded, but the contract says that nothing can follow it.
  self.Failed = true;
  self.CheckStep(time, arrays);
  self.EncodeStep(arrays);
  self.SegmentTimes.push_back(time);
  if (static_cast<int>(self.SegmentTimes.size()) == self.Options.KeyframeInterval)
  {
    self.CloseSegment();
  }
  self.Failed = false;
}

SeriesIndex SeriesEncoder::Finish()
{
  Internals& self = *this->Self;
  if (self.Failed || self.Finished)
  {
    throw Error("The series cannot be finished (again): it was given up after an error or is "
                "finished already",
      { self.Path });
  }
  self.Failed = true;
  if (!self.SegmentTimes.empty())
  {
    self.CloseSegment();
  }
  if (self.Index.Steps() == 0)
  {
    throw Error("A series needs at least one step", { self.Path });
  }
  WriteFileAtomically(self.Path, IndexToText(self.Index));
  self.Finished = true;
  std::vector<std::string> files;
  for (const SegmentIndex& segment : self.Index.Segments)
  {
    files.push_back(segment.File);
  }
  self.Folder->RemoveAllBut(files);
  return self.Index;
}

void SeriesEncoder::SetProgress(std::function<bool(double)> progress)
{
  this->Self->Progress = std::move(progress);
}

} // namespace banyan
