#include "RayCastRenderer.h"

#include "Base/ThreadPool.h"
#include "Render/PixelsBetween.h"
#include "Render/SamplingPlan.h"

namespace banyan::bench
{
namespace
{

/// With fixed sample distances, as VTK's GPU mapper: a ray ends when one step of 8 bits is all that
/// could follow.
constexpr float OpacityLimit = 1.0f - 1.0f / 255.0f;
constexpr int BrickCells = 16; // as the mapper cuts plain data
constexpr int CoarsestLevel = 3;

class BanyanRenderer : public RayCastRenderer
{
public:
  explicit BanyanRenderer(int threads)
    : Pool(threads)
  {
  }

  std::string Name() const override { return "banyan"; }

  std::vector<Setting> SettingsFor(const BenchScene&) const override
  {
    std::vector<Setting> settings;
    for (const double distance : { 0.25, 0.5, 1.0, 2.0, 4.0 })
    {
      settings.push_back({ {}, distance });
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
      this->Source = std::make_unique<ArrayBrickSource>(this->Scene->Data->Array(), BrickCells,
        MaskRange{ this->Scene->Low, this->Scene->High }, this->Pool);
    }
    RayStatistics statistics;
    const RayScene drawn =
      this->SceneWith(this->Settings.at(number), statistics, frame.EstimatedError);
    FloatImage image = this->Cast(drawn, statistics);
    FillBetweenRays(drawn, image, this->Pool);
    clock.StopInto(frame);
    frame.Shown = Rounded(image, this->Scene->Picture);
    frame.Unrounded = std::move(image);
    frame.Samples = statistics.SamplesTaken;
    return frame;
  }

private:
  FloatImage Cast(const RayScene& scene, RayStatistics& statistics)
  {
    return CastRays(
      scene, *this->Source, scene.DomainCells, ~std::uint64_t{ 0 }, this->Pool, statistics);
  }

  /// What finding samplings for a tolerance takes is part of the frame.
  RayScene SceneWith(
    const Setting& setting, RayStatistics& statistics, std::optional<double>& estimatedError)
  {
    RayScene scene = ToRayScene(*this->Scene, setting.SampleDistance.value_or(1.0), OpacityLimit);
    if (setting.Tolerance)
    {
      const SamplingPlan plan =
        PlanSamplings(scene, { *setting.Tolerance, scene.SampleDistance, CoarsestLevel },
          [&](const RayScene& pilot) { return this->Cast(pilot, statistics); });
      scene.Samplings = plan.Samplings;
      scene.OpacityLimit = plan.OpacityLimit;
      estimatedError = plan.EstimatedError;
    }
    return scene;
  }

  ThreadPool Pool;
  const BenchScene* Scene = nullptr;
  std::vector<Setting> Settings;
  std::unique_ptr<ArrayBrickSource> Source; ///< of the scene, once something was drawn
};

} // namespace

std::unique_ptr<RayCastRenderer> MakeBanyanRenderer(int threads)
{
  return std::make_unique<BanyanRenderer>(threads);
}

} // namespace banyan::bench
