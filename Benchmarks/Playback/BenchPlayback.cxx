// SPDX-License-Identifier: BSD-3-Clause
// Frames of a series that plays: their times, and what they take from those before. A line of CSV
// for each frame. See README.md.
#include "PaperExperiment.h"
#include "PlaybackOptions.h"
#include "PlaybackScene.h"
#include "RawSeries.h"
#include "ReusableRays.h"
#include "SeriesFiles.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Base/Timer.h"
#include "Cache/BrickCache.h"
#include "Parallel/Communicate/MpiCommunicator.h"
#include "Parallel/Fields/SeriesInput.h"
#include "Parallel/Frame/FieldFrames.h"
#include "Render/Bricks/VisibleBricks.h"
#include "Series/Decode/CacheContext.h"
#include "Series/Encode/SeriesEncoder.h"

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>

namespace
{

using namespace banyan;
using namespace banyan::bench;

const char* const Columns =
  "series,mode,function,size,tolerance,shaded,ranks,reuse,pass,frame,step,"
  "ms,samples,plan_ms,render_ms,composite_ms,decode_ms,wait_ms,bytes_read,bricks_decoded,"
  "decoded_ahead,bytes_composited,changed_fraction,reused_fraction,"
  "estimated_error,true_error,max_difference,resident_mb\n";

/// Memory of this process that is resident now, in MiB: mapped files do not count.
double ResidentMiB()
{
  std::ifstream status("/proc/self/status");
  std::string word;
  double kibibytes = 0.0;
  while (status >> word && word != "RssAnon:")
  {
  }
  status >> kibibytes;
  return kibibytes / 1024.0;
}

void Encode(const PlaybackOptions& options)
{
  const RawSeries raw = RawSeries::Open(options.Encode);
  ArrayDescription array;
  array.Name = raw.Name();
  array.ComponentNames = { "" };
  array.SeriesRanges = { raw.BoundRange() };
  EncodeOptions encoding;
  encoding.ErrorBound = options.Bound;
  SeriesEncoder encoder(options.Series, raw.Domain(), { array }, encoding, ThreadPool::Process());
  for (int step = 0; step < raw.Steps(); ++step)
  {
    encoder.AddStep(step, { { raw.Step(step) } });
  }
  encoder.Finish();
  BringToDisk(options.Series);
}

/// Of the visible bricks of a step, the part that differs from the step before.
class Changes
{
public:
  double Since(BrickSource* source, const RayScene& scene)
  {
    const VisibleBricks visible(scene, *source);
    const glm::ivec3 counts = source->Bricks();
    std::vector<Hash128> now(static_cast<std::size_t>(counts.x) * counts.y * counts.z);
    int seen = 0;
    int changed = 0;
    for (std::size_t brick = 0; brick < now.size(); ++brick)
    {
      const auto number = static_cast<std::int64_t>(brick);
      now[brick] = source->ContentOf(number).value_or(Hash128());
      if (visible.Contains(number))
      {
        ++seen;
        changed += this->Before.size() != now.size() || this->Before[brick] != now[brick] ? 1 : 0;
      }
    }
    this->Before = std::move(now);
    return seen > 0 ? static_cast<double>(changed) / seen : 0.0;
  }

private:
  std::vector<Hash128> Before;
};

/// What one rank has read and decoded so far.
struct Decoding
{
  double Seconds = 0.0; ///< of all threads
  double Waited = 0.0;  ///< seconds of threads that draw
  double Bytes = 0.0;
  double Bricks = 0.0;
  double Ahead = 0.0; ///< bricks that were asked for and had been decoded ahead

  static Decoding Of(const BrickCache& cache, const DrawnField& drawn)
  {
    const BrickCache::Statistics numbers = cache.GetStatistics();
    return { numbers.DecodeSeconds, numbers.WaitSeconds, static_cast<double>(drawn.BytesRead()),
      static_cast<double>(numbers.Misses), static_cast<double>(cache.GetAheadStatistics().Hits) };
  }

  /// Collective: what all ranks have done since then.
  Decoding Since(const Decoding& before, Communicator& ranks) const
  {
    const auto all = [&ranks, this, &before](double Decoding::*number)
    { return AllSum(ranks, this->*number - before.*number); };
    return { all(&Decoding::Seconds), all(&Decoding::Waited), all(&Decoding::Bytes),
      all(&Decoding::Bricks), all(&Decoding::Ahead) };
  }
};

double LargestDifference(const FloatImage& a, const FloatImage& b)
{
  float largest = 0.0f;
  for (std::size_t i = 0; i < a.Pixels.size(); ++i)
  {
    const glm::vec4 difference = glm::abs(a.Pixels[i] - b.Pixels[i]);
    largest = std::max({ largest, difference.r, difference.g, difference.b, difference.a });
  }
  return 255.0 * largest;
}

/// A series that is played several times.
class Playback
{
public:
  Playback(const PlaybackOptions& options, Communicator& communicator, std::FILE* table)
    : Options(options)
    , Ranks(communicator)
    , Table(table)
  {
  }

