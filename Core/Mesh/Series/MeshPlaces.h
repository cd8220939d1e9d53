// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Series_MeshPlaces_h
#define banyan_Mesh_Series_MeshPlaces_h

#include "Mesh/Series/StoredMesh.h"

#include <unordered_map>
#include <vector>

namespace banyan
{

/// Where the corners of leaves are kept in an image: each at the finest level that it is a corner
/// of a leaf of.
class MeshPlaces
{
public:
  /// Throws Error when no box of the atlas has a corner of a leaf.
  MeshPlaces(const OctreeLeaves& leaves, const MeshAtlas& atlas);

  /// @param corner 0 to 7, x fastest
  std::uint32_t PlaceOf(std::size_t leaf, std::size_t corner) const;

  /// The sample that a value of the leaf itself is kept at.
  std::uint32_t PlaceOfLeaf(std::size_t leaf) const;

  /// Adds all other samples that show the same point of the lattice.
  void AddCopies(std::size_t leaf, std::size_t corner, std::uint32_t place,
    std::vector<std::pair<std::uint32_t, std::uint32_t>>& copies) const;

private:
  glm::ivec3 NodeOf(std::size_t leaf, std::size_t corner) const;
  /// The finest level that has this node as a corner.
  int FinestLevel(int level, const glm::ivec3& node, std::uint32_t& sample) const;

  const OctreeLeaves& Leaves;
  const MeshAtlas& Atlas;
  std::vector<std::uint8_t>
    Corner; ///< of samples: whether a leaf of their level has its corner there
};

/// The nodes at each place of an image, in the order of their first use: mostly one.
class NodesAtPlaces
{
public:
  explicit NodesAtPlaces(std::int64_t samples)
    : First(static_cast<std::size_t>(samples), None)
  {
  }

  /// How many.
  std::uint32_t Count(std::uint32_t place) const;
  std::uint32_t Node(std::uint32_t place, std::uint32_t i) const
  {
    return i == 0 ? this->First[place] : this->More.at(place)[i - 1];
  }
  void Add(std::uint32_t place, std::uint32_t node);
  /// Which of them a node is, or Count() when it is none.
  std::uint32_t Find(std::uint32_t place, std::uint32_t node) const;

private:
  static constexpr std::uint32_t None = 0xffffffff;
  std::vector<std::uint32_t> First;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> More;
};

/// Which of the nodes at its place each corner of each leaf is, `[leaf][8]`: all 0 where points do
/// not coincide. One more than there were so far: a new node.
using CornerChoices = std::vector<std::uint32_t>;

/// Fills what a mesh has of the image: SampleOfPoint, SampleOfCell, Copies.
/// @param mesh with points, cells, leaves and PointOfNode
/// @param atlas with the list
void LayOut(const MeshPlaces& places, StoredMesh& mesh);

} // namespace banyan

#endif
