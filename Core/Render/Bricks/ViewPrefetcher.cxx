// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/ViewPrefetcher.h"

#include "Base/Error.h"
#include "Render/Bricks/SeriesBrickSource.h"
#include "Render/Bricks/VisibleBricks.h"
#include "Render/Scene/BoxOnScreen.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <set>
#include <utility>

namespace banyan
{
namespace
{

/// Pixels around the expected screen: no hand turns a camera evenly.
constexpr double MarginPixels = 32.0;

glm::dmat4 ClipToIndex(const RayScene& scene)
{
  return glm::inverse(scene.IndexToWorld) * scene.Camera.ClipToWorldMatrix();
}

/// Goes through boxes of bricks, halving those that the edge of a screen cuts.
class Search
{
public:
  Search(const RayScene& scene, const RayScene& next, const BrickSource& source, const Box& cells)
    : Source(source)
    , Cells(cells)
    , Now(scene, 0.0)
    , Next(next, MarginPixels)
    , Visible(scene, source)
    , Planes(PlanesInIndexSpace(scene.ClipPlanes, scene.IndexToWorld))
    , Sampled(scene.Shading.On || scene.Blend.Mode != BlendMode::Composite)
  {
  }

  std::vector<std::int64_t> Found;

  void Look(const Box& bricks)
  {
    const std::int64_t first = this->NumberOf(bricks.Lo);
    const std::int64_t last = this->NumberOf(bricks.Hi - 1);
    const Box part =
      Intersection({ this->Source.CellsOf(first).Lo, this->Source.CellsOf(last).Hi }, this->Cells);
    if (part.Empty() || !this->Next.MayShow(part) || this->Now.ShowsAll(part))
    {
      return;
    }
    const glm::ivec3 size = bricks.Hi - bricks.Lo;
    const int longest = std::max({ size.x, size.y, size.z });
    if (longest > 1)
    {
      const int axis = size.x == longest ? 0 : size.y == longest ? 1 : 2;
      Box half = bricks;
      half.Hi[axis] = bricks.Lo[axis] + longest / 2;
      this->Look(half);
      half = bricks;
      half.Lo[axis] += longest / 2;
      this->Look(half);
    }
    else if (!this->Now.MayShow(part) && this->Visible.Contains(first) &&
             !IsCutAway(this->Planes, part) && (this->Sampled || !this->Source.IsMacroVoxel(first)))
    {
      this->Found.push_back(first);
    }
  }

private:
  std::int64_t NumberOf(const glm::ivec3& place) const
  {
    const glm::ivec3 counts = this->Source.Bricks();
    return place.x + std::int64_t{ counts.x } * (place.y + std::int64_t{ counts.y } * place.z);
  }

  const BrickSource& Source;
  const Box& Cells;
  const BoxOnScreen Now;
  const BoxOnScreen Next;
  const VisibleBricks Visible;
  const std::vector<glm::dvec4> Planes;
  const bool Sampled;
};

} // namespace

RayScene InCellsOf(RayScene scene, int level)
{
  scene.IndexToWorld = glm::scale(scene.IndexToWorld, glm::dvec3(1 << level));
  return scene;
}

std::optional<RayScene> SceneAfter(const RayScene& scene, const glm::dmat4& before)
{
  // What moved the camera last, in whatever space it did, moves it once more.
  const glm::dmat4 now = ClipToIndex(scene);
  const glm::dmat4 next = scene.IndexToWorld * now * glm::inverse(before) * now;
  try
  {
    RayScene after = scene;
    after.Camera =
      RayCamera(glm::inverse(next), scene.Camera.ImageSize(), scene.Camera.AnchorPoint());
    after.Viewport = { glm::ivec2(0), scene.Camera.ImageSize() };
    return after;
  }
  catch (const Error&)
  {
    return std::nullopt;
  }
}

std::vector<std::int64_t> BricksComingOntoScreen(
  const RayScene& scene, const RayScene& next, const BrickSource& source, const Box& cells)
{
  Search search(scene, next, source, cells);
  search.Look({ glm::ivec3(0), source.Bricks() });
  return std::move(search.Found);
}

std::vector<FieldBricks> ViewPrefetcher::Expected(
  const RayScene& scene, SeriesBrickSource& source, const Box& cells)
{
  const glm::dmat4 now = ClipToIndex(scene);
  const std::optional<glm::dmat4> before = std::exchange(this->Before, now);
  const glm::ivec2 size = std::exchange(this->PictureSize, scene.Camera.ImageSize());
  if (!before || size != this->PictureSize || *before == now)
  {
    return {};
  }
  const std::optional<RayScene> next = SceneAfter(scene, *before);
  std::vector<FieldBricks> expected;
  const std::set<int> levels = scene.Samplings ? scene.Samplings->UsedLevels() : std::set<int>{ 0 };
  for (const int level : levels)
  {
    const auto* const at =
      dynamic_cast<const SeriesBrickSource*>(source.AtLevel(level, scene.DomainCells));
    if (next && at)
    {
      const Box coarse = CellsAtLevel(Intersection(cells, scene.DomainCells), at->CellEdges());
      for (FieldBricks& field : at->Fields(
             BricksComingOntoScreen(InCellsOf(scene, level), InCellsOf(*next, level), *at, coarse)))
      {
        expected.push_back(std::move(field));
      }
    }
  }
  return expected;
}

} // namespace banyan
