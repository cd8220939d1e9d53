// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Levels/KeptRays.h"

#include "Base/Digest.h"
#include "Render/Bricks/VisibleBricks.h"
#include "Render/Scene/FunctionTables.h"
#include "Render/Scene/RayLattice.h"
#include "Render/Scene/SceneDigest.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

namespace banyan
{
namespace
{

/// Where more of the visible bricks have changed, nearly every packet is under one.
constexpr double MostChanged = 0.9;

/// The bins of values whose entries differ.
ValueMask ChangedBins(
  const TransferFunction& before, const TransferFunction& now, const MaskRange& range)
{
  if (before.Entries == now.Entries)
  {
    return 0;
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double width = (range.High - range.Low) / 64.0;
  if (!(width > 0.0 && width < infinity))
  {
    return ~ValueMask{ 0 };
  }
  const auto values = FunctionTables::Process().VisibleOf(now);
  const auto last = static_cast<std::ptrdiff_t>(now.Entries.size()) - 1;
  ValueMask bins = 0;
  for (int bin = 0; bin < 64; ++bin)
  {
    // What lies outside counts for the first or the last bin. A value at an edge may be in both.
    const VisibleValues::Span own =
      values->EntriesOf(range.Low + (bin - 0.01) * width, range.Low + (bin + 1.01) * width);
    const auto first = bin == 0 ? 0 : static_cast<std::ptrdiff_t>(own.First);
    const auto end = (bin == 63 ? last : static_cast<std::ptrdiff_t>(own.Last)) + 1;
    const bool same = std::equal(
      before.Entries.begin() + first, before.Entries.begin() + end, now.Entries.begin() + first);
    bins |= same ? 0 : ValueMask{ 1 } << bin;
  }
  return bins;
}

/// Sets the bits of the blocks under some pixels, in tiles of a level.
void Mark(const PixelRect& pixels, int level, const TileSamplings* samplings, ReusedRays& reused)
{
  constexpr int edge = ReusedRays::BlockEdge;
  const glm::ivec2 first = pixels.Lo / edge;
  const glm::ivec2 last = (pixels.Hi - 1) / edge;
  for (int y = first.y; y <= last.y; ++y)
  {
    for (int x = first.x; x <= last.x; ++x)
    {
      const glm::ivec2 tile(x / ReusedRays::BlocksPerRow, y / ReusedRays::BlocksPerRow);
      if (!samplings || samplings->At(tile).Level == level)
      {
        reused.At(tile) |= ReusedRays::BitOf(x * edge, y * edge);
      }
    }
  }
}

/// Per brick of a level: 0 where nothing can be seen, else a hash of all samples. Empty where it is
/// not known what bricks hold. With light, a brick counts that cannot be seen but gives samples to
/// one that can.
std::vector<std::uint64_t> Look(const RayScene& scene, const BrickSource& source)
{
  const VisibleBricks visible(scene, source);
  const glm::ivec3 counts = source.Bricks();
  std::vector<std::uint64_t> seen(static_cast<std::size_t>(counts.x) * counts.y * counts.z, 0);
  const bool shaded = scene.Shading.On;
  for (std::size_t i = 0; i < seen.size(); ++i)
  {
    const auto brick = static_cast<std::int64_t>(i);
    const bool shows = visible.Contains(brick);
    if (!shows && !shaded)
    {
      continue;
    }
    const std::optional<Hash128> content = source.ContentOf(brick);
    if (!content && shows)
    {
      return {};
    }
    // Where nobody looked, a brick gives samples to none that can be seen.
    seen[i] = content ? std::max<std::uint64_t>(content->Low ^ content->High * 3, 1) : 0;
  }
  return seen;
}

/// Which bricks of a level have other samples than before, or are seen with other entries.
std::vector<bool> ChangedBricks(const BrickSource& source, ValueMask bins,
  const std::vector<std::uint64_t>& before, const std::vector<std::uint64_t>& now)
{
  std::vector<bool> changed(now.size());
  for (std::size_t i = 0; i < now.size(); ++i)
  {
    changed[i] = now[i] != before[i] ||
                 (now[i] != 0 && (source.MaskOf(static_cast<std::int64_t>(i)) & bins) != 0);
  }
  return changed;
}

/// Marks what lies under some bricks of a level, and with light under what takes samples of theirs.
void MarkUnder(const RayScene& scene, const BrickSource& source, const std::vector<bool>& bricks,
  int level, ReusedRays& reused)
{
  // A gradient is interpolated between samples, and these take the next ones.
  const int around = scene.Shading.On ? 2 << source.CoarsestBrickLevel() : 0;
  const RayCamera camera = scene.Camera.InSpace(IndexToWorldAt(scene, source.CellEdges()));
  for (std::size_t i = 0; i < bricks.size(); ++i)
  {
    if (!bricks[i])
    {
      continue;
    }
    const auto brick = static_cast<std::int64_t>(i);
    const int size = 1 << source.BrickLevel(brick);
    const Box cells = source.CellsOf(brick);
    const PixelRect pixels = Intersection(
      camera.Footprint(glm::dvec3(cells.Lo * size - around), glm::dvec3(cells.Hi * size + around)),
      scene.Viewport);
    if (!pixels.Empty())
    {
      Mark(pixels, level, scene.Samplings.get(), reused);
    }
  }
}

} // namespace

/// Marks what has changed at the levels that the next picture is drawn from.
/// @return false where all has to be cast
bool KeptRays::MarkLevels(const RayScene& scene, BrickSource& source,
  const std::map<int, Seen>& next, ReusedRays& reused) const
{
  for (const auto& [level, seen] : next)
  {
    const auto before = this->Levels.find(level);
    if (seen.empty() || before == this->Levels.end() || before->second.size() != seen.size())
    {
      return false;
    }
    const BrickSource& at = *source.AtLevel(level, scene.DomainCells);
    const std::vector<bool> changed = ChangedBricks(
      at, ChangedBins(this->Transfer, scene.Transfer, at.MasksAreOver()), before->second, seen);
    const auto shown = std::count_if(seen.begin(), seen.end(), [](auto hash) { return hash != 0; });
    const auto others = std::count(changed.begin(), changed.end(), true);
    if (static_cast<double>(others) > MostChanged * static_cast<double>(shown))
    {
      return false;
    }
    MarkUnder(scene, at, changed, level, reused);
  }
  return true;
}

/// Marks tiles that are not sampled as before.
void KeptRays::MarkTiles(const RayScene& scene, ReusedRays& reused) const
{
  for (int y = 0; scene.Samplings && y < reused.Tiles.y; ++y)
  {
    for (int x = 0; x < reused.Tiles.x; ++x)
    {
      const bool same = scene.Samplings->At({ x, y }) == this->Samplings->At({ x, y });
      reused.At({ x, y }) |= same ? 0 : ReusedRays::All;
    }
  }
}

Hash128 KeptRays::Begin(RayScene& scene, BrickSource& source, const Hash128& name)
{
  const Hash128 view = DigestWithoutEntries(scene);
  if (view != this->View)
  {
    this->Forget();
    this->View = view;
    return {};
  }
  std::map<int, Seen> next;
  for (const int level : scene.Samplings ? scene.Samplings->UsedLevels() : std::set<int>{ 0 })
  {
    BrickSource* const at = source.AtLevel(level, scene.DomainCells);
    // Cells may be hidden in bricks that hold what they held.
    next[level] = at && !source.Hidden() ? Look(scene, *at) : Seen();
  }
  const auto reused = std::make_shared<ReusedRays>(scene.Camera.ImageSize());
  Digest all;
  if (this->Complete && scene.OpacityLimit == this->OpacityLimit &&
      (scene.Samplings != nullptr) == (this->Samplings != nullptr) &&
      this->MarkLevels(scene, source, next, *reused))
  {
    this->MarkTiles(scene, *reused);
    reused->Picture = this->Picture;
    scene.Reused = reused;
    all.Add(this->Name);
    all.Add(reused->Cast);
  }
  // Whatever fails before Keep leaves nothing that is half right.
  this->Forget();
  this->View = view;
  this->Name = name;
  this->OpacityLimit = scene.OpacityLimit;
  this->Transfer = scene.Transfer;
  this->Samplings = scene.Samplings;
  this->Levels = std::move(next);
  return scene.Reused ? all.Get() : Hash128();
}

void KeptRays::Keep(const std::shared_ptr<const FloatImage>& picture)
{
  this->Complete = !this->Levels.empty();
  this->Picture = this->Complete ? picture : nullptr;
}

void KeptRays::Forget()
{
  this->View = Hash128();
  this->Complete = false;
  this->Picture.reset();
  this->Samplings.reset();
  this->Levels.clear();
}

} // namespace banyan
