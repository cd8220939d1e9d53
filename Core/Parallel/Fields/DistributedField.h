// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_DistributedField_h
#define banyan_Parallel_Fields_DistributedField_h

#include "Parallel/Balance/FrameBalancer.h"
#include "Parallel/Fields/DrawnField.h"
#include "Parallel/Fields/FieldInput.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace banyan
{

/// Finds the kind of field that fits what all ranks have. Pieces of an encoded series that nobody
/// has touched or moved are a SeriesField; anything else on a grid is a WholeField on one rank, and
/// a PiecesField on several; hexahedral meshes, and what is made one, are a MeshField. The field is
/// kept from step to step while its kind stays.
class DistributedField
{
public:
  DistributedField();
  ~DistributedField();

  /// How zones follow what frames cost. For the next Update; the same on all ranks.
  void SetLoadBalancing(LoadBalancing mode);

  /// Collective. Cheap when the stamp of no rank has changed. What fails on one rank is a Problem
  /// on all.
  void Update(Communicator& communicator, FieldInput& input);

  /// Whether the last Update took what has the same stamp, on this rank.
  bool IsOf(const FieldInput& input) const;

  /// Forgets the stamp: the next Update takes the input of all ranks again.
  void Reset();

  /// Another number whenever what is drawn may have changed.
  std::uint64_t Version() const { return this->Updates; }

  /// Per level, a hash of what a scene may show of the field: see banyan::VisibleContent. One alone
  /// counts for all levels where it is not known what bricks hold: it stays until the next change.
  /// The same on all ranks. May throw Error, on one rank alone.
  /// @param looks whether values in memory are looked at to know what they are, which takes time
  const std::vector<Hash128>& VisibleContent(const RayScene& scene, bool looks);

  // From Problem to EncodingError everything is the same on all ranks.

  /// Why nothing can be drawn, in a sentence that names the rank; empty if all is well.
  const std::string& Problem() const { return this->ProblemText; }
  /// True when no rank has anything to draw.
  bool Empty() const { return this->Where.Cells.Empty(); }
  const FieldPlace& Place() const { return this->Where; }
  /// Of the values of all ranks; of all steps, where they come from an encoded series.
  const ValueRange& Range() const { return this->ValuesRange; }
  /// Whether samples are colours: see BrickSource::HasColours.
  bool DrawsColours() const { return this->Colours; }
  /// The largest error of values, of all steps, that encoding has made as far as it is known: of
  /// the drawn component, of the length, or of any component of colours. 0 for plain data and
  /// meshes.
  double EncodingError() const { return this->LargestEncodingError; }

  /// The field, which until the next Update stays the same object.
  DrawnField& Drawn() { return *this->Field; }
  const DrawnField& Drawn() const { return *this->Field; }

  /// Bytes that loaded and packed bricks of this rank may take: its part of the budget for drawing
  /// of its caches, which all volumes that are drawn with them share.
  std::uint64_t DrawingBudget();

private:
  template <class Kind>
  Kind& Become();

  void Take(Communicator& communicator, FieldInput& input);
  void TakeMesh(Communicator& communicator, FieldInput& input, const std::vector<PieceFacts>& all);
  bool HasBeenCells(Communicator& communicator, FieldInput& input);
  bool TakeOctree(Communicator& communicator, FieldInput& input, bool leaves);
  void TakeImages(
    Communicator& communicator, FieldInput& input, const std::vector<PieceFacts>& all);
  bool TakeSeries(Communicator& communicator, const FieldInput& input,
    const std::vector<PieceFacts>& all, const Box& samples);
  void TakeSamples(Communicator& communicator, const FieldInput& input,
    const std::vector<PieceFacts>& all, const Box& samples);
  void HideCells(
    Communicator& communicator, const FieldInput& input, bool here, const glm::ivec3& first);

  std::unique_ptr<DrawnField> Field; ///< never null
  LoadBalancing Balancing = LoadBalancing::Off;
  InputStamp Stamp; ///< of the last Update
  std::uint64_t Updates = 0;
  std::string ProblemText;
  FieldPlace Where;
  ValueRange ValuesRange;
  bool Colours = false;
  double LargestEncodingError = 0.0;
  static constexpr double NotTried = -1.0;
  double NoOctreeAt = NotTried; ///< the tolerance that a CellsField's mesh was tried with

  struct KnownContent
  {
    std::uint64_t Version = 0; ///< 0: none
    TransferFunction Transfer;
    BlendMode Blend = BlendMode::Composite;
    bool Shaded = false;
    bool Looked = false;
    std::vector<Hash128> Levels;
  };
  KnownContent Known; ///< of the last scene
};

} // namespace banyan

#endif
