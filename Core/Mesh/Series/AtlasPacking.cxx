// SPDX-License-Identifier: BSD-3-Clause
// Boxes for the leaves of an octree, and their places in an image.
#include "Base/Box.h"
#include "Mesh/Series/MeshAtlas.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace banyan
{
namespace
{

/// Leaves of a level are counted in tiles of this edge.
constexpr int TileEdge = 8;
/// Boxes begin at multiples of this in the image: the distance of samples of the codec's next
/// coarser plane, so that what is interpolated inside a box comes from samples of the box.
constexpr int Alignment = 4;
/// A box that is filled to this part is not cut any more.
constexpr double FilledEnough = 0.75;

struct Tile
{
  int Level = 0;
  glm::ivec3 At{ 0 };
  Box Nodes; ///< of its leaves, half-open

  bool SameAs(const Tile& other) const
  {
    return this->Level == other.Level && this->At == other.At;
  }
};

/// The tiles that have leaves, ordered by level, z, y, x.
std::vector<Tile> TilesOf(const OctreeLeaves& leaves)
{
  std::vector<Tile> tiles;
  for (std::size_t i = 0; i < leaves.Keys.size(); ++i)
  {
    Tile tile;
    tile.Level = leaves.Levels[i];
    const glm::ivec3 corner = PositionOfKey(leaves.Keys[i]) >> tile.Level;
    tile.At = corner / TileEdge;
    tile.Nodes = { corner, corner + 2 };
    if (!tiles.empty() && tiles.back().SameAs(tile))
    {
      tiles.back().Nodes = Union(tiles.back().Nodes, tile.Nodes);
    }
    else
    {
      tiles.push_back(tile);
    }
  }
  const auto key = [](const Tile& t) { return std::make_tuple(t.Level, t.At.z, t.At.y, t.At.x); };
  std::sort(
    tiles.begin(), tiles.end(), [&](const Tile& a, const Tile& b) { return key(a) < key(b); });
  std::vector<Tile> merged;
  for (const Tile& tile : tiles)
  {
    if (!merged.empty() && merged.back().SameAs(tile))
    {
      merged.back().Nodes = Union(merged.back().Nodes, tile.Nodes);
    }
    else
    {
      merged.push_back(tile);
    }
  }
  return merged;
}

/// Samples that a box takes in the image, with those that keep it away from its neighbours.
std::int64_t Cost(const Box& nodes)
{
  const glm::ivec3 size = (nodes.Size() + Alignment - 1) / Alignment * Alignment;
  return std::int64_t{ size.x } * size.y * size.z;
}

/// Cuts tiles of one level where that leaves the fewest samples unused.
class TileCutter
{
public:
  explicit TileCutter(std::vector<AtlasBox>& boxes)
    : Boxes(boxes)
  {
  }

  void Cut(std::vector<Tile>::iterator begin, std::vector<Tile>::iterator end)
  {
    Box tiles, nodes;
    for (auto tile = begin; tile != end; ++tile)
    {
      tiles = Union(tiles, { tile->At, tile->At + 1 });
      nodes = Union(nodes, tile->Nodes);
    }
    const double filled = static_cast<double>(end - begin) / static_cast<double>(tiles.Count());
    int axis = -1;
    int place = 0;
    if (filled < FilledEnough)
    {
      this->FindCut(begin, end, tiles, Cost(nodes), axis, place);
    }
    if (axis < 0)
    {
      this->Boxes.push_back({ begin->Level, nodes.Lo, nodes.Size(), glm::ivec3{ 0 } });
      return;
    }
    const auto middle =
      std::stable_partition(begin, end, [&](const Tile& tile) { return tile.At[axis] < place; });
    this->Cut(begin, middle);
    this->Cut(middle, end);
  }

private:
  /// The cut after which both halves cost least together; none when that is more than one box.
  void FindCut(std::vector<Tile>::iterator begin, std::vector<Tile>::iterator end, const Box& tiles,
    std::int64_t whole, int& axis, int& place) const
  {
    std::int64_t least = whole;
    for (int a = 0; a < 3; ++a)
    {
      const int count = tiles.Size()[a];
      std::vector<Box> layers(static_cast<std::size_t>(count));
      for (auto tile = begin; tile != end; ++tile)
      {
        Box& layer = layers[static_cast<std::size_t>(tile->At[a] - tiles.Lo[a])];
        layer = Union(layer, tile->Nodes);
      }
      std::vector<std::int64_t> above(static_cast<std::size_t>(count) + 1);
      Box part;
      for (int i = count; i-- > 0;)
      {
        part = Union(part, layers[static_cast<std::size_t>(i)]);
        above[static_cast<std::size_t>(i)] = Cost(part);
      }
      part = {};
      for (int i = 1; i < count; ++i)
      {
        part = Union(part, layers[static_cast<std::size_t>(i) - 1]);
        const std::int64_t cost = Cost(part) + above[static_cast<std::size_t>(i)];
        if (cost < least)
        {
          least = cost;
          axis = a;
          place = tiles.Lo[a] + i;
        }
      }
    }
  }

  std::vector<AtlasBox>& Boxes;
};

int RoundUp(int n)
{
  return (n + Alignment - 1) / Alignment * Alignment;
}

/// The edge of a cube that holds all boxes, if they filled it.
int EdgeOf(const std::vector<AtlasBox>& boxes)
{
  double volume = 0.0;
  for (const AtlasBox& box : boxes)
  {
    volume +=
      static_cast<double>(RoundUp(box.Samples.x)) * RoundUp(box.Samples.y) * RoundUp(box.Samples.z);
  }
  return RoundUp(static_cast<int>(std::min(std::max(std::cbrt(volume), 16.0), 1e6)));
}

/// Cuts what is so long that an image around it would be empty for the most part.
void CutLong(std::vector<AtlasBox>& boxes, const glm::ivec3& longest)
{
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    for (int a = 0; a < 3; ++a)
    {
      if (boxes[i].Samples[a] > longest[a])
      {
        AtlasBox rest = boxes[i];
        rest.Low[a] += longest[a];
        rest.Samples[a] -= longest[a];
        boxes[i].Samples[a] = longest[a];
        boxes.push_back(rest);
      }
    }
  }
}

/// Boxes in rows along x, rows in layers along y, layers along z; the thickest boxes first.
glm::ivec3 Place(std::vector<AtlasBox>& boxes)
{
  const int edge = EdgeOf(boxes);
  CutLong(boxes, { 3 * edge, 3 * edge, edge });
  glm::ivec3 image{ 1 };
  for (const AtlasBox& box : boxes)
  {
    image = glm::max(image, box.Samples);
  }
  const int width = RoundUp(std::max(image.x, edge));
  const int depth = RoundUp(std::max(image.y, edge));
  std::vector<std::size_t> order(boxes.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    order[i] = i;
  }
  const auto key = [&](std::size_t i)
  {
    const AtlasBox& box = boxes[i];
    return std::make_tuple(-box.Samples.z, -box.Samples.y, -box.Samples.x, i);
  };
  std::sort(
    order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  glm::ivec3 at{ 0 };
  int row = 0;
  int layer = 0;
  image = glm::ivec3{ 1 };
  for (const std::size_t i : order)
  {
    AtlasBox& box = boxes[i];
    if (at.x + box.Samples.x > width)
    {
      at = { 0, at.y + row, at.z };
      row = 0;
    }
    if (at.y + box.Samples.y > depth)
    {
      at = { 0, 0, at.z + layer };
      row = layer = 0;
    }
    box.Place = at;
    image = glm::max(image, at + box.Samples);
    at.x += RoundUp(box.Samples.x);
    row = std::max(row, RoundUp(box.Samples.y));
    layer = std::max(layer, RoundUp(box.Samples.z));
  }
  return image;
}

} // namespace

std::vector<AtlasBox> PackBoxes(const OctreeLeaves& leaves, glm::ivec3& samples)
{
  std::vector<Tile> tiles = TilesOf(leaves);
  std::vector<AtlasBox> boxes;
  TileCutter cutter(boxes);
  for (auto begin = tiles.begin(); begin != tiles.end();)
  {
    const auto end = std::find_if(
      begin, tiles.end(), [&](const Tile& tile) { return tile.Level != begin->Level; });
    cutter.Cut(begin, end);
    begin = end;
  }
  samples = Place(boxes);
  return boxes;
}

} // namespace banyan
