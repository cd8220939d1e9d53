// SPDX-License-Identifier: BSD-3-Clause
#include "RayCastRenderer.h"

#include "Base/ThreadPool.h"
#include "Render/Raycast/InterpolateSkippedPixels.h"
#include "Render/Sampling/SamplingPlan.h"

namespace banyan::bench
{
namespace
{

/// With fixed sample distances, as VTK's GPU mapper: a ray ends when one step of 8 bits is all that
/// could follow.
constexpr float OpacityLimit = 1.0f - 1.0f / 255.0f;
/// Of encoded series, and of all data while somebody moves the camera; still pictures of plain data
/// do without coarser levels.
constexpr int CoarsestLevel = 3;

class BanyanRenderer : public RayCastRenderer
{
public:
  BanyanRenderer(int threads, bool plain)
    : Pool(threads)
    , Plain(plain)
  {
  }

  std::string Name() const override { return this->Plain ? "banyan-plain" : "banyan"; }

  std::vector<Setting> SettingsFor(const BenchScene&) const override
  {
    std::vector<Setting> settings;
    // At fixed distances there are no levels: plain data are drawn like all others.
    for (const double distance : { 0.25, 0.5, 1.0, 2.0, 4.0 })
    {
      if (!this->Plain)
      {
        settings.push_back({ {}, distance });
      }
    }
    for (const double tolerance : { 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0, 255.0 })
    {
      settings.push_back({ tolerance, {} });
    }
    return settings;
  }

  void Prepare(const BenchScene& scene, const std::vector<Setting>& settings) override
  {
    this->Scene = &scene;
    this->Settings = settings;
    this->Source.reset();
  }

  Frame Draw(std::size_t number) override
  {
    Frame frame;
    const FrameClock clock;
    if (!this->Source)
    {
      const Timer tree;
      this->MakeTree();
      frame.TreeSeconds = tree.Seconds();
    }
    RayStatistics statistics;
    const RayScene drawn = this->SceneWith(this->Settings.at(number), statistics, frame);
    FloatImage image = this->Cast(drawn, statistics);
    InterpolateSkippedPixels(drawn, image, this->Pool);
    clock.StopInto(frame);
    frame.Shown = Rounded(image, this->Scene->Picture);
    frame.Unrounded = std::move(image);
    frame.Samples = statistics.SamplesTaken;
    return frame;
  }

private:
  /// As for plain data in memory: its range, and ranges and masks of its bricks.
  void MakeTree()
  {
    const SampleArray array = this->Scene->Data->Array();
    const ValueRange range = FiniteRange(array, this->Pool);
    this->Source = std::make_unique<ArrayBrickSource>(
      array, BrickCells, MaskRange{ range.Low, range.High }, this->Pool);
  }

  FloatImage Cast(const RayScene& scene, RayStatistics& statistics)
  {
    return CastRays(
      scene, *this->Source, scene.DomainCells, ~std::uint64_t{ 0 }, this->Pool, statistics);
  }

  /// What finding samplings for a tolerance takes is part of the frame.
  RayScene SceneWith(const Setting& setting, RayStatistics& statistics, Frame& frame)
  {
    RayScene scene = ToRayScene(*this->Scene, setting.SampleDistance.value_or(1.0), OpacityLimit);
    if (setting.Tolerance)
    {
      const SamplingPlan plan = PlanSamplings(scene,
        { *setting.Tolerance, scene.SampleDistance, this->Plain ? 0 : CoarsestLevel },
        [&](const RayScene& probe) { return this->Cast(probe, statistics); });
      scene.Samplings = plan.Samplings;
      scene.OpacityLimit = plan.OpacityLimit;
      frame.EstimatedError = plan.EstimatedError;
      frame.ProbeSeconds = plan.ProbeSeconds;
      frame.StrideSeconds = plan.StrideSeconds;
    }
    return scene;
  }

  ThreadPool Pool;
  bool Plain;
  const BenchScene* Scene = nullptr;
  std::vector<Setting> Settings;
  std::unique_ptr<ArrayBrickSource> Source; ///< of the scene, once something was drawn
};

} // namespace

std::unique_ptr<RayCastRenderer> MakeBanyanRenderer(int threads, bool plain)
{
  return std::make_unique<BanyanRenderer>(threads, plain);
}

} // namespace banyan::bench
