// SPDX-License-Identifier: BSD-3-Clause
#include "ReusableRays.h"

#include "Base/ThreadPool.h"
#include "Render/Bricks/VisibleBricks.h"

#include <algorithm>
#include <utility>

namespace banyan::bench
{
namespace
{

constexpr int PacketEdge = 4;

/// Which packets of a picture lie under something.
class PacketMask
{
public:
  explicit PacketMask(const glm::ivec2& size)
    : Counts((size + PacketEdge - 1) / PacketEdge)
    , Bits(static_cast<std::size_t>(this->Counts.x) * this->Counts.y, 0)
  {
  }

  void Mark(const PixelRect& rect)
  {
    for (int y = rect.Lo.y / PacketEdge; y * PacketEdge < rect.Hi.y; ++y)
    {
      for (int x = rect.Lo.x / PacketEdge; x * PacketEdge < rect.Hi.x; ++x)
      {
        this->Bits[static_cast<std::size_t>(y) * this->Counts.x + x] = 1;
      }
    }
  }
  bool Has(int x, int y) const
  {
    return this->Bits[static_cast<std::size_t>(y / PacketEdge) * this->Counts.x + x / PacketEdge] !=
           0;
  }

private:
  glm::ivec2 Counts;
  std::vector<char> Bits;
};

} // namespace

ReusableRays::Shares ReusableRays::Since(
  const RayScene& scene, BrickSource& source, std::uint64_t budget)
{
  const VisibleBricks visible(scene, source);
  const RayCamera camera = scene.Camera.InSpace(scene.IndexToWorld);
  const glm::ivec2 size = scene.Camera.ImageSize();
  const glm::ivec3 counts = source.Bricks();
  std::vector<Hash128> now(static_cast<std::size_t>(counts.x) * counts.y * counts.z);
  PacketMask changed(size);
  PacketMask covered(size);
  int seen = 0;
  int others = 0;
  for (std::size_t i = 0; i < now.size(); ++i)
  {
    const auto brick = static_cast<std::int64_t>(i);
    // One that was visible and is not any more has changed, too.
    now[i] =
      visible.Contains(brick) ? source.ContentOf(brick).value_or(Hash128{ 0, 1 }) : Hash128();
    const bool shows = now[i] != Hash128();
    const bool differs = this->Before.size() != now.size() || this->Before[i] != now[i];
    const Box cells = source.CellsOf(brick);
    const PixelRect rect = Intersection(
      camera.Footprint(glm::dvec3(cells.Lo), glm::dvec3(cells.Hi)), { glm::ivec2(0), size });
    seen += shows ? 1 : 0;
    others += shows && differs ? 1 : 0;
    if (shows)
    {
      covered.Mark(rect);
    }
    if (differs)
    {
      changed.Mark(rect);
    }
  }
  this->Before = std::move(now);
  ThreadPool& pool = ThreadPool::Process();
  RayStatistics all;
  FloatImage picture = CastRays(scene, source, scene.DomainCells, budget, pool, all);
  RayScene some = scene;
  some.Depth.assign(static_cast<std::size_t>(scene.Viewport.Count()), 1.0f);
  std::int64_t packets = 0;
  std::int64_t clean = 0;
  for (int y = 0; y < size.y; ++y)
  {
    for (int x = 0; x < size.x; ++x)
    {
      packets += covered.Has(x, y) ? 1 : 0;
      clean += covered.Has(x, y) && !changed.Has(x, y) ? 1 : 0;
      some.Depth[static_cast<std::size_t>(y) * size.x + x] = changed.Has(x, y) ? 1.0f : 0.0f;
    }
  }
  RayStatistics drawn;
  CastRays(some, source, scene.DomainCells, budget, pool, drawn);
  std::int64_t shown = 0;
  std::int64_t same = 0;
  for (std::size_t i = 0; i < picture.Pixels.size() && picture.Rect == this->Picture.Rect; ++i)
  {
    shown += picture.Pixels[i].a > 0.0f ? 1 : 0;
    same += picture.Pixels[i].a > 0.0f && picture.Pixels[i] == this->Picture.Pixels[i] ? 1 : 0;
  }
  this->Picture = std::move(picture);
  const auto share = [](auto part, auto whole)
  { return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0; };
  return { share(others, seen), share(clean, packets),
    share(all.SamplesTaken - drawn.SamplesTaken, all.SamplesTaken), share(same, shown) };
}

} // namespace banyan::bench
