#include "MeshSeries/MeshLevel.h"

#include <algorithm>

namespace banyan
{
namespace
{

class Coarsening
{
public:
  explicit Coarsening(const StoredMesh& mesh)
    : Mesh(mesh)
    , Keys(mesh.Leaves.Keys)
  {
  }

  MeshCells Run(int level)
  {
    level = std::min(level, MortonBits);
    for (std::size_t leaf = 0; leaf < this->Keys.size();)
    {
      if (this->Mesh.Leaves.Levels[leaf] >= level)
      {
        this->AddLeaf(leaf++);
        continue;
      }
      const MortonKey cube = this->Keys[leaf] / CubeKeys(level) * CubeKeys(level);
      const std::size_t end = this->LeafFrom(cube + CubeKeys(level), leaf);
      this->AddCube(level, cube, leaf, end);
      leaf = end;
    }
    return std::move(this->Cells);
  }

private:
  std::size_t LeafFrom(MortonKey key, std::size_t begin) const
  {
    return static_cast<std::size_t>(
      std::lower_bound(
        this->Keys.begin() + static_cast<std::ptrdiff_t>(begin), this->Keys.end(), key) -
      this->Keys.begin());
  }

  void AddLeaf(std::size_t leaf)
  {
    for (std::size_t corner = 0; corner < 8; ++corner)
    {
      this->Cells.Connectivity.push_back(this->Mesh.PointAt(leaf, corner));
    }
  }

  /// The leaves [begin, end) lie in a cube, and all are smaller than that or it is the only one.
  void AddCube(int level, MortonKey cube, std::size_t begin, std::size_t end)
  {
    if (begin == end)
    {
      return;
    }
    if (end - begin == 1)
    {
      this->AddLeaf(begin);
      return;
    }
    MortonKey filled = 0;
    for (std::size_t leaf = begin; leaf < end; ++leaf)
    {
      filled += CubeKeys(this->Mesh.Leaves.Levels[leaf]);
    }
    if (filled < CubeKeys(level))
    {
      for (MortonKey part = 0; part < 8; ++part)
      {
        const MortonKey first = cube + part * CubeKeys(level - 1);
        this->AddCube(level - 1, first, this->LeafFrom(first, begin),
          this->LeafFrom(first + CubeKeys(level - 1), begin));
      }
      return;
    }
    for (std::size_t corner = 0; corner < 8; ++corner)
    {
      // The last finest cell of the octant touches the corner of the cube; of a leaf, its own one.
      const int c = static_cast<int>(corner);
      const glm::ivec3 cell =
        PositionOfKey(cube) + glm::ivec3{ c & 1, c >> 1 & 1, c >> 2 } * ((1 << level) - 1);
      const std::size_t leaf = this->LeafFrom(KeyOf(cell) + 1, begin) - 1;
      this->Cells.Connectivity.push_back(this->Mesh.PointAt(leaf, corner));
    }
  }

  const StoredMesh& Mesh;
  const std::vector<MortonKey>& Keys;
  MeshCells Cells;
};

} // namespace

MeshCells CoarserCells(const StoredMesh& mesh, int level)
{
  return Coarsening(mesh).Run(level);
}

} // namespace banyan
