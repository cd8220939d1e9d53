// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_DistributedField_h
#define banyan_Rendering_DistributedField_h

#include "FieldPiece.h"

#include "Parallel/Balance/FrameBalancer.h"
#include "Parallel/Fields/MeshBytes.h"
#include "Render/Bricks/BrickSource.h"
#include "Render/Bricks/TemporalEnhancement.h"
#include "Render/Bricks/ViewPrefetcher.h"
#include "Series/Decode/SeriesFile.h"
#include "Series/Quantize/ValueRange.h"

#include <glm/mat4x4.hpp>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace banyan
{

class MeshField;
class PieceField;
class SeriesBrickSource;
class TimeStepPrefetcher;

/// One field of scalars that lies distributed over the ranks, agreed upon by all of them: one grid,
/// and one zone of cells per rank. Pieces of an encoded series that nobody has touched or moved are
/// drawn from the file, brick by brick, in zones of their own; anything else from the values in
/// memory, by the rank that has them or by one that fetched them from there (see PieceField).
/// Hexahedral meshes, and what is made one (see GridOfLeaves), are put together on all ranks, and
/// each draws a zone (see MeshField).
class DistributedField
{
public:
  DistributedField();
  ~DistributedField();

  /// How zones follow what frames cost. For the next Update; the same on all ranks.
  void SetLoadBalancing(LoadBalancing mode);

  /// Collective, before a frame: moves the zones, brings what they take, and lets the scene tell
  /// what drawing takes. Throws Error, the same on all ranks, when one fails.
  void BeginFrame(Communicator& communicator, RayScene& scene);
  /// Collective, after it, for frames that may be drawn from coarser levels, up to `coarsest`:
  /// plain data in pieces and meshes have them then too. Throws Error, the same on all ranks, when
  /// one fails.
  void BringLevels(Communicator& communicator, const RayScene& scene, int coarsest);
  /// When this rank has cast the rays of the frame: begins to decode what the next frame of an
  /// encoded series needs: the time step that comes next, if it plays, otherwise what comes onto
  /// the screen, if the camera moves. Does not throw.
  void ReadAhead(const RayScene& scene, int rank);
  /// Collective, after it.
  void EndFrame(Communicator& communicator);
  /// From rank to rank for the frame that was begun last, over all ranks.
  double BytesMoved() const;
  /// Bricks of other ranks that were still here for it, and that were not, over all ranks; and
  /// bytes of such bricks on this rank.
  std::uint64_t FetchHits() const;
  std::uint64_t FetchMisses() const;
  std::uint64_t FetchedBytes() const;

  /// Collective. Cheap when nothing has changed on any rank.
  void Update(Communicator& communicator, const FieldPiece& piece);

  /// Forgets everything; the next Update starts afresh on this rank.
  void Reset();

  /// Another number whenever what is drawn may have changed.
  std::uint64_t Version() const { return this->Updates; }

  /// A sentence when this rank cannot draw; to be agreed on by all ranks.
  const std::string& Problem() const { return this->ProblemText; }

  /// True when no rank has anything to draw. The same on all ranks, as is all that follows.
  bool Empty() const { return this->Domain.Empty(); }
  const glm::dmat4& IndexToPhysical() const { return this->IndexToPhysicalMatrix; }
  const Box& DomainCells() const { return this->Domain; }
  const std::vector<Box>& Zones() const;
  /// (xmin, xmax, ymin, ymax, zmin, zmax) in physical space.
  const std::array<double, 6>& Bounds() const { return this->PhysicalBounds; }
  /// Length of the shortest edge of a cell in physical space.
  double CellSize() const { return this->ShortestEdge; }
  /// Of the values of all ranks; of all steps, where they come from an encoded series.
  const ValueRange& Range() const { return this->ValuesRange; }
  /// The largest error of values, of all steps, that encoding has made as far as it is known: of
  /// the drawn component, or of the length. 0 for plain data and meshes. The same on all ranks.
  double EncodingError() const { return this->LargestEncodingError; }
  /// Whether bricks come from an encoded series.
  bool Encoded() const { return this->Series != nullptr; }

  /// What a user should know of a mesh; empty if nothing. The same on all ranks.
  std::string MeshNote() const;
  /// How far the drawn field may be from that of a mesh: see CubeDeviation. 0 where it is exact.
  double MeshDeviation() const;

  /// What this rank holds of a mesh: its octree, the cells that were gathered for it, and values.
  MeshBytes BytesOfMesh() const;

  /// Whether it is a mesh of hexahedra. Its levels are counted in cells of the finest one.
  bool IsMesh() const { return this->Mesh != nullptr; }

  /// This rank's bricks; null when it has none.
  BrickSource* Source();
  /// What loaded and packed bricks of this rank may take: its part of what the process has for
  /// drawing, which all volumes that are drawn share.
  std::uint64_t DrawingBudget();
  /// Bytes read so far from the series by this process; 0 for plain data.
  std::uint64_t BytesRead() const;

private:
  struct Facts;

  bool ChangedHere(const FieldPiece& piece);
  void Agree(Communicator& communicator, const FieldPiece& piece);
  void AgreeOnRange(Communicator& communicator);
  bool TakeMesh(Communicator& communicator, FieldPiece piece);
  void SetMesh();
  void PlaceMeshZones();
  Facts FactsOf(const FieldPiece& piece) const;
  std::string CheckAgainst(const Facts& mine, const Facts& first, int firstRank) const;
  void SetGrid(const Facts& facts, const Box& samples);
  bool TakeSeries(Communicator& communicator, const std::shared_ptr<const SeriesFile>& held,
    const std::vector<Facts>& all, const Box& samples);
  void MakeSeriesZones(const Facts& field, Communicator& communicator);
  void TakePlain(Communicator& communicator, const FieldPiece& piece, const std::vector<Facts>& all,
    const Box& samples, bool deferred);
  void HideCells(Communicator& communicator, const FieldPiece& piece, const glm::ivec3& first);
  void TakePieces(Communicator& communicator, const FieldPiece& piece,
    const std::vector<Box>& pieces, const glm::ivec3& first);

  std::string ProblemText;
  std::string PieceProblem;
  Box Domain;
  glm::dmat4 IndexToPhysicalMatrix{ 1.0 };
  std::vector<Box> ZoneCells;
  std::unique_ptr<TimeStepPrefetcher> Ahead; ///< null until something is read ahead
  ViewPrefetcher View;
  int Step = 0; ///< of the series
  LoadBalancing Balancing = LoadBalancing::Off;
  FrameBalancer Balancer; ///< of encoded series and meshes
  std::array<double, 6> PhysicalBounds{ { 1, -1, 1, -1, 1, -1 } };
  double ShortestEdge = 1.0;
  ValueRange ValuesRange;
  double LargestEncodingError = 0.0;
  std::unique_ptr<MeshField> Mesh;    ///< null unless it is one of hexahedra
  std::unique_ptr<PieceField> Pieces; ///< null unless it is plain data on several ranks
  std::unique_ptr<BrickSource> Bricks;
  std::shared_ptr<const SeriesFile> Series;
  std::array<std::uint64_t, 10> Stamp{ {} };
  MeshOptions StampedOptions;
  TemporalEnhancement Enhancement{ 0.0, 1.0, 0.0 };
  bool Fresh = true;
  std::uint64_t Updates = 0;
};

} // namespace banyan

#endif
