// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Steps/TimeStepPrefetcher.h"

#include "Render/Bricks/SeriesBrickSource.h"
#include "Render/Bricks/ViewPrefetcher.h"
#include "Render/Bricks/VisibleBricks.h"
#include "Render/Scene/BoxOnScreen.h"
#include "Render/Steps/EnhancedBrickSource.h"
#include "Render/Steps/InterpolatedBrickSource.h"

#include <algorithm>
#include <utility>

namespace banyan
{
namespace
{

/// What was loaded of a source, of all steps that it is made of; nothing where it is not of a
/// series.
void AddLoaded(const BrickSource* source, std::vector<FieldBricks>& loaded)
{
  if (const auto* const series = dynamic_cast<const SeriesBrickSource*>(source))
  {
    for (FieldBricks& field : series->Loaded())
    {
      loaded.push_back(std::move(field));
    }
  }
  else if (const auto* const enhanced = dynamic_cast<const EnhancedBrickSource*>(source))
  {
    for (const BrickSource* const step : enhanced->Steps())
    {
      AddLoaded(step, loaded);
    }
  }
  else if (const auto* const between = dynamic_cast<const InterpolatedBrickSource*>(source))
  {
    for (const BrickSource* const step : between->Sources())
    {
      AddLoaded(step, loaded);
    }
  }
}

/// Bricks of the level of another step that come into sight there: that can be seen, on the screen,
/// and cannot at the step that was drawn.
/// @param changed whether those that can be seen in both, and differ, are added too
void AddComing(const RayScene& scene, const Box& cells, const SeriesBrickSource& drawn,
  const SeriesBrickSource& coming, bool changed, std::vector<std::int64_t>& bricks)
{
  const VisibleBricks before(scene, drawn);
  const VisibleBricks after(scene, coming);
  const BoxOnScreen screen(scene, 0.0);
  const glm::ivec3 counts = coming.Bricks();
  for (std::int64_t brick = 0; brick < std::int64_t{ counts.x } * counts.y * counts.z; ++brick)
  {
    const Box part = Intersection(coming.CellsOf(brick), cells);
    if (!part.Empty() && after.Contains(brick) && screen.MayShow(part) &&
        (!before.Contains(brick) || (changed && drawn.ContentOf(brick) != coming.ContentOf(brick))))
    {
      bricks.push_back(brick);
    }
  }
}

/// The fields of a step that are drawn if those of another one were.
std::vector<FieldBricks> AtStep(const std::vector<FieldBricks>& drawn, int offset, int steps)
{
  std::vector<FieldBricks> wanted;
  for (const FieldBricks& field : drawn)
  {
    const int step = field.Field.Step + offset;
    if (step >= 0 && step < steps)
    {
      wanted.push_back(field);
      wanted.back().Field.Step = step;
    }
  }
  return wanted;
}

} // namespace

void TimeStepPrefetcher::Drawing(const SeriesFile& series, int step)
{
  const int expected = this->NextStep;
  this->Step = step;
  this->NextStep = this->Direction.Asked(series, step);
  if (step != expected)
  {
    this->Decoder.Stop();
  }
}

void TimeStepPrefetcher::Drawn(const std::shared_ptr<const SeriesFile>& series,
  const RayScene& scene, const Box& cells, const BrickSource& source)
{
  if (this->NextStep < 0)
  {
    return;
  }
  std::vector<int> next;
  for (int step = this->NextStep; static_cast<int>(next.size()) < StepsAhead && step >= 0;
       step = this->Direction.After(step))
  {
    next.push_back(step);
  }
  std::vector<FieldBricks> drawn;
  AddLoaded(&source, drawn);
  const auto* const plain = dynamic_cast<const SeriesBrickSource*>(&source);
  const std::shared_ptr<const SeriesBrickSource> now =
    plain ? plain->AtStep(this->Step, 0) : nullptr;
  RayScene seen = scene;
  seen.Depth.clear();
  seen.Reused.reset();
  // Of a picture whose rays were reused, hardly a brick was loaded: the next one needs others.
  const bool changed = scene.Reused != nullptr;
  this->Decoder.Start(
    series,
    [=, step = this->Step]
    {
      std::vector<FieldBricks> wanted;
      for (const int then : next)
      {
        for (FieldBricks& field : AtStep(drawn, then - step, series->Index().Steps()))
        {
          if (now)
          {
            const int level = field.Field.Level - now->FieldLevel();
            AddComing(InCellsOf(seen, level), CellsAtLevel(cells, glm::ivec3(1 << level)),
              *now->AtStep(step, level), *now->AtStep(then, level), changed, field.Bricks);
          }
          wanted.push_back(std::move(field));
        }
      }
      return wanted;
    },
    this->Cache.Budget() / 2);
}

} // namespace banyan
