// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Series/MeshPlaces.h"

#include "Base/Error.h"

namespace banyan
{

MeshPlaces::MeshPlaces(const OctreeLeaves& leaves, const MeshAtlas& atlas)
  : Leaves(leaves)
  , Atlas(atlas)
  , Corner(static_cast<std::size_t>(atlas.SampleCount()))
{
  for (std::size_t leaf = 0; leaf < leaves.Keys.size(); ++leaf)
  {
    for (std::size_t corner = 0; corner < 8; ++corner)
    {
      const std::uint32_t sample = atlas.SampleOf(leaves.Levels[leaf], this->NodeOf(leaf, corner));
      if (sample == MeshAtlas::NoSample)
      {
        throw Error("A cell of the mesh has no place in its image");
      }
      this->Corner[sample] = 1;
    }
  }
}

glm::ivec3 MeshPlaces::NodeOf(std::size_t leaf, std::size_t corner) const
{
  const int c = static_cast<int>(corner);
  return (PositionOfKey(this->Leaves.Keys[leaf]) >> int{ this->Leaves.Levels[leaf] }) +
         glm::ivec3{ c & 1, c >> 1 & 1, c >> 2 };
}

int MeshPlaces::FinestLevel(int level, const glm::ivec3& node, std::uint32_t& sample) const
{
  for (int finer = 0; finer < level; ++finer)
  {
    if (this->Atlas.HasLevel(finer))
    {
      sample = this->Atlas.SampleOf(finer, node << (level - finer));
      if (sample != MeshAtlas::NoSample && this->Corner[sample] != 0)
      {
        return finer;
      }
    }
  }
  sample = this->Atlas.SampleOf(level, node);
  return level;
}

std::uint32_t MeshPlaces::PlaceOf(std::size_t leaf, std::size_t corner) const
{
  std::uint32_t sample = 0;
  (void)this->FinestLevel(this->Leaves.Levels[leaf], this->NodeOf(leaf, corner), sample);
  return sample;
}

std::uint32_t MeshPlaces::PlaceOfLeaf(std::size_t leaf) const
{
  return this->Atlas.SampleOf(this->Leaves.Levels[leaf], this->NodeOf(leaf, 0));
}

void MeshPlaces::AddCopies(std::size_t leaf, std::size_t corner, std::uint32_t place,
  std::vector<std::pair<std::uint32_t, std::uint32_t>>& copies) const
{
  glm::ivec3 node = this->NodeOf(leaf, corner);
  const int own = this->Leaves.Levels[leaf];
  std::uint32_t sample = 0;
  const int finest = this->FinestLevel(own, node, sample);
  node <<= own - finest;
  for (int level = finest; level <= this->Atlas.CoarsestLevel(); ++level)
  {
    this->Atlas.ForEachSampleOf(level, node,
      [&](std::uint32_t other)
      {
        if (other != place)
        {
          copies.emplace_back(other, place);
        }
      });
    if (((node.x | node.y | node.z) & 1) != 0)
    {
      return;
    }
    node >>= 1;
  }
}

std::uint32_t NodesAtPlaces::Count(std::uint32_t place) const
{
  if (this->First[place] == None)
  {
    return 0;
  }
  const auto more = this->More.find(place);
  return more == this->More.end() ? 1 : static_cast<std::uint32_t>(more->second.size()) + 1;
}

void NodesAtPlaces::Add(std::uint32_t place, std::uint32_t node)
{
  if (this->First[place] == None)
  {
    this->First[place] = node;
    return;
  }
  this->More[place].push_back(node);
}

std::uint32_t NodesAtPlaces::Find(std::uint32_t place, std::uint32_t node) const
{
  const std::uint32_t count = this->Count(place);
  std::uint32_t i = 0;
  while (i < count && this->Node(place, i) != node)
  {
    ++i;
  }
  return i;
}

void LayOut(const MeshPlaces& places, StoredMesh& mesh)
{
  const auto points = static_cast<std::size_t>(mesh.PointCount());
  const std::size_t cells = mesh.Leaves.Keys.size();
  mesh.SampleOfPoint.assign(points, MeshAtlas::NoSample);
  mesh.SampleOfCell.resize(cells);
  mesh.Copies.clear();
  std::vector<char> taken(static_cast<std::size_t>(mesh.Atlas->SampleCount()));
  std::int64_t listed = 0;
  for (std::size_t leaf = 0; leaf < cells; ++leaf)
  {
    mesh.SampleOfCell[mesh.CellOfLeaf[leaf]] = places.PlaceOfLeaf(leaf);
    for (std::size_t corner = 0; corner < 8; ++corner)
    {
      const auto point = static_cast<std::size_t>(mesh.PointAt(leaf, corner));
      if (mesh.SampleOfPoint[point] != MeshAtlas::NoSample)
      {
        continue;
      }
      const std::uint32_t place = places.PlaceOf(leaf, corner);
      if (taken[place] != 0)
      {
        mesh.SampleOfPoint[point] = mesh.Atlas->SampleOfListed(listed++);
        continue;
      }
      taken[place] = 1;
      mesh.SampleOfPoint[point] = place;
      places.AddCopies(leaf, corner, place, mesh.Copies);
    }
  }
  for (std::uint32_t& sample : mesh.SampleOfPoint)
  {
    if (sample == MeshAtlas::NoSample)
    {
      sample = mesh.Atlas->SampleOfListed(listed++);
    }
  }
}

} // namespace banyan
