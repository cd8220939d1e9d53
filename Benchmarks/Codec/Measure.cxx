// SPDX-License-Identifier: BSD-3-Clause
#include "Measure.h"

#include "Deviation.h"

#include "Base/Error.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>

#include <time.h>

namespace banyan::bench
{
namespace
{

namespace fs = std::filesystem;

double ProcessorSeconds()
{
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double Median(std::vector<double> values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1)
  {
    return *middle;
  }
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

/// Calls `pass()`, which returns its seconds, until it was repeated or patient enough.
template <class Pass>
double MedianSeconds(const MeasureOptions& options, Pass&& pass)
{
  std::vector<double> seconds;
  double sum = 0;
  for (int i = 0; i < options.Repeat && (i == 0 || sum < options.PatienceSeconds); ++i)
  {
    seconds.push_back(pass());
    sum += seconds.back();
  }
  return Median(seconds);
}

/// A folder that is removed with all that it holds.
class OwnFolder
{
public:
  explicit OwnFolder(const std::string& path)
    : Path(path)
  {
    this->Empty();
  }
  ~OwnFolder()
  {
    std::error_code ignored;
    fs::remove_all(this->Path, ignored);
  }
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;

  void Empty() const
  {
    fs::remove_all(this->Path);
    fs::create_directories(this->Path);
  }

private:
  std::string Path;
};

double DecodeAllSeconds(EncodedSeries& encoded, const RawSeries& series, Deviation* deviation)
{
  std::vector<float> values(series.VoxelsPerStep());
  double seconds = 0;
  for (int step = 0; step < series.Steps(); ++step)
  {
    const double start = ProcessorSeconds();
    if (step == 0)
    {
      encoded.Forget();
    }
    encoded.DecodeStep(step, values.data());
    seconds += ProcessorSeconds() - start;
    if (deviation != nullptr)
    {
      deviation->Include(series.Step(step), values.data(), values.size());
    }
  }
  return seconds;
}

/// What the stages of decoding all steps take, by the clock.
stages::Spent DecodingStages(EncodedSeries& encoded, const RawSeries& series)
{
  const stages::Spent before = stages::OfThisThread();
  DecodeAllSeconds(encoded, series, nullptr);
  stages::Spent spent = stages::OfThisThread();
  for (int stage = 0; stage < stages::Count; ++stage)
  {
    spent.Ticks[stage] -= before.Ticks[stage];
    spent.Times[stage] -= before.Times[stage];
  }
  spent.SymbolsRead -= before.SymbolsRead;
  return spent;
}

struct BrickQuery
{
  int Step;
  Box Samples;
};

/// The same for every method.
std::vector<BrickQuery> RandomBricks(const RawSeries& series, int count)
{
  constexpr int edge = 16;
  const glm::ivec3 samples = series.Samples();
  const glm::ivec3 bricks = (samples + (edge - 1)) / edge;
  std::mt19937 random(1);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  std::vector<BrickQuery> queries;
  for (int i = 0; i < count; ++i)
  {
    const int step = below(series.Steps());
    const int x = below(bricks.x), y = below(bricks.y), z = below(bricks.z);
    const glm::ivec3 low = edge * glm::ivec3(x, y, z);
    queries.push_back({ step, { low, glm::min(low + edge, samples) } });
  }
  return queries;
}

/// Of the original, in the brick's own order.
std::vector<float> BrickOf(const RawSeries& series, const BrickQuery& query)
{
  const Box& box = query.Samples;
  std::vector<float> values;
  for (int z = box.Lo.z; z < box.Hi.z; ++z)
  {
    for (int y = box.Lo.y; y < box.Hi.y; ++y)
    {
      const float* row =
        series.Step(query.Step) + (std::size_t(z) * series.Samples().y + y) * series.Samples().x;
      values.insert(values.end(), row + box.Lo.x, row + box.Hi.x);
    }
  }
  return values;
}

/// Bricks by themselves. Each is decoded once more and compared, which brings files into memory and
/// is not timed.
class RandomBrickTimes
{
public:
  RandomBrickTimes(EncodedSeries& encoded, const RawSeries& series, const MeasureOptions& options)
    : Encoded(encoded)
    , Options(options)
    , Queries(RandomBricks(series, options.Bricks))
    , Values(16 * 16 * 16)
  {
    for (const BrickQuery& query : this->Queries)
    {
      this->Decode(query);
      const std::vector<float> original = BrickOf(series, query);
      this->Difference.Include(original.data(), this->Values.data(), original.size());
    }
  }

  const Deviation& Found() const { return this->Difference; }

  /// @param kept of what was decoded, before each brick
  double Microseconds(Decoded kept)
  {
    this->Encoded.Keep(Decoded::Nothing);
    this->Pass(kept); // leaves behind what may be kept
    const double seconds = MedianSeconds(this->Options, [&] { return this->Pass(kept); });
    return 1e6 * seconds / static_cast<double>(this->Queries.size());
  }

private:
  void Decode(const BrickQuery& query)
  {
    this->Encoded.DecodeBrick(query.Step, query.Samples, this->Values.data());
  }

  double Pass(Decoded kept)
  {
    double seconds = 0;
    double start = ProcessorSeconds();
    for (const BrickQuery& query : this->Queries)
    {
      if (kept != Decoded::All && this->Encoded.KeepsDecoded())
      {
        seconds += ProcessorSeconds() - start;
        this->Encoded.Keep(kept);
        start = ProcessorSeconds();
      }
      this->Decode(query);
    }
    return seconds + ProcessorSeconds() - start;
  }

  EncodedSeries& Encoded;
  const MeasureOptions& Options;
  std::vector<BrickQuery> Queries;
  std::vector<float> Values;
  Deviation Difference;
};

} // namespace

double Measurement::ErrorOverBound() const
{
  if (this->ErrorBound > 0)
  {
    return this->LargestError / this->ErrorBound;
  }
  return this->LargestError == 0 ? 0.0 : std::numeric_limits<double>::infinity();
}

double ErrorBoundFor(const RawSeries& series, int bits)
{
  return std::ldexp(series.BoundRange().Width(), -(bits + 1));
}

Measurement Measure(
  CodecMethod& method, const RawSeries& series, int bits, const MeasureOptions& options)
{
  const CodecSettings settings{ bits, ErrorBoundFor(series, bits),
    options.WorkFolder + "/encoding" };
  const OwnFolder folder(settings.WorkFolder);
  method.Prepare(series, settings);
  std::unique_ptr<EncodedSeries> encoded;
  const double encodeSeconds = MedianSeconds(options,
    [&]
    {
      encoded.reset();
      folder.Empty();
      const double start = ProcessorSeconds();
      encoded = method.Encode(series, settings);
      return ProcessorSeconds() - start;
    });
  Deviation whole;
  DecodeAllSeconds(*encoded, series, &whole); // brings files into memory: not timed
  const double decodeSeconds =
    MedianSeconds(options, [&] { return DecodeAllSeconds(*encoded, series, nullptr); });

  Measurement result;
  double worstBrick = 0;
  if (encoded->DecodesBricks() && options.Bricks > 0)
  {
    RandomBrickTimes bricks(*encoded, series, options);
    worstBrick = bricks.Found().Largest();
    result.RandomBrickMicroseconds = bricks.Microseconds(Decoded::Nothing);
    if (encoded->KeepsDecoded())
    {
      result.FinestBrickMicroseconds = bricks.Microseconds(Decoded::CoarserPlanes);
      result.KeptBrickMicroseconds = bricks.Microseconds(Decoded::All);
    }
  }
  const double voxels = static_cast<double>(series.VoxelsPerStep()) * series.Steps();
  const double megabytes = voxels * sizeof(float) / 1e6;
  if (options.Stages)
  {
    result.Decoding = DecodingStages(*encoded, series);
  }
  result.Samples = voxels;
  result.SamplesOfStep = series.VoxelsPerStep();
  result.Dataset = series.Name();
  result.Method = method.Name();
  result.BitsOfAccuracy = bits;
  result.ErrorBound = settings.ErrorBound;
  result.LargestError = std::max(whole.Largest(), worstBrick);
  result.Range = series.BoundRange().Width();
  result.SignalToNoiseDecibels = whole.SignalToNoiseDecibels(result.Range);
  result.Bytes = encoded->Bytes();
  result.BitsPerVoxel = 8.0 * static_cast<double>(result.Bytes) / voxels;
  result.EncodeMegabytesPerSecond = megabytes / encodeSeconds;
  result.DecodeMegabytesPerSecond = megabytes / decodeSeconds;
  return result;
}

} // namespace banyan::bench
