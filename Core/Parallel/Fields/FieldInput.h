// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_FieldInput_h
#define banyan_Parallel_Fields_FieldInput_h

#include "Parallel/Fields/CellsField.h"
#include "Parallel/Fields/InputStamp.h"
#include "Parallel/Fields/MeshField.h"
#include "Parallel/Fields/PieceFacts.h"
#include "Render/Bricks/ArraySamples.h"
#include "Render/Bricks/HiddenCells.h"
#include "Render/Steps/TemporalEnhancement.h"

#include <memory>

namespace banyan
{

class SeriesFile;

/// Gives this rank's part of a field in the forms of Core. DistributedField asks for what it needs.
/// An input that has nothing of the kind that a function is about is not asked, except where the
/// function is collective.
class FieldInput
{
public:
  virtual ~FieldInput() = default;

  /// Differs whenever anything below does.
  virtual InputStamp Stamp() const = 0;

  /// Throws Error when this rank's data cannot be drawn.
  virtual PieceFacts Facts() const = 0;

  /// Returns the series of an image; null on other ranks, and where values do not come from one.
  virtual std::shared_ptr<const SeriesFile> Series() const = 0;
  /// How pieces of a series are to be enhanced as they are drawn; the same on all ranks. Off where
  /// its strength is 0.
  virtual TemporalEnhancement Enhancement() const = 0;

  /// Returns the samples of an image, where they are in memory.
  /// @param first sample of the whole grid in the extents of pieces, which gets the index 0
  /// Throws Error when the values cannot be decoded or drawn.
  virtual SampleArray Samples(const glm::ivec3& first) const = 0;
  /// Hides what is hidden in an image that has hidden cells. Throws Error when it is not known.
  /// @param first see Samples
  virtual void HideCells(const glm::ivec3& first, HiddenCells& hidden) const = 0;

  /// How far points of an octree may be from its lattice, in edges of the smallest cell: see
  /// ElementOctree::Find. The same on all ranks.
  virtual double MeshTolerance() const = 0;
  /// Whether values lie on cells, and are to be drawn as they are: the same all over a cell. Means
  /// at points are drawn otherwise. Ranks without data say no.
  virtual bool KeepsCellValues() const { return false; }
  /// Collective: the hexahedra of this rank and their values, which stay until the next call.
  /// @param leaves whether some rank has leaves of trees or AMR
  /// Throws Error, possibly on one rank alone, when they cannot be drawn. Messages are complete
  /// then.
  virtual MeshField::Piece Mesh(Communicator& communicator, bool leaves) = 0;
  /// The cells of this rank, of any shapes, and their values, which stay until the next call.
  /// Throws Error when they cannot be drawn.
  virtual CellsField::Piece Cells() = 0;
};

} // namespace banyan

#endif
