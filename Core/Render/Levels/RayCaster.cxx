// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Levels/RayCaster.h"

#include "Base/Error.h"
#include "Render/Levels/LevelCaster.h"
#include "Render/Levels/PictureWatcher.h"

namespace banyan
{
namespace
{

BrickSource& SourceAt(BrickSource& source, int level, const RayScene& scene)
{
  BrickSource* const found = source.AtLevel(level, scene.DomainCells);
  if (!found)
  {
    throw Error("There is no level " + std::to_string(level) + " of what is to be drawn");
  }
  return *found;
}

PackedBrickCache::Picture KindOf(const RayScene& scene)
{
  if (scene.Probe || scene.GoesOn)
  {
    return PackedBrickCache::Picture::Part;
  }
  return scene.Passing ? PackedBrickCache::Picture::Passing : PackedBrickCache::Picture::Whole;
}

/// @param least of the picture
/// @param watcher null for none
FloatImage Cast(const RayScene& scene, BrickSource& source, const Box& cells,
  std::uint64_t budgetBytes, ThreadPool& pool, RayStatistics& statistics, const PixelRect& least,
  PictureWatcher* watcher)
{
  const Box inside = Intersection(cells, scene.DomainCells);
  FloatImage picture;
  picture.Rect = least;
  std::vector<std::unique_ptr<PictureCaster>> casters;
  for (const int level : SampledLevels(scene))
  {
    BrickSource& at = SourceAt(source, level, scene);
    const Box drawn = CellsAtLevel(inside, at.CellEdges());
    std::unique_ptr<PictureCaster> caster = at.MakeCaster(scene, drawn, pool, statistics);
    casters.push_back(
      caster ? std::move(caster)
             : std::make_unique<LevelCaster>(scene, at, drawn, budgetBytes, pool, statistics));
    picture.Rect = Union(picture.Rect, casters.back()->Rect());
  }
  source.Kept().BeginPicture(PackedBrickCache::PartOf(budgetBytes), KindOf(scene));
  // Casters set all pixels, tile by tile.
  picture.Pixels.resize(static_cast<std::size_t>(picture.Rect.Count()));
  if (watcher)
  {
    watcher->Begins(picture);
  }
  for (const auto& caster : casters)
  {
    caster->Draw(picture, watcher);
  }
  source.Kept().EndPicture();
  return picture;
}

} // namespace

std::set<int> SampledLevels(const RayScene& scene)
{
  if (!scene.Samplings)
  {
    return { 0 };
  }
  if (scene.Samplings->Tiles() != TileSamplings::TilesOf(scene.Camera.ImageSize()))
  {
    throw Error("The samplings are those of a picture of another size");
  }
  return scene.Samplings->UsedLevels();
}

int FinestLevelWithin(
  const RayScene& scene, BrickSource& source, const Box& cells, int coarsest, std::uint64_t bytes)
{
  RayScene planned = scene;
  int level = 0;
  for (; level < coarsest; ++level)
  {
    planned.Samplings = std::make_shared<const TileSamplings>(
      scene.Camera.ImageSize(), std::vector{ RaySampling{ level, scene.SampleDistance } });
    BrickSource& at = SourceAt(source, level, scene);
    if (AllFits(LevelScene(planned, at),
          CellsAtLevel(Intersection(cells, scene.DomainCells), at.CellEdges()), bytes))
    {
      break;
    }
  }
  return level;
}

FloatImage CastRays(const RayScene& scene, BrickSource& source, const Box& cells,
  std::uint64_t budgetBytes, ThreadPool& pool, RayStatistics& statistics)
{
  return Cast(scene, source, cells, budgetBytes, pool, statistics, PixelRect(), nullptr);
}

FloatImage CastViewport(const RayScene& scene, BrickSource& source, const Box& cells,
  std::uint64_t budgetBytes, ThreadPool& pool, RayStatistics& statistics)
{
  return Cast(scene, source, cells, budgetBytes, pool, statistics, scene.Viewport, nullptr);
}

FloatImage CastRaysWatched(const RayScene& scene, BrickSource& source, const Box& cells,
  std::uint64_t budgetBytes, ThreadPool& pool, RayStatistics& statistics, PictureWatcher& watcher)
{
  return Cast(scene, source, cells, budgetBytes, pool, statistics, PixelRect(), &watcher);
}

} // namespace banyan
