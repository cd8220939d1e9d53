// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Parallel_MeshPieces_h
#define banyan_Testing_Core_Parallel_MeshPieces_h

#include "Mesh/Octree/TinyMeshes.h"
#include "Parallel/Communicate/Communicator.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <vector>

namespace mesh_pieces
{

using Whole = meshes::OwnMesh<double, std::int64_t>;

/// Cells begin to end of a mesh, with the points that they have, as a reader gives pieces.
struct Piece
{
  meshes::OwnMesh<float, std::int32_t> Mesh;
  std::vector<float> Values;      ///< at points, two components
  std::vector<double> CellValues; ///< one component

  Piece(const Whole& whole, std::size_t begin, std::size_t end)
  {
    std::map<std::int64_t, std::int32_t> numbers;
    for (std::size_t i = 8 * begin; i < 8 * end; ++i)
    {
      const std::int64_t id = whole.Ids[i];
      const auto number = numbers.emplace(id, static_cast<std::int32_t>(numbers.size()));
      this->Mesh.Ids.push_back(number.first->second);
      if (number.second)
      {
        const glm::ivec3 place = whole.Places[static_cast<std::size_t>(id)];
        this->Mesh.Places.push_back(place);
        for (int axis = 0; axis < 3; ++axis)
        {
          this->Mesh.Points.push_back(
            static_cast<float>(whole.PointAt(static_cast<std::size_t>(id))[axis]));
        }
        this->Values.push_back(0.0f);
        this->Values.push_back(static_cast<float>(place.x + 100 * place.y + 10000 * place.z));
      }
    }
    for (std::size_t cell = begin; cell < end; ++cell)
    {
      this->CellValues.push_back(static_cast<double>(cell * 37 % 101) / 7.0);
    }
  }
};

/// The piece of a rank; the last one has no cells where there are several.
inline Piece PieceOf(const Whole& whole, const banyan::Communicator& communicator)
{
  const std::size_t cells = whole.Ids.size() / 8;
  const auto parts = static_cast<std::size_t>(std::max(1, communicator.Size() - 1));
  const std::size_t rank = std::min(static_cast<std::size_t>(communicator.Rank()), parts);
  return Piece(whole, cells * rank / parts, cells * std::min(rank + 1, parts) / parts);
}

} // namespace mesh_pieces

#endif
