// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/FrameCost.h"

#include "Base/Error.h"
#include "Render/Bricks/BrickSource.h"
#include "Render/Bricks/VisibleBricks.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace banyan
{
namespace
{

/// A pixel and a ray take as long as so many samples that are interpolated; see
/// Documentation/balancing.md.
constexpr double SamplesPerPixel = 4.0;
constexpr double SamplesPerRay = 12.0;

/// A corner of blocks on the screen.
struct Corner
{
  double X = 0;
  double Y = 0;
  double W = 0; ///< 0 or less behind the eye
};

/// Corners of blocks, x fastest.
std::vector<Corner> CornersOf(
  const BrickCosts& blocks, const glm::dmat4& indexToClip, const glm::dvec2& picture)
{
  const glm::ivec3 size = blocks.Bricks() + 1;
  std::vector<Corner> corners;
  corners.reserve(static_cast<std::size_t>(Box{ glm::ivec3(0), size }.Count()));
  for (int z = 0; z < size.z; ++z)
  {
    for (int y = 0; y < size.y; ++y)
    {
      for (int x = 0; x < size.x; ++x)
      {
        const glm::ivec3 at = glm::min(glm::ivec3(x, y, z) * blocks.Edge, blocks.Positions);
        const glm::dvec4 clip = indexToClip * glm::dvec4(at, 1.0);
        Corner corner;
        corner.W = clip.w;
        if (clip.w > 0.0)
        {
          corner.X = (0.5 + 0.5 * clip.x / clip.w) * picture.x;
          corner.Y = (0.5 + 0.5 * clip.y / clip.w) * picture.y;
        }
        corners.push_back(corner);
      }
    }
  }
  return corners;
}

/// Length of the part of [low, high] inside [from, to].
double Inside(double low, double high, double from, double to)
{
  return std::max(0.0, std::min(high, to) - std::max(low, from));
}

/// Estimates the samples that blocks take, in cells of length.
class Screen
{
public:
  Screen(const RayScene& scene, const glm::dmat4& indexToClip)
    : Viewport(scene.Viewport)
    , Picture(scene.Camera.ImageSize())
    , IndexToClip(indexToClip)
  {
    // Pixels per cell at w = 1, along both axes of the picture.
    const glm::dmat4 rows = glm::transpose(indexToClip);
    this->PixelsAtOne = 0.25 * this->Picture.x * this->Picture.y *
                        glm::length(glm::dvec3(rows[0])) * glm::length(glm::dvec3(rows[1]));
  }

  /// @param corners of the block
  double Samples(const std::array<Corner, 8>& corners, const Box& block) const
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Corner low{ infinity, infinity, 0.0 };
    Corner high{ -infinity, -infinity, 0.0 };
    double away = 0.0;
    int before = 0;
    for (const Corner& corner : corners)
    {
      if (corner.W > 0.0)
      {
        low = { std::min(low.X, corner.X), std::min(low.Y, corner.Y), 0.0 };
        high = { std::max(high.X, corner.X), std::max(high.Y, corner.Y), 0.0 };
        away += corner.W / 8.0;
        ++before;
      }
    }
    const PixelRect& all = this->Viewport;
    const double whole = (high.X - low.X) * (high.Y - low.Y);
    if (before == 0 || (before == 8 && !(whole > 0.0)))
    {
      return 0.0;
    }
    if (before < 8 || whole > static_cast<double>(all.Count()))
    {
      return this->SamplesNearTheEye(block);
    }
    const double shown =
      Inside(low.X, high.X, all.Lo.x, all.Hi.x) * Inside(low.Y, high.Y, all.Lo.y, all.Hi.y);
    return shown / whole * static_cast<double>(block.Count()) * this->PixelsAtOne / (away * away);
  }

private:
  /// Estimates, point by point, the samples in a block that may be partly behind the eye or beside
  /// the viewport.
  double SamplesNearTheEye(const Box& block) const
  {
    constexpr int points = 5;
    const glm::dvec3 part = glm::dvec3(block.Size()) / static_cast<double>(points);
    const PixelRect& all = this->Viewport;
    const double volume = part.x * part.y * part.z;
    const double most = static_cast<double>(all.Count()) * std::cbrt(volume);
    double samples = 0.0;
    for (int i = 0; i < points * points * points; ++i)
    {
      const glm::dvec3 at(i % points, i / points % points, i / points / points);
      const glm::dvec4 clip =
        this->IndexToClip * glm::dvec4(glm::dvec3(block.Lo) + (at + 0.5) * part, 1.0);
      if (clip.w > 0.0)
      {
        const double x = (0.5 + 0.5 * clip.x / clip.w) * this->Picture.x;
        const double y = (0.5 + 0.5 * clip.y / clip.w) * this->Picture.y;
        const bool shown = x >= all.Lo.x && x < all.Hi.x && y >= all.Lo.y && y < all.Hi.y;
        samples += shown ? std::min(most, volume * this->PixelsAtOne / (clip.w * clip.w)) : 0.0;
      }
    }
    return samples;
  }

  PixelRect Viewport;
  glm::dvec2 Picture;
  glm::dmat4 IndexToClip;
  double PixelsAtOne = 1.0;
};

void AddWork(const BrickWork& from, const BrickCosts& view, BrickCosts& blocks, RankWork& rank)
{
  for (const BrickWork::Part& part : from.Parts)
  {
    const double work = WorkOf(part.Took);
    blocks.Add(part.Cells, work, &view);
    rank.Work += work;
  }
  rank.Seconds = from.DrawSeconds;
}

/// Calls function(number of the block) for blocks in a box, x fastest.
template <class Function>
void ForBlocks(const BrickCosts& blocks, const Box& box, Function&& function)
{
  ForPositions(box, [&](const glm::ivec3& at) { function(blocks.NumberAt(at)); });
}

} // namespace