  void Run()
  {
    // The first pass of a process finds memory and threads cold: it does not count.
    this->Pass(Warming, this->Options.Reuse.front());
    for (int pass = 0; pass < this->Options.Passes; ++pass)
    {
      for (const bool reuse : this->Options.Reuse)
      {
        this->Pass(pass, reuse);
      }
    }
  }

private:
  static constexpr int Warming = -1; ///< number of a pass

  /// What was measured of a frame.
  struct Row
  {
    int Pass;
    int Frame;
    int Step;
    bool Reuse;
    double Milliseconds;
    Decoding Decoded = {};
    double Changed = 0.0;    ///< part of the visible bricks
    double Difference = 0.0; ///< in 1/255
    double TrueError = 0.0;  ///< in 1/255
  };

  int StepOf(int frame, int steps) const
  {
    const PlayMode mode = this->Options.Mode;
    return mode == PlayMode::Play || mode == PlayMode::Loop ? frame % steps : steps / 2;
  }

  FieldFrames::Wish WishOf(bool reuse) const
  {
    FieldFrames::Wish wish;
    wish.Sampling.Still = this->Options.Tolerance > 0.0 ? this->Options.Tolerance : 1.0;
    wish.Sampling.FixedDistance = this->Options.Tolerance == 0.0;
    wish.Sampling.KeepsTolerance = this->Options.Tolerance > 0.0;
    wish.Reuse = wish.Sampling.PlansOfGroups = reuse;
    return wish;
  }

  void Pass(int pass, bool reuse)
  {
    if (this->Options.Cold)
    {
      DropFromCache(this->Options.Series);
    }
    this->Ranks.Barrier();
    const std::int64_t budget =
      this->Options.BudgetMiB < 0
        ? static_cast<std::int64_t>(CacheContext::Process()->BudgetBytes())
        : std::int64_t{ this->Options.BudgetMiB } << 20;
    SeriesInput input(SeriesFile::Open(this->Options.Series, CacheContext::WithBudget(budget)));
    DistributedField field;
    field.SetLoadBalancing(LoadBalancing::MeasuredCost);
    FieldFrames frames;
    Changes changes;
    const int steps = std::min(input.Series()->Index().Steps(), this->Options.Frames);
    const bool twice = this->Options.Mode == PlayMode::Loop;
    const int count = twice                                  ? 2 * steps
                      : this->Options.Mode == PlayMode::Play ? steps * this->Options.Rounds
                                                             : this->Options.Frames;
    for (int number = 0; number < count; ++number)
    {
      input.Step = this->StepOf(number, steps);
      const BrickCache& cache = BrickCache::Of(*input.Series());
      const Decoding before = Decoding::Of(cache, field.Drawn());
      this->Ranks.Barrier();
      const Timer timer;
      field.Update(this->Ranks, input);
      if (!field.Problem().empty())
      {
        throw Error(field.Problem());
      }
      RayScene scene = MakePlaybackScene(this->Options, field.Place(), field.Range(), number);
      const FieldFrames::Frame frame = frames.Draw(this->Ranks, field, scene, this->WishOf(reuse));
      Row row{ pass, number, input.Step, reuse, 1e3 * AllMax(this->Ranks, timer.Seconds()) };
      row.Decoded = Decoding::Of(cache, field.Drawn()).Since(before, this->Ranks);
      row.Changed = changes.Since(field.Drawn().Source(), scene);
      row.Difference = this->Difference(frame, reuse, number);
      row.TrueError = this->TrueError(frame, field, number);
      if (this->Ranks.Rank() == 0 && pass != Warming && !(twice && number < steps))
      {
        this->Write(row, frame);
      }
      std::this_thread::sleep_for(
        std::chrono::duration<double, std::milli>(this->Options.ShownMilliseconds));
    }
  }

  void Write(const Row& row, const FieldFrames::Frame& frame)
  {
    const FrameStatistics took = frame.Kept ? FrameStatistics() : frame.Picture.Statistics;
    const double threads = static_cast<double>(ThreadPool::Process().Width()) * this->Ranks.Size();
    std::fprintf(this->Table,
      "%s,%s,%s,%d,%g,%d,%d,%s,%d,%d,%d,%.3f,%lld,%.3f,%.3f,%.3f,%.3f,%.3f,%.0f,%.0f,%.0f,%llu,"
      "%.4f,%.4f,%.3f,%.3f,%.4f,%.1f\n",
      this->Options.Name.c_str(), this->ModeName(), this->Options.Function.c_str(),
      this->Options.Picture, this->Options.Tolerance, this->Options.Shaded ? 1 : 0,
      this->Ranks.Size(), row.Reuse ? "on" : "off", row.Pass, row.Frame, row.Step, row.Milliseconds,
      static_cast<long long>(took.SamplesTaken), 1e3 * (took.ProbeSeconds + took.StrideSeconds),
      1e3 * took.RenderSeconds, 1e3 * took.CompositeSeconds, 1e3 * row.Decoded.Seconds,
      1e3 * row.Decoded.Waited / threads, row.Decoded.Bytes, row.Decoded.Bricks, row.Decoded.Ahead,
      static_cast<unsigned long long>(took.BytesComposited), row.Changed, frame.ReusedFraction(),
      frame.Picture.EstimatedError, row.TrueError, row.Difference, ResidentMiB());
  }

