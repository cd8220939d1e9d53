// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Parallel_Frame_MeshSteps_h
#define banyan_Testing_Core_Parallel_Frame_MeshSteps_h

#include "Parallel/Frame/PlayedSeries.h"
#include "Parallel/MeshMadeAlone.h"

namespace banyan::played
{

/// Of the lattice: half as long as cells of the grid of PlayedSeries.h.
constexpr double FinestEdge = 0.5;

/// Elements of three sizes, the smaller ones in a corner of each cube of 16^3 finest cells.
/// @param farther the same number of them in other corners
inline mesh_pieces::Whole MakeMesh(bool farther)
{
  const glm::ivec3 small(farther ? 12 : 0);
  const auto split = [&](const meshes::Cube& cube)
  { return cube.Level > 2 || cube.Corner % 16 / 4 * 4 == small; };
  return meshes::Make(
    meshes::Leaves({ 7, 6, 6 }, 4, split), glm::dvec3(0.0), glm::dvec3(FinestEdge));
}

inline const mesh_pieces::Whole& MeshOf(bool farther)
{
  static const mesh_pieces::Whole meshes[2]{ MakeMesh(false), MakeMesh(true) };
  return meshes[farther ? 1 : 0];
}

/// The steps of FewChanges at the points of a mesh, which lies in pieces on the ranks.
class MeshInput final : public StepsInMemory
{
public:
  static constexpr int Farther = Steps; ///< step 0 on another mesh

  PieceFacts Facts() const override
  {
    PieceFacts facts;
    facts.Has = PieceFacts::Kind::Mesh;
    return facts;
  }
  SampleArray Samples(const glm::ivec3&) const override { return {}; }
  void HideCells(const glm::ivec3&, HiddenCells&) const override {}
  double MeshTolerance() const override { return ElementOctree::DefaultTolerance; }
  CellsField::Piece Cells() override { return {}; }
  MeshField::Piece Mesh(Communicator&, bool) override
  {
    const mesh_pieces::Piece& piece = this->Step == Farther ? this->Far : this->Near;
    this->Values.clear();
    for (const glm::ivec3& place : piece.Mesh.Places)
    {
      const glm::dvec3 at = glm::dvec3(place) * FinestEdge / glm::dvec3(played::Samples);
      const double value = FewChangesAt(at, this->Step % Steps);
      this->Values.push_back(static_cast<float>(value + (place == this->Changed ? 0.01 : 0.0)));
    }
    MeshField::Piece given;
    given.Mesh = piece.Mesh.Mesh();
    given.Values.Values = this->Values.data();
    return given;
  }

  void Deal(const Communicator& communicator)
  {
    this->Near = mesh_pieces::PieceOf(MeshOf(false), communicator);
    this->Far = mesh_pieces::PieceOf(MeshOf(true), communicator);
  }

private:
  mesh_pieces::Piece Near{ {}, 0, 0 };
  mesh_pieces::Piece Far{ {}, 0, 0 };
  std::vector<float> Values;
};

inline void Join(MeshInput& input, const Communicator& communicator)
{
  input.Deal(communicator);
}

struct MeshPlayer : PlayerOf<MeshInput>
{
  explicit MeshPlayer(Communicator& communicator, std::int64_t = -1)
    : PlayerOf<MeshInput>(communicator, MeshInput())
  {
  }
};

} // namespace banyan::played

#endif
