// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Series/MeshAtlas.h"

#include "Base/Box.h"
#include "Base/Error.h"

#include <algorithm>
#include <map>

namespace banyan
{
namespace
{

Box PlacesOf(const AtlasBox& box)
{
  return { box.Place, box.Place + box.Samples };
}

} // namespace

MeshAtlas MeshAtlas::Pack(const OctreeLeaves& leaves)
{
  glm::ivec3 samples;
  std::vector<AtlasBox> boxes = PackBoxes(leaves, samples);
  int coarsest = 0;
  for (const std::uint8_t level : leaves.Levels)
  {
    coarsest = std::max<int>(coarsest, level);
  }
  return MeshAtlas(samples, std::move(boxes), 0, coarsest);
}

MeshAtlas MeshAtlas::WithList(std::int64_t listed) const
{
  const std::int64_t slice = std::int64_t{ this->Size.x } * this->Size.y;
  const std::int64_t slices = this->Size.z + (listed + slice - 1) / slice;
  if (slices > MostSamples / slice)
  {
    throw Error("The mesh has too many points for one series");
  }
  return MeshAtlas({ this->Size.x, this->Size.y, static_cast<int>(slices) }, this->List, listed,
    this->CoarsestLevel());
}

MeshAtlas::MeshAtlas(
  const glm::ivec3& samples, std::vector<AtlasBox> boxes, std::int64_t listed, int coarsestLevel)
  : Size(samples)
  , List(std::move(boxes))
  , ListSamples(listed)
  , LevelUsed(static_cast<std::size_t>(coarsestLevel) + 1)
{
  this->CheckBoxes();
  int behind = 0;
  for (const AtlasBox& box : this->List)
  {
    behind = std::max(behind, box.Place.z + box.Samples.z);
    this->LevelUsed[static_cast<std::size_t>(box.Level)] = 1;
  }
  this->FirstListed = std::int64_t{ this->Size.x } * this->Size.y * behind;
  if (listed < 0 || listed > this->SampleCount() - this->FirstListed)
  {
    throw Error("The image of the mesh has no room for the points that it lists");
  }
  this->MakeTiles();
}

void MeshAtlas::CheckBoxes() const
{
  const auto require = [](bool good, const char* sentence)
  {
    if (!good)
    {
      throw Error(sentence);
    }
  };
  for (int a = 0; a < 3; ++a)
  {
    require(this->Size[a] >= 1 && this->Size[a] <= 1 << 30, "The image of the mesh has no size");
  }
  // The product of two is below 2^60.
  require(std::int64_t{ this->Size.x } * this->Size.y <= MostSamples &&
            this->SampleCount() <= MostSamples,
    "The image of the mesh has too many samples");
  std::int64_t inBoxes = 0;
  for (const AtlasBox& box : this->List)
  {
    require(box.Level >= 0 && box.Level < static_cast<int>(this->LevelUsed.size()),
      "A box of the mesh is of a level that the mesh has not");
    for (int a = 0; a < 3; ++a)
    {
      require(box.Samples[a] >= 1 && box.Place[a] >= 0 && box.Samples[a] <= this->Size[a] &&
                box.Place[a] <= this->Size[a] - box.Samples[a],
        "A box of the mesh lies outside of its image");
      require(box.Low[a] >= 0 &&
                std::int64_t{ box.Low[a] } + box.Samples[a] - 1 <= (MortonEdge >> box.Level),
        "A box of the mesh lies outside of the octree");
    }
    inBoxes += PlacesOf(box).Count();
    require(inBoxes <= this->SampleCount(), "Boxes of the mesh overlap");
  }
  // Otherwise a small file could ask for a lot of memory.
  require(this->SampleCount() / 256 <= inBoxes + this->ListSamples + (1 << 20),
    "The image of the mesh is much too large for it");
  // Boxes in the order of where they begin along z: few are open at a time.
  std::vector<Box> places;
  for (const AtlasBox& box : this->List)
  {
    places.push_back(PlacesOf(box));
  }
  std::sort(
    places.begin(), places.end(), [](const Box& a, const Box& b) { return a.Lo.z < b.Lo.z; });
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    for (std::size_t j = i + 1; j < places.size() && places[j].Lo.z < places[i].Hi.z; ++j)
    {
      require(Intersection(places[i], places[j]).Empty(), "Boxes of the mesh overlap");
    }
  }
}

void MeshAtlas::MakeTiles()
{
  std::vector<std::pair<std::uint64_t, std::uint32_t>> touched;
  for (std::size_t b = 0; b < this->List.size(); ++b)
  {
    const AtlasBox& box = this->List[b];
    const glm::ivec3 high = box.Low + box.Samples - 1;
    const int step = 1 << TileShift;
    for (int z = box.Low.z / step * step; z <= high.z; z += step)
    {
      for (int y = box.Low.y / step * step; y <= high.y; y += step)
      {
        for (int x = box.Low.x / step * step; x <= high.x; x += step)
        {
          touched.emplace_back(TileKey(box.Level, { x, y, z }), static_cast<std::uint32_t>(b));
        }
      }
    }
  }
  std::sort(touched.begin(), touched.end());
  this->TileBoxes.reserve(touched.size());
  for (std::size_t i = 0; i < touched.size();)
  {
    const auto first = static_cast<std::uint32_t>(i);
    const std::uint64_t key = touched[i].first;
    for (; i < touched.size() && touched[i].first == key; ++i)
    {
      this->TileBoxes.push_back(touched[i].second);
    }
    this->Tiles.emplace(key, std::make_pair(first, static_cast<std::uint32_t>(i)));
  }
}

std::uint32_t MeshAtlas::SampleIn(const AtlasBox& box, const glm::ivec3& node) const
{
  const glm::ivec3 at = node - box.Low;
  const bool inside = at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < box.Samples.x &&
                      at.y < box.Samples.y && at.z < box.Samples.z;
  return inside ? this->Linear(box.Place + at) : NoSample;
}

std::uint32_t MeshAtlas::SampleOf(int level, const glm::ivec3& node) const
{
  const auto found = this->Tiles.find(TileKey(level, node));
  if (found == this->Tiles.end())
  {
    return NoSample;
  }
  for (std::uint32_t i = found->second.first; i < found->second.second; ++i)
  {
    const std::uint32_t sample = this->SampleIn(this->List[this->TileBoxes[i]], node);
    if (sample != NoSample)
    {
      return sample;
    }
  }
  return NoSample;
}

} // namespace banyan
