// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Levels/LevelScene.h"

#include "Base/Error.h"
#include "Render/Scene/FunctionTables.h"

#include <glm/matrix.hpp>

namespace banyan
{
namespace
{

std::unique_ptr<const ShadingTable> ShadingOf(const RayScene& scene, const glm::dmat4& indexToWorld)
{
  if (!scene.Shading.On || scene.Blend.Mode != BlendMode::Composite)
  {
    return nullptr;
  }
  return std::make_unique<const ShadingTable>(
    scene.Shading, glm::dmat3(glm::inverse(indexToWorld)));
}

} // namespace

LevelSampling::LevelSampling(const RayScene& scene, double distance, const BrickSource& source)
  : Distance(distance)
  , Lattice(scene, distance, source.CellEdges() * (1 << source.CoarsestBrickLevel()),
      source.CoarsestBrickLevel())
  , Steps(FunctionTables::Process().StepsOf(scene.Transfer, distance))
  , Table(*Steps)
{
  if (scene.Blend.Mode != BlendMode::Composite)
  {
    this->Projection = std::make_unique<const ProjectionTable>(scene, this->Table);
  }
}

LevelScene::LevelScene(const RayScene& scene, BrickSource& source)
  : Scene(scene)
  , Source(source)
  , Visible(FunctionTables::Process().VisibleOf(scene.Transfer))
  , IndexToWorld(IndexToWorldAt(scene, source.CellEdges()))
  , IndexCamera(scene.Camera.InSpace(IndexToWorld))
  , ClipPlanes(PlanesInIndexSpace(scene.ClipPlanes, IndexToWorld))
  , Shading(ShadingOf(scene, IndexToWorld))
{
  if (source.CellEdges() != scene.Levels.At(source.Level()))
  {
    throw Error(
      "Cells of level " + std::to_string(source.Level()) + " are not as long as the scene says");
  }
  std::vector<RaySampling> samplings{ { 0, scene.SampleDistance } };
  std::vector<bool> used{ true };
  if (scene.Samplings)
  {
    samplings = scene.Samplings->Samplings();
    used = scene.Samplings->Used();
  }
  for (std::size_t i = 0; i < samplings.size(); ++i)
  {
    this->Samplings.emplace_back();
    if (used[i] && samplings[i].Level == source.Level())
    {
      this->Samplings.back() =
        std::make_unique<const LevelSampling>(scene, samplings[i].Distance, source);
      this->AnySampling = this->Samplings.back().get();
    }
  }
}

bool LevelScene::IsLarge() const
{
  constexpr std::int64_t many = std::int64_t{ 1 } << 25; // cells
  const int level = this->Source.Level();
  // Of a mesh, whose cells are counted in the finest ones, this is about how many there are.
  const bool isMesh = this->Scene.Levels.AreFinest();
  const glm::i64vec3 edges(isMesh ? LevelEdges().At(level) : this->Scene.Levels.At(level));
  return this->Scene.DomainCells.Count() / (edges.x * edges.y * edges.z) >= many;
}

} // namespace banyan