  /// In 1/255; 0 unless it is wanted.
  double TrueError(const FieldFrames::Frame& frame, DistributedField& field, int number)
  {
    if (!this->Options.Truth)
    {
      return 0.0;
    }
    RayScene scene = MakePlaybackScene(this->Options, field.Place(), field.Range(), number);
    scene.SampleDistance *= 0.125;
    scene.OpacityLimit = 0.99999f;
    FrameStatistics took;
    DrawnField& drawn = field.Drawn();
    const FloatImage truth = DrawDistributed(this->Ranks, scene,
      { drawn.Source(), drawn.Zones(), field.DrawingBudget(), ThreadPool::Process() }, took);
    return this->Ranks.Rank() == 0 ? LargestDifference(truth, *frame.Picture.Pixels) : 0.0;
  }

  /// To the picture that was drawn with nothing from before, where both are drawn.
  double Difference(const FieldFrames::Frame& frame, bool reuse, int number)
  {
    if (this->Ranks.Rank() != 0)
    {
      return 0.0;
    }
    const auto at = static_cast<std::size_t>(number);
    if (!reuse)
    {
      this->FromNothing.resize(std::max(this->FromNothing.size(), at + 1));
      this->FromNothing[at] = frame.Picture.Pixels;
      return 0.0;
    }
    return at < this->FromNothing.size()
             ? LargestDifference(*this->FromNothing[at], *frame.Picture.Pixels)
             : 0.0;
  }

  const char* ModeName() const
  {
    const char* const names[] = { "play", "loop", "rest", "turn", "function" };
    return names[static_cast<int>(this->Options.Mode)];
  }

  const PlaybackOptions& Options;
  Communicator& Ranks;
  std::FILE* Table; ///< null but on rank 0
  std::vector<std::shared_ptr<const FloatImage>> FromNothing;
};

/// A line for each step.
void Count(const PlaybackOptions& options)
{
  const auto alone = MakeSelfCommunicator();
  SeriesInput input(SeriesFile::Open(options.Series));
  DistributedField field;
  ReusableRays rays;
  std::printf("series,function,size,step,bricks_changed,packets_same,samples_same,pixels_same\n");
  const int steps = std::min(input.Series()->Index().Steps(), options.Frames);
  for (input.Step = 0; input.Step < steps; ++input.Step)
  {
    field.Update(*alone, input);
    const RayScene scene = MakePlaybackScene(options, field.Place(), field.Range(), input.Step);
    const ReusableRays::Shares shares =
      rays.Since(scene, *field.Drawn().Source(), field.DrawingBudget());
    std::printf("%s,%s,%d,%d,%.4f,%.4f,%.4f,%.4f\n", options.Name.c_str(), options.Function.c_str(),
      options.Picture, input.Step, shares.Bricks, shares.Packets, shares.Samples, shares.Pixels);
  }
}

void Play(const PlaybackOptions& options)
{
  const MPI_Comm world = MPI_COMM_WORLD;
  const auto communicator = MakeMpiCommunicator(&world);
  ThreadPool::SetRanksOnThisNode(communicator->RanksOnThisNode());
  std::FILE* table = nullptr;
  if (communicator->Rank() == 0)
  {
    const bool fresh = !std::filesystem::exists(options.Output);
    table = std::fopen(options.Output.c_str(), "a");
    if (!table)
    {
      throw Error("The table cannot be written.", { options.Output });
    }
    if (fresh)
    {
      std::fputs(Columns, table);
    }
  }
  Playback(options, *communicator, table).Run();
  if (table)
  {
    std::fclose(table);
  }
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    const PlaybackOptions options = ParsePlaybackOptions({ argv + 1, argv + argc });
    if (options.Help)
    {
      std::fputs(PlaybackHelp, stdout);
    }
    else if (!options.Encode.empty())
    {
      Encode(options);
    }
    else if (!options.Paper.empty())
    {
      RunPaperExperiment(options);
    }
    else if (options.Count)
    {
      Count(options);
    }
    else
    {
      MPI_Init(nullptr, nullptr);
      try
      {
        Play(options);
      }
      catch (const std::exception& error)
      {
        std::fprintf(stderr, "banyan-bench-playback: %s\n", error.what());
        MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
      }
      MPI_Finalize();
    }
    return EXIT_SUCCESS;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "banyan-bench-playback: %s\n", error.what());
  }
  return EXIT_FAILURE;
}
