// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Series/MeshLevel.h"

#include "Mesh/Octree/MergedLeaves.h"

namespace banyan
{

MeshCells CoarserCells(const StoredMesh& mesh, int level)
{
  MeshCells cells;
  const LeafMerging merging(mesh.Leaves.Keys, mesh.Leaves.Levels);
  merging.ForEach(level,
    [&](const MergedLeaf& element)
    {
      cells.FirstLeaf.push_back(static_cast<std::uint32_t>(element.First));
      for (int corner = 0; corner < 8; ++corner)
      {
        cells.Connectivity.push_back(
          mesh.PointAt(merging.LeafAtCorner(element, corner), static_cast<std::size_t>(corner)));
      }
    });
  return cells;
}

} // namespace banyan
