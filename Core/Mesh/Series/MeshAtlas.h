// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Series_MeshAtlas_h
#define banyan_Mesh_Series_MeshAtlas_h

#include "Base/Morton.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace banyan
{

/// The leaves of an octree in the order of their Morton keys, in finest cells.
struct OctreeLeaves
{
  std::vector<MortonKey> Keys;
  std::vector<std::uint8_t> Levels;

  std::int64_t Count() const { return static_cast<std::int64_t>(this->Keys.size()); }
};

/// Nodes of one level of an octree, and where they lie in an image.
struct AtlasBox
{
  int Level = 0;
  glm::ivec3 Low{ 0 };     ///< the first node, in cells of the level: 2^Level finest ones
  glm::ivec3 Samples{ 0 }; ///< nodes per axis
  glm::ivec3 Place{ 0 };   ///< of the first node's sample in the image

  friend bool operator==(const AtlasBox& a, const AtlasBox& b)
  {
    return a.Level == b.Level && a.Low == b.Low && a.Samples == b.Samples && a.Place == b.Place;
  }
};

/// A regular image that the nodes of an octree of mixed levels are laid out in, so that what makes
/// series of images small makes series of meshes small: nodes that are neighbours in the mesh are
/// neighbours in the image, but at the borders of boxes.
///
/// The leaves of each level are covered by boxes, each a part of that level's lattice. Between and
/// beside what is needed of them, samples are free. Behind the last box there is a *list*: single
/// samples for what has no place of its own on the lattice (points at the place of another one,
/// points of no cell).
class MeshAtlas
{
public:
  /// Samples of an image, which 32 bits hold.
  static constexpr std::int64_t MostSamples = (std::int64_t{ 1 } << 32) - 2;
  static constexpr std::uint32_t NoSample = 0xffffffff;

  /// For the leaves of an octree, with an empty list.
  /// Throws Error when the image would have too many samples.
  static MeshAtlas Pack(const OctreeLeaves& leaves);

  /// The same with a list of so many samples: those of boxes stay where they are.
  MeshAtlas WithList(std::int64_t listed) const;

  /// Makes an atlas from its stored parts. Throws Error when boxes overlap, or lie outside of the
  /// image, or there are too many samples.
  MeshAtlas(
    const glm::ivec3& samples, std::vector<AtlasBox> boxes, std::int64_t listed, int coarsestLevel);

  const glm::ivec3& Samples() const { return this->Size; }
  std::int64_t SampleCount() const
  {
    return std::int64_t{ this->Size.x } * this->Size.y * this->Size.z;
  }
  const std::vector<AtlasBox>& Boxes() const { return this->List; }
  std::int64_t Listed() const { return this->ListSamples; }

  /// Returns where a node of a level lies; NoSample when no box has it. The first one of several
  /// boxes counts.
  /// @param node in cells of the level
  std::uint32_t SampleOf(int level, const glm::ivec3& node) const;

  /// All places of a node of a level.
  template <class Body>
  void ForEachSampleOf(int level, const glm::ivec3& node, const Body& body) const;

  std::uint32_t SampleOfListed(std::int64_t i) const
  {
    return static_cast<std::uint32_t>(this->FirstListed + i);
  }

  bool HasLevel(int level) const { return this->LevelUsed[static_cast<std::size_t>(level)] != 0; }
  int CoarsestLevel() const { return static_cast<int>(this->LevelUsed.size()) - 1; }

private:
  static constexpr int TileShift = 4;

  static std::uint64_t TileKey(int level, const glm::ivec3& node)
  {
    return (static_cast<std::uint64_t>(level) << 57) |
           (static_cast<std::uint64_t>(node.z >> TileShift) << 38) |
           (static_cast<std::uint64_t>(node.y >> TileShift) << 19) |
           static_cast<std::uint64_t>(node.x >> TileShift);
  }
  std::uint32_t Linear(const glm::ivec3& place) const
  {
    return static_cast<std::uint32_t>(
      (std::int64_t{ place.z } * this->Size.y + place.y) * this->Size.x + place.x);
  }
  std::uint32_t SampleIn(const AtlasBox& box, const glm::ivec3& node) const;
  void CheckBoxes() const;
  void MakeTiles();

  glm::ivec3 Size{ 0 };
  std::vector<AtlasBox> List;
  std::int64_t ListSamples = 0;
  std::int64_t FirstListed = 0;
  std::vector<char> LevelUsed;
  /// The boxes that touch a tile of a level's lattice: a run of TileBoxes.
  std::unordered_map<std::uint64_t, std::pair<std::uint32_t, std::uint32_t>> Tiles;
  std::vector<std::uint32_t> TileBoxes;
};

template <class Body>
void MeshAtlas::ForEachSampleOf(int level, const glm::ivec3& node, const Body& body) const
{
  const auto found = this->Tiles.find(TileKey(level, node));
  if (found == this->Tiles.end())
  {
    return;
  }
  for (std::uint32_t i = found->second.first; i < found->second.second; ++i)
  {
    const std::uint32_t sample = this->SampleIn(this->List[this->TileBoxes[i]], node);
    if (sample != NoSample)
    {
      body(sample);
    }
  }
}

/// Boxes for the leaves of an octree, with places in an image.
/// @param samples receives the size of the image that holds them; at least 1 per axis
std::vector<AtlasBox> PackBoxes(const OctreeLeaves& leaves, glm::ivec3& samples);

} // namespace banyan

#endif
