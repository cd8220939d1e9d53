// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_PlanTesting_h
#define banyan_Testing_PlanTesting_h

#include "BenchScene.h"

#include "Base/ThreadPool.h"
#include "Render/Raycast/InterpolateSkippedPixels.h"
#include "Render/Sampling/SamplingPlan.h"

#include <memory>

namespace banyan::plan_testing
{

constexpr int LeastCells = 7; // the volumes of these tests are smooth

/// Draws a scene of a volume in memory, and plans how to.
class Drawer
{
public:
  explicit Drawer(const bench::BenchScene& scene)
    : Data(scene.Data)
    , Source(scene.Data->Array(), 16, MaskRange{ scene.Low, scene.High }, this->Pool)
    , Scene(ToRayScene(scene, 1.0, 1.0f))
  {
  }

  SamplingPlan Plan(double tolerance, int coarsestLevel)
  {
    return PlanSamplings(this->Scene,
      { tolerance, this->Scene.SampleDistance, coarsestLevel, 0, LeastCells },
      [this](const RayScene& probe) { return this->Cast(probe); });
  }

  FloatImage Draw(const SamplingPlan& plan)
  {
    RayScene scene = this->Scene;
    scene.Samplings = plan.Samplings;
    scene.OpacityLimit = plan.OpacityLimit;
    FloatImage picture = this->Cast(scene);
    InterpolateSkippedPixels(scene, picture, this->Pool);
    return picture;
  }

  FloatImage Converged()
  {
    RayScene scene = this->Scene;
    scene.SampleDistance /= 32.0;
    return this->Cast(scene);
  }

  FloatImage Cast(const RayScene& scene)
  {
    return CastRays(scene, this->Source, scene.DomainCells, std::uint64_t{ 1 } << 30, this->Pool,
      this->Statistics);
  }

  ThreadPool Pool{ 2 };
  std::shared_ptr<const bench::Volume> Data;
  ArrayBrickSource Source;
  RayScene Scene;
  RayStatistics Statistics;
};

} // namespace banyan::plan_testing

#endif