std::vector<float> VisibleParts(
  const RayScene& scene, const BrickSource& source, const glm::ivec3& cells, int blockEdge)
{
  BrickCosts blocks(cells, blockEdge);
  const VisibleBricks visible(scene, source);
  const glm::ivec3 counts = source.Bricks();
  visible.ForEach([](const Box&, bool& all) { return all = true; },
    [&](const Box& bricks, const Box& own)
    {
      const int size = 1 << source.BrickLevel(BrickSource::NumberOf(bricks.Lo, counts));
      const Box part{ own.Lo * size, own.Hi * size };
      ForBlocks(blocks, blocks.BricksUnder(part),
        [&](std::size_t block)
        {
          blocks.Values[block] +=
            static_cast<double>(Intersection(blocks.PositionsOf(block), part).Count());
        });
    });
  std::vector<float> parts(blocks.Values.size());
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    parts[i] =
      static_cast<float>(blocks.Values[i] / static_cast<double>(blocks.PositionsOf(i).Count()));
  }
  return parts;
}

BrickCosts ViewCosts(
  const RayScene& scene, const glm::ivec3& cells, int blockEdge, const std::vector<float>& visible)
{
  BrickCosts costs(cells, blockEdge);
  if (!visible.empty() && visible.size() != costs.Values.size())
  {
    throw Error("There is not one visible part for each block.");
  }
  const glm::dmat4 indexToClip =
    glm::inverse(scene.Camera.ClipToWorldMatrix()) * scene.IndexToWorld;
  const std::vector<Corner> corners =
    CornersOf(costs, indexToClip, glm::dvec2(scene.Camera.ImageSize()));
  const Screen screen(scene, indexToClip);
  const glm::ivec3 size = costs.Bricks() + 1;
  const std::size_t slice = static_cast<std::size_t>(size.x) * size.y;
  std::size_t next = 0;
  for (int z = 0; z + 1 < size.z; ++z)
  {
    for (int y = 0; y + 1 < size.y; ++y)
    {
      for (int x = 0; x + 1 < size.x; ++x, ++next)
      {
        const double part = visible.empty() ? 1.0 : visible[next];
        if (!(part > 0.0))
        {
          continue;
        }
        std::array<Corner, 8> around;
        for (std::size_t i = 0; i < 8; ++i)
        {
          around[i] = corners[(z + (i >> 2)) * slice + (y + ((i >> 1) & 1)) * size.x + x + (i & 1)];
        }
        costs.Values[next] = part * screen.Samples(around, costs.PositionsOf(next));
      }
    }
  }
  return costs;
}

double WorkOf(const DrawnWork& took)
{
  return static_cast<double>(took.Samples) + SamplesPerPixel * static_cast<double>(took.Pixels) +
         SamplesPerRay * took.Rays;
}

FrameCost SumCost(const std::vector<BrickWork>& ranks, const BrickCosts& view)
{
  FrameCost sum;
  sum.Blocks = BrickCosts(view.Positions, view.Edge);
  for (const BrickWork& rank : ranks)
  {
    sum.Ranks.emplace_back();
    AddWork(rank, view, sum.Blocks, sum.Ranks.back());
  }
  return sum;
}

FrameCost GatherCost(Communicator& communicator, const BrickWork& mine,
  const std::vector<Box>& zones, const BrickCosts& view)
{
  const auto self = static_cast<std::size_t>(communicator.Rank());
  const auto ranks = static_cast<std::size_t>(communicator.Size());
  FrameCost all;
  all.Blocks = BrickCosts(view.Positions, view.Edge);
  all.Ranks.resize(ranks);
  BrickCosts own = all.Blocks;
  RankWork rank;
  AddWork(mine, view, own, rank);

  // Seconds, work, and the blocks of the zone; all ranks know how many the largest zone has.
  std::size_t most = 0;
  for (const Box& zone : zones)
  {
    most = std::max(most, static_cast<std::size_t>(own.BricksUnder(zone).Count()));
  }
  const std::size_t length = most + 4;
  std::vector<float> message(length, 0.0f);
  const double head[2] = { rank.Seconds, rank.Work };
  std::memcpy(message.data(), head, sizeof(head));
  std::size_t next = 4;
  ForBlocks(own, own.BricksUnder(zones.at(self)),
    [&](std::size_t block) { message[next++] = static_cast<float>(own.Values[block]); });
  std::vector<float> messages(length * ranks);
  communicator.AllGather(message.data(), length * sizeof(float), messages.data());
  for (std::size_t from = 0; from < ranks; ++from)
  {
    const float* part = messages.data() + from * length;
    double values[2];
    std::memcpy(values, part, sizeof(values));
    all.Ranks[from] = { values[0], values[1] };
    part += 4;
    ForBlocks(all.Blocks, all.Blocks.BricksUnder(zones.at(from)),
      [&](std::size_t block) { all.Blocks.Values[block] += static_cast<double>(*part++); });
  }
  return all;
}

} // namespace banyan
