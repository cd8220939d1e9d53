// SPDX-License-Identifier: BSD-3-Clause
#include "CodecMethod.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Cache/BrickCache.h"
#include "Series/Decode/CacheContext.h"
#include "Series/Decode/SeriesFile.h"
#include "Series/Encode/SeriesEncoder.h"

#include <algorithm>
#include <filesystem>
#include <functional>

namespace banyan::bench
{
namespace
{

namespace fs = std::filesystem;

/// Enough for the steps that a decoder goes back to, and much less than a usual series needs.
constexpr std::uint64_t CacheBytes = std::uint64_t{ 128 } << 20;

std::uint64_t BytesOnDisk(const std::string& index)
{
  std::uint64_t bytes = fs::file_size(index);
  for (const auto& entry : fs::recursive_directory_iterator(index + ".d"))
  {
    bytes += entry.is_regular_file() ? entry.file_size() : 0;
  }
  return bytes;
}

class BanyanSeries : public EncodedSeries
{
public:
  explicit BanyanSeries(const std::string& index)
    : IndexPath(index)
  {
    this->Forget();
  }

  std::uint64_t Bytes() const override { return BytesOnDisk(this->IndexPath); }

  void Forget() override
  {
    this->Cache = std::make_unique<BrickCache>(CacheBytes);
    this->File = SeriesFile::Open(this->IndexPath);
  }

  void DecodeStep(int step, float* values) override
  {
    const FieldKey field{ step, 0, 0, 0 };
    const Box whole{ glm::ivec3(0), this->File->Layout(0).Samples() };
    ReadRegion(*this->Cache, *this->File, field, whole, values, 1, 0);
  }

  bool DecodesBricks() const override { return true; }

  bool KeepsDecoded() const override { return true; }

  void Keep(Decoded what) override
  {
    switch (what)
    {
      case Decoded::Nothing:
        return this->File->Caches()->Blocks().ForgetAll();
      case Decoded::CoarserPlanes:
        return this->File->Caches()->Blocks().ForgetFinest();
      case Decoded::All:
        return;
    }
  }

  /// Past the cache of bricks, but not past that of the numbers that bricks are predicted from.
  void DecodeBrick(int step, const Box& samples, float* values) override
  {
    const FieldKey field{ step, 0, 0, 0 };
    const BrickLayout layout = this->File->Layout(0);
    const Box bricks = layout.BricksCovering(samples);
    for (int z = bricks.Lo.z; z < bricks.Hi.z; ++z)
    {
      for (int y = bricks.Lo.y; y < bricks.Hi.y; ++y)
      {
        for (int x = bricks.Lo.x; x < bricks.Hi.x; ++x)
        {
          const std::int64_t brick = layout.IndexOf({ x, y, z });
          const Box part = Intersection(layout.SamplesOf(brick), samples);
          if (part.Empty())
          {
            continue;
          }
          const glm::ivec3 size = samples.Size(), low = part.Lo - samples.Lo;
          const glm::i64vec3 stride{ 1, size.x, std::int64_t{ size.x } * size.y };
          this->File->DecodePart(
            field, brick, part, stride, values + low.x + low.y * stride.y + low.z * stride.z);
        }
      }
    }
  }

private:
  std::string IndexPath;
  std::shared_ptr<SeriesFile> File;
  std::unique_ptr<BrickCache> Cache;
};

class BanyanMethod : public CodecMethod
{
public:
  BanyanMethod(const std::string& name, const EncodeOptions& options)
    : CodecMethod(name)
    , Options(options)
  {
  }

  std::unique_ptr<EncodedSeries> Encode(
    const RawSeries& series, const CodecSettings& settings) const override
  {
    ArrayDescription array;
    array.Name = "values";
    array.ComponentNames = { "" };
    array.SeriesRanges = { series.FullRange() };
    // The same absolute bound for every method, whatever range it was made from.
    EncodeOptions options = this->Options;
    options.Mode = ErrorBoundMode::Absolute;
    options.ErrorBound = settings.ErrorBound;
    const std::string path = settings.WorkFolder + "/series.banyan";
    ThreadPool pool(1);
    SeriesEncoder encoder(path, series.Domain(), { array }, options, pool);
    for (int step = 0; step < series.Steps(); ++step)
    {
      encoder.AddStep(step, { { series.Step(step) } });
    }
    encoder.Finish();
    return std::make_unique<BanyanSeries>(path);
  }

private:
  EncodeOptions Options;
};

struct Variant
{
  const char* Name;
  void (*Set)(EncodeOptions&);
};

/// The rows of the report that are ours: add a line here to measure other settings.
constexpr Variant Variants[] = {
  { "banyan", [](EncodeOptions&) {} },
  { "banyan-fast", [](EncodeOptions& options) { options.Profile = EncodeProfile::Fast; } },
  { "banyan-compact", [](EncodeOptions& options) { options.Profile = EncodeProfile::Compact; } },
  { "banyan-every-step", [](EncodeOptions& options) { options.KeyframeInterval = 1; } },
  { "banyan-32", [](EncodeOptions& options) { options.BrickCells = 32; } },
  // What each idea is worth.
  { "banyan-without-activity",
    [](EncodeOptions& options) { options.Ablation.TablesByActivity = false; } },
  { "banyan-without-sharing",
    [](EncodeOptions& options) { options.Ablation.SharedTables = false; } },
  { "banyan-without-axes",
    [](EncodeOptions& options) { options.Ablation.SmoothestAxisLast = false; } },
  { "banyan-without-group-before",
    [](EncodeOptions& options) { options.Ablation.GroupBefore = false; } },
  { "banyan-without-modes", [](EncodeOptions& options) { options.Ablation.AllModes = false; } },
};

} // namespace

void AppendBanyanMethods(MethodList& methods)
{
  for (const Variant& variant : Variants)
  {
    EncodeOptions options;
    variant.Set(options);
    methods.push_back(std::make_unique<BanyanMethod>(variant.Name, options));
  }
}

} // namespace banyan::bench
