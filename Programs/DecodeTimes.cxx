// SPDX-License-Identifier: BSD-3-Clause
#include "DecodeTimes.h"

#include "Base/Timer.h"
#include "Series/Decode/CacheContext.h"
#include "Series/Decode/SeriesFile.h"

#include <algorithm>
#include <numeric>
#include <random>

#include <fcntl.h>
#include <unistd.h>

namespace banyan
{
namespace
{

// Enough for a median that repeats within a few per cent, in seconds even when a brick takes long.
constexpr int StepsMeasured = 8;
constexpr std::size_t WarmBricksPerStep = 125;
constexpr int ColdBricks = 100;

/// Bricks of a field that have a payload, in order.
std::vector<std::int64_t> BricksWithPayload(const SeriesFile& file, const FieldKey& field)
{
  const auto nodes = file.Nodes(field);
  std::vector<std::int64_t> bricks;
  for (std::size_t i = 0; i < nodes->size(); ++i)
  {
    if (!(*nodes)[i].Uniform)
    {
      bricks.push_back(static_cast<std::int64_t>(i));
    }
  }
  return bricks;
}

/// Room for any brick of the finest level.
std::vector<std::uint8_t> BrickBuffer(const SeriesFile& file, const FieldKey& field)
{
  const std::size_t edge = static_cast<std::size_t>(file.Index().BrickCells) + 1;
  const ScalarType type = file.Index().Arrays[static_cast<std::size_t>(field.Array)].Type;
  return std::vector<std::uint8_t>(edge * edge * edge * SizeOf(type));
}

void ForgetFile(const std::string& path)
{
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor >= 0)
  {
    (void)posix_fadvise(descriptor, 0, 0, POSIX_FADV_DONTNEED);
    (void)close(descriptor);
  }
}

void ForgetSeries(
  const std::string& path, const std::string& folder, const std::vector<SegmentIndex>& segments)
{
  ForgetFile(path);
  for (const SegmentIndex& segment : segments)
  {
    ForgetFile(folder + "/" + segment.File);
  }
}

double Microseconds(const Timer& timer)
{
  return 1e6 * timer.Seconds();
}

/// A brick that has a payload, of any step.
struct Choice
{
  FieldKey Field;
  std::int64_t Brick = 0;
};

/// The series is closed again at the end, so that the system can forget it.
std::vector<Choice> ChooseBricks(const std::string& path, int array, std::mt19937_64& random)
{
  const auto file = SeriesFile::Open(path);
  std::vector<Choice> choices;
  for (int i = 0; i < ColdBricks; ++i)
  {
    FieldKey field;
    field.Step = static_cast<int>(random() % static_cast<std::uint64_t>(file->Index().Steps()));
    field.Array = array;
    const std::vector<std::int64_t> bricks = BricksWithPayload(*file, field);
    if (!bricks.empty())
    {
      choices.push_back({ field, bricks[random() % bricks.size()] });
    }
  }
  return choices;
}

void MeasureCold(const std::string& path, int array, std::mt19937_64& random, DecodeTimes& times)
{
  std::string folder;
  std::vector<SegmentIndex> segments;
  {
    const auto file = SeriesFile::Open(path);
    folder = file->Folder();
    segments = file->Index().Segments;
  }
  std::vector<double> cold;
  std::vector<double> opening;
  for (const Choice& choice : ChooseBricks(path, array, random))
  {
    ForgetSeries(path, folder, segments);
    const Timer open;
    const auto file = SeriesFile::Open(path);
    opening.push_back(Microseconds(open));
    std::vector<std::uint8_t> values = BrickBuffer(*file, choice.Field);
    const Timer decode;
    file->DecodeBrick(choice.Field, choice.Brick, values.data());
    cold.push_back(Microseconds(decode));
  }
  times.Cold = Summarize(std::move(cold));
  times.Open = Summarize(std::move(opening));
}

/// @param forget called before each brick
template <class Forget>
void TimeBricks(const SeriesFile& file, const FieldKey& field,
  const std::vector<std::int64_t>& bricks, const Forget& forget, std::vector<double>& microseconds)
{
  std::vector<std::uint8_t> values = BrickBuffer(file, field);
  for (const std::int64_t brick : bricks)
  {
    forget();
    const Timer decode;
    file.DecodeBrick(field, brick, values.data());
    microseconds.push_back(Microseconds(decode));
  }
}

/// Reads the payloads of a step.
/// @return the bricks that have any, in order
std::vector<std::int64_t> BringIntoMemory(const SeriesFile& file, const FieldKey& field)
{
  std::vector<std::int64_t> bricks = BricksWithPayload(file, field);
  file.VerifyBricks(field, bricks);
  return bricks;
}

void MeasureWarm(const std::string& path, int array, std::mt19937_64& random, DecodeTimes& times)
{
  const auto file = SeriesFile::Open(path);
  QuantizedBlockCache& decoded = file->Caches()->Blocks();
  std::vector<double> warm, finest;
  for (int i = 0; i < std::min(StepsMeasured, file->Index().Steps()); ++i)
  {
    FieldKey field;
    field.Step = static_cast<int>(random() % static_cast<std::uint64_t>(file->Index().Steps()));
    field.Array = array;
    std::vector<std::int64_t> bricks = BringIntoMemory(*file, field);
    std::shuffle(bricks.begin(), bricks.end(), random);
    bricks.resize(std::min(bricks.size(), WarmBricksPerStep));
    TimeBricks(
      *file, field, bricks, [&] { decoded.ForgetAll(); }, warm);
    std::vector<double> first; // leaves the coarser planes behind
    TimeBricks(
      *file, field, bricks, [&] { decoded.ForgetFinest(); }, first);
    TimeBricks(
      *file, field, bricks, [&] { decoded.ForgetFinest(); }, finest);
  }
  times.Warm = Summarize(std::move(warm));
  times.Finest = Summarize(std::move(finest));
}

/// Steps one after the other, from the first one of a group on.
void MeasureInOrder(const std::string& path, int array, std::mt19937_64& random, DecodeTimes& times)
{
  const auto file = SeriesFile::Open(path);
  const int steps = file->Index().Steps();
  const auto& segments = file->Index().Segments;
  const int first = segments[random() % segments.size()].FirstStep;
  double bytes = 0.0;
  std::vector<std::vector<std::int64_t>> bricks;
  FieldKey field;
  field.Array = array;
  std::vector<std::uint8_t> values = BrickBuffer(*file, field);
  for (field.Step = first; field.Step < std::min(first + StepsMeasured, steps); ++field.Step)
  {
    bricks.push_back(BringIntoMemory(*file, field));
    for (const std::int64_t brick : bricks.back())
    {
      bytes +=
        static_cast<double>(file->Layout(0).SamplesOf(brick).Count()) *
        static_cast<double>(SizeOf(file->Index().Arrays[static_cast<std::size_t>(array)].Type));
    }
  }
  file->Caches()->Blocks().ForgetAll();
  const Timer inOrder;
  for (std::size_t i = 0; i < bricks.size(); ++i)
  {
    field.Step = first + static_cast<int>(i);
    for (const std::int64_t brick : bricks[i])
    {
      file->DecodeBrick(field, brick, values.data());
    }
  }
  const double seconds = inOrder.Seconds();
  times.SequentialBytesPerSecond = seconds > 0.0 ? bytes / seconds : 0.0;
}

} // namespace

TimeSummary Summarize(std::vector<double> microseconds)
{
  TimeSummary summary;
  summary.Count = static_cast<std::int64_t>(microseconds.size());
  if (microseconds.empty())
  {
    return summary;
  }
  std::sort(microseconds.begin(), microseconds.end());
  const std::size_t count = microseconds.size();
  summary.Median = 0.5 * (microseconds[(count - 1) / 2] + microseconds[count / 2]);
  summary.Mean =
    std::accumulate(microseconds.begin(), microseconds.end(), 0.0) / static_cast<double>(count);
  // The least value that 95 in 100 do not exceed.
  summary.Percentile95 = microseconds[(95 * count + 99) / 100 - 1];
  return summary;
}

DecodeTimes MeasureDecodeTimes(const std::string& path, int array, std::uint64_t seed)
{
  std::mt19937_64 random(seed);
  DecodeTimes times;
  MeasureCold(path, array, random, times);
  MeasureWarm(path, array, random, times);
  MeasureInOrder(path, array, random, times);
  return times;
}

} // namespace banyan
