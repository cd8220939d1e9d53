// SPDX-License-Identifier: BSD-3-Clause
#include "PaperExperiment.h"

#include "PaperCounts.h"
#include "Papers/PaperQuantizer.h"
#include "PlaybackScene.h"
#include "RawSeries.h"

#include "Base/Error.h"
#include "Cache/BrickCache.h"
#include "Series/Decode/SeriesFile.h"

#include <algorithm>
#include <cstdio>

namespace banyan::bench
{
namespace
{

constexpr int Bits = 8;
constexpr double HighFrom = 0.7; ///< of the range: where the function "top" begins

/// One way to keep the values of a series.
struct Kind
{
  const char* Name;
  std::vector<std::string> Functions;
  PaperCounts Counts;
};

/// What codes of a step stand for. Values below the quantizer's range become the least value of the
/// series, which nothing shows.
std::vector<float> Coded(
  const ValueRange& levels, const ValueRange& all, const float* values, std::size_t count)
{
  const PaperQuantizer quantizer{ levels, Bits };
  std::vector<float> coded(count);
  std::transform(values, values + count, coded.begin(),
    [&](float value)
    {
      return static_cast<float>(
        value < levels.Low ? all.Low : quantizer.ValueOf(quantizer.CodeOf(value)));
    });
  return coded;
}

std::vector<float> Decoded(const SeriesFile& file, int step, std::size_t count)
{
  std::vector<float> values(count);
  ReadRegion(BrickCache::Of(file), file, { step, 0, 0, 0 },
    { glm::ivec3(0), file.Layout(0).Samples() }, values.data(), 1, 0);
  return values;
}

void PrintStep(const PlaybackOptions& options, const FieldPlace& place, const ValueRange& range,
  int step, const Kind& kind)
{
  for (const std::string& function : kind.Functions)
  {
    PlaybackOptions with = options;
    with.Function = function;
    const PaperCounts::Shares shares =
      kind.Counts.Of(MakePlaybackScene(with, place, range, step).Transfer);
    std::printf("%s,%s,%s,%d,%d,%d,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f\n", options.Name.c_str(),
      kind.Name, function.c_str(), options.Picture, options.BrickCells, step, shares.Bricks,
      shares.Shown, shares.EveryBrick, shares.ShownBricks, shares.Blocks, shares.Within[0],
      shares.Within[1]);
  }
}

} // namespace

void RunPaperExperiment(const PlaybackOptions& options)
{
  const RawSeries raw = RawSeries::Open(options.Paper);
  const auto file = SeriesFile::Open(options.Series);
  if (file->Layout(0).Samples() != raw.Samples() || file->Index().Steps() < raw.Steps() ||
      file->Index().Arrays[0].Type != ScalarType::Float32)
  {
    throw Error("The encoded series is not one of the raw values in '" + options.Paper +
                  "'; --encode makes one.",
      { options.Series });
  }
  const FieldPlace place = PlaceOfSamples(raw.Domain(), { glm::ivec3(0), raw.Samples() });
  const ValueRange all = raw.FullRange();
  const ValueRange high{ all.Low + HighFrom * all.Width(), all.High };
  const PaperCounts fresh(
    MakePlaybackScene(options, place, all, 0), raw.Samples(), options.BrickCells);
  const std::vector<std::string> functions{ "ramp", "top", "ends" };
  Kind floats{ "floats", functions, fresh };
  Kind codes{ "codes", functions, fresh };
  Kind codesOfHigh{ "codes of the top", { "top" }, fresh };
  Kind encoded{ "encoded", functions, fresh };
  std::printf("series,values,function,size,brick,step,bricks_same,samples_shown,every_brick,"
              "shown_bricks,blocks,within_1,within_8\n");
  const std::size_t count = raw.VoxelsPerStep();
  for (int step = 0; step < std::min(raw.Steps(), options.Frames); ++step)
  {
    const float* const values = raw.Step(step);
    floats.Counts.Take({ values, values + count });
    codes.Counts.Take(Coded(all, all, values, count));
    codesOfHigh.Counts.Take(Coded(high, all, values, count));
    encoded.Counts.Take(Decoded(*file, step, count));
    for (const Kind* kind : { &floats, &codes, &codesOfHigh, &encoded })
    {
      PrintStep(options, place, all, step, *kind);
    }
  }
}

} // namespace banyan::bench
