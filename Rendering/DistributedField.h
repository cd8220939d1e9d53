// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_DistributedField_h
#define banyan_Rendering_DistributedField_h

#include "FieldPiece.h"

#include "Parallel/Balance/FrameBalancer.h"
#include "Parallel/Fields/DrawnField.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace banyan
{

/// Which field all ranks draw, from what each of them has: finds the kind that fits, and whether
/// anything has changed. Pieces of an encoded series that nobody has touched or moved are a
/// SeriesField; anything else on a grid is a WholeField on one rank, and a PiecesField on several;
/// hexahedral meshes, and what is made one (see GridOfLeaves), are a MeshField. The field is kept
/// from step to step while its kind stays. See DrawnField for the calls in a frame, which without
/// a field do nothing.
class DistributedField
{
public:
  DistributedField();
  ~DistributedField();

  /// How zones follow what frames cost. For the next Update; the same on all ranks.
  void SetLoadBalancing(LoadBalancing mode);

  void BeginFrame(Communicator& communicator, RayScene& scene)
  {
    this->Drawn().BeginFrame(communicator, scene);
  }
  void BringLevels(Communicator& communicator, const RayScene& scene, int coarsest)
  {
    this->Drawn().BringLevels(communicator, scene, coarsest);
  }
  void ReadAhead(const RayScene& scene, int rank) { this->Drawn().ReadAhead(scene, rank); }
  void EndFrame(Communicator& communicator) { this->Drawn().EndFrame(communicator); }
  double BytesMoved() const { return this->Drawn().Moved().Bytes; }
  std::uint64_t FetchHits() const { return this->Drawn().Moved().Hits; }
  std::uint64_t FetchMisses() const { return this->Drawn().Moved().Misses; }
  std::uint64_t FetchedBytes() const { return this->Drawn().Moved().BytesFetched; }

  /// Collective. Cheap when nothing has changed on any rank.
  void Update(Communicator& communicator, const FieldPiece& piece);

  /// Forgets everything; the next Update starts afresh on this rank.
  void Reset();

  /// Another number whenever what is drawn may have changed.
  std::uint64_t Version() const { return this->Updates; }

  /// A sentence when this rank cannot draw; to be agreed on by all ranks.
  const std::string& Problem() const { return this->ProblemText; }

  /// True when no rank has anything to draw. The same on all ranks, as is all that follows.
  bool Empty() const { return this->Place.Cells.Empty(); }
  const glm::dmat4& IndexToPhysical() const { return this->Place.IndexToPhysical; }
  const Box& DomainCells() const { return this->Place.Cells; }
  const std::vector<Box>& Zones() const { return this->Drawn().Zones(); }
  /// (xmin, xmax, ymin, ymax, zmin, zmax) in physical space.
  const std::array<double, 6>& Bounds() const { return this->Place.Bounds; }
  /// Length of the shortest edge of a cell in physical space.
  double CellSize() const { return this->Place.CellSize; }
  /// Of the values of all ranks; of all steps, where they come from an encoded series.
  const ValueRange& Range() const { return this->ValuesRange; }
  /// The largest error of values, of all steps, that encoding has made as far as it is known: of
  /// the drawn component, or of the length. 0 for plain data and meshes. The same on all ranks.
  double EncodingError() const { return this->LargestEncodingError; }
  /// Whether bricks come from an encoded series.
  bool Encoded() const { return this->Drawn().IsEncoded(); }

  /// What a user should know of a mesh; empty if nothing. The same on all ranks.
  std::string MeshNote() const { return this->Drawn().Note(); }
  /// How far the drawn field may be from that of a mesh: see CubeDeviation. 0 where it is exact.
  double MeshDeviation() const { return this->Drawn().Deviation(); }

  /// What this rank holds of a mesh: its octree, the cells that were gathered for it, and values.
  MeshBytes BytesOfMesh() const { return this->Drawn().Bytes(); }

  /// Whether it is a mesh of hexahedra. Its levels are counted in cells of the finest one.
  bool IsMesh() const { return this->Drawn().IsMesh(); }

  /// This rank's bricks; null when it has none.
  BrickSource* Source() { return this->Drawn().Source(); }
  /// What loaded and packed bricks of this rank may take: its part of what the process has for
  /// drawing, which all volumes that are drawn share.
  std::uint64_t DrawingBudget();
  /// Bytes read so far from the series by this process; 0 for plain data.
  std::uint64_t BytesRead() const { return this->Drawn().BytesRead(); }

private:
  struct Facts;

  DrawnField& Drawn() { return *this->Field; }
  const DrawnField& Drawn() const { return *this->Field; }
  template <class Kind>
  Kind& Become();

  bool ChangedHere(const FieldPiece& piece);
  void Agree(Communicator& communicator, const FieldPiece& piece);
  void AgreeOnRange(Communicator& communicator);
  bool TakeMesh(Communicator& communicator, FieldPiece piece);
  Facts FactsOf(const FieldPiece& piece) const;
  std::string CheckAgainst(const Facts& mine, const Facts& first, int firstRank) const;
  bool TakeSeries(Communicator& communicator, const FieldPiece& piece,
    const std::vector<Facts>& all, const Box& samples);
  void TakePlain(Communicator& communicator, const FieldPiece& piece, const std::vector<Facts>& all,
    const Box& samples, bool deferred);
  void TakeSamples(Communicator& communicator, const FieldPiece& piece,
    const std::vector<Box>& pieces, const glm::ivec3& first);
  void HideCells(Communicator& communicator, const FieldPiece& piece, const glm::ivec3& first);

  std::unique_ptr<DrawnField> Field; ///< never null
  LoadBalancing Balancing = LoadBalancing::Off;
  std::string ProblemText;
  FieldPlace Place;
  ValueRange ValuesRange;
  double LargestEncodingError = 0.0;

  /// This rank's piece of the last Update, to compare with.
  std::array<std::uint64_t, 10> Stamp{ {} };
  std::string PieceProblem;
  MeshOptions StampedOptions;
  TemporalEnhancement Enhancement{ 0.0, 1.0, 0.0 };
  bool Fresh = true;
  std::uint64_t Updates = 0;
};

} // namespace banyan

#endif
