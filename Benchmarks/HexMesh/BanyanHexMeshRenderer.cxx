// SPDX-License-Identifier: BSD-3-Clause
#include "HexMeshRenderer.h"

#include "Base/ThreadPool.h"
#include "Base/Timer.h"
#include "Mesh/Octree/HexBrickSource.h"
#include "Render/Raycast/InterpolateSkippedPixels.h"
#include "Render/Sampling/ElementsPerPixel.h"
#include "Render/Sampling/SamplingPlan.h"

#include <cmath>

namespace banyan::bench
{
namespace
{

constexpr int BrickCells = 32; // as the mapper has them
constexpr int CoarsestLevel = 5;
constexpr float OpacityLimit = 1.0f - 1.0f / 255.0f;

class BanyanHexMeshRenderer : public HexMeshRenderer
{
public:
  BanyanHexMeshRenderer(const HexMeshScene& scene, const HexMeshAccuracy& accuracy, int threads)
    : Scene(scene)
    , Accuracy(accuracy)
    , Pool(threads)
  {
  }

  void Open() override {}

  HexMeshFrame Draw() override
  {
    const Timer timer;
    if (!this->Source)
    {
      this->SetUp();
    }
    RayScene scene = ToRayScene(this->Scene.Look, 1.0, OpacityLimit);
    scene.IndexToWorld = this->Source->Field().Tree().LatticeToWorld();
    scene.DomainCells = this->Source->Field().Tree().Domain();
    scene.Levels = LevelEdges::Finest();
    if (this->Accuracy.OneLevel)
    {
      const int level = FinestLevelFor(scene, this->Accuracy.MaxElementsPerPixel, CoarsestLevel);
      const RaySampling sampling{ level, std::ldexp(scene.SampleDistance, level) };
      scene.Samplings = std::make_shared<TileSamplings>(
        scene.Camera.ImageSize(), std::vector<RaySampling>{ sampling });
    }
    else if (this->Accuracy.Tolerance > 0.0)
    {
      SamplingWish wish{ this->Accuracy.Tolerance, scene.SampleDistance, CoarsestLevel };
      wish.FinestLevelOfTile =
        FinestLevelsOfTiles(scene, this->Accuracy.MaxElementsPerPixel, wish.CoarsestLevel);
      const SamplingPlan plan =
        PlanSamplings(scene, wish, [this](const RayScene& probe) { return this->Cast(probe); });
      scene.Samplings = plan.Samplings;
      scene.OpacityLimit = plan.OpacityLimit;
    }
    FloatImage picture = this->Cast(scene);
    InterpolateSkippedPixels(scene, picture, this->Pool);
    HexMeshFrame frame;
    frame.Seconds = timer.Seconds();
    frame.Shown = Rounded(picture, this->Scene.Look.Picture);
    return frame;
  }

private:
  void SetUp()
  {
    const auto tree = ElementOctree::Find(this->Scene.Mesh.Input(), this->Pool);
    NodeArray values;
    values.Values = this->Scene.Mesh.Values.data();
    this->Source = std::make_unique<HexBrickSource>(
      std::make_shared<const HexBricks>(tree, BrickCells), values, this->Pool);
  }

  FloatImage Cast(const RayScene& scene)
  {
    RayStatistics statistics;
    return CastRays(
      scene, *this->Source, scene.DomainCells, std::uint64_t{ 4 } << 30, this->Pool, statistics);
  }

  const HexMeshScene& Scene;
  HexMeshAccuracy Accuracy;
  ThreadPool Pool;
  std::unique_ptr<HexBrickSource> Source;
};

} // namespace

std::unique_ptr<HexMeshRenderer> MakeBanyanHexMeshRenderer(
  const HexMeshScene& scene, const HexMeshAccuracy& accuracy, int threads)
{
  return std::make_unique<BanyanHexMeshRenderer>(scene, accuracy, threads);
}

} // namespace banyan::bench
