// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Levels/KeptRays.h"

#include "Base/Digest.h"
#include "Render/Bricks/VisibleBricks.h"
#include "Render/Scene/FunctionTables.h"
#include "Render/Scene/RayLattice.h"
#include "Render/Scene/SceneDigest.h"

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <utility>

namespace banyan
{
namespace
{

/// Where more of the visible bricks have changed, nearly every packet is under one.
constexpr double MostChanged = 0.9;

/// Per bin of values, a hash of the entries that they may take.
std::array<std::uint64_t, 64> EntriesOfBins(const RayScene& scene, const MaskRange& range)
{
  const auto values = FunctionTables::Process().VisibleOf(scene.Transfer);
  const std::vector<glm::vec4>& entries = scene.Transfer.Entries;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::array<std::uint64_t, 64> bins{};
  const std::uint64_t seed = ShortHashOf(&range, sizeof(range));
  const double width = (range.High - range.Low) / 64.0;
  const bool divided = width > 0.0 && width < infinity;
  for (int bin = 0; bin < 64; ++bin)
  {
    // What lies outside counts for the first or the last bin. A value at an edge may be in both.
    const std::size_t last = entries.size() - 1;
    VisibleValues::Span span{ 0, last };
    if (divided)
    {
      const VisibleValues::Span own =
        values->EntriesOf(range.Low + (bin - 0.01) * width, range.Low + (bin + 1.01) * width);
      span = { bin == 0 ? 0 : own.First, bin == 63 ? last : own.Last };
    }
    // Another range is another meaning of masks, and another scale of gradients.
    bins[static_cast<std::size_t>(bin)] =
      HashOf(entries.data() + span.First, (span.Last - span.First + 1) * sizeof(glm::vec4), seed)
        .Low;
  }
  return bins;
}

glm::ivec3 PlaceOf(std::int64_t brick, const glm::ivec3& counts)
{
  return { static_cast<int>(brick % counts.x), static_cast<int>(brick / counts.x % counts.y),
    static_cast<int>(brick / counts.x / counts.y) };
}

/// Calls function(number) for a brick, and with light for those around: they take a layer of its
/// samples.
template <class Function>
void ForTouched(std::int64_t brick, const glm::ivec3& counts, bool shaded, Function&& function)
{
  if (!shaded)
  {
    function(brick);
    return;
  }
  const glm::ivec3 at = PlaceOf(brick, counts);
  const Box near = Intersection(Box{ at - 1, at + 2 }, Box{ glm::ivec3(0), counts });
  for (int z = near.Lo.z; z < near.Hi.z; ++z)
  {
    for (int y = near.Lo.y; y < near.Hi.y; ++y)
    {
      for (int x = near.Lo.x; x < near.Hi.x; ++x)
      {
        function(BrickSource::NumberOf({ x, y, z }, counts));
      }
    }
  }
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

/// Per brick of a level: 0 where nothing can be seen, else a hash of all that decides what is.
/// Empty where it is not known what bricks hold. With light, a brick counts that cannot be seen but
/// gives samples to one that can.
std::vector<std::uint64_t> Look(const RayScene& scene, const BrickSource& source)
{
  const VisibleBricks visible(scene, source);
  const std::array<std::uint64_t, 64> bins = EntriesOfBins(scene, source.MasksAreOver());
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
    if (!content)
    {
      continue; // nobody looked at it: it gives samples to none that can be seen
    }
    std::uint64_t hash = content->Low ^ content->High * 3;
    for (ValueMask rest = shows ? source.MaskOf(brick) : 0; rest != 0; rest &= rest - 1)
    {
      hash = hash * 0x9e3779b97f4a7c15u + bins[static_cast<std::size_t>(__builtin_ctzll(rest))];
    }
    seen[i] = std::max<std::uint64_t>(hash, 1);
  }
  return seen;
}

/// Marks what lies under bricks of a level that differ.
void MarkChanged(const RayScene& scene, const BrickSource& source,
  const std::vector<std::uint64_t>& before, const std::vector<std::uint64_t>& now, int level,
  ReusedRays& reused)
{
  const glm::ivec3 counts = source.Bricks();
  const RayCamera camera = scene.Camera.InSpace(IndexToWorldAt(scene, source.CellLevel()));
  std::vector<bool> touched(now.size());
  for (std::size_t brick = 0; brick < now.size(); ++brick)
  {
    if (now[brick] != before[brick])
    {
      ForTouched(static_cast<std::int64_t>(brick), counts, scene.Shading.On,
        [&](std::int64_t near) { touched[static_cast<std::size_t>(near)] = true; });
    }
  }
  for (std::size_t brick = 0; brick < touched.size(); ++brick)
  {
    const Box cells = source.CellsOf(static_cast<std::int64_t>(brick));
    const PixelRect pixels =
      touched[brick]
        ? Intersection(camera.Footprint(glm::dvec3(cells.Lo), glm::dvec3(cells.Hi)), scene.Viewport)
        : PixelRect();
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
    std::size_t shown = 0;
    std::size_t changed = 0;
    for (std::size_t brick = 0; brick < seen.size(); ++brick)
    {
      shown += seen[brick] != 0 ? 1 : 0;
      changed += seen[brick] != before->second[brick] ? 1 : 0;
    }
    if (static_cast<double>(changed) > MostChanged * static_cast<double>(shown))
    {
      return false;
    }
    MarkChanged(
      scene, *source.AtLevel(level, scene.DomainCells), before->second, seen, level, reused);
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
