// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_Interaction_TicketScene_h
#define banyan_Benchmarks_Interaction_TicketScene_h

#include "BenchScene.h"

#include "Parallel/Fields/FieldInput.h"

#include <string>

namespace banyan
{
class Communicator;
}

namespace banyan::bench
{

/// A scene that is looked at from all sides, by its name:
/// - `S1`, `S2`: the standard scenes;
/// - `opaque`: all is opaque, so that a ray ends at its first sample;
/// - `nothing`: all is invisible, so that there are no pixels.
/// @param pixels per side
/// Throws Error for other names.
BenchScene TicketScene(std::shared_ptr<const Volume> volume, const std::string& name, int pixels);

/// The scene with a camera that has gone round it, about the scene's Up.
RayScene Turned(BenchScene scene, double degrees);

/// A rank's block of a volume of which each process has all samples.
class VolumePiece final : public FieldInput
{
public:
  /// @param volume has to stay
  VolumePiece(const Volume& volume, const Communicator& ranks);

  InputStamp Stamp() const override;
  PieceFacts Facts() const override;
  std::shared_ptr<const SeriesFile> Series() const override { return nullptr; }
  TemporalEnhancement Enhancement() const override { return { 0.0, 1.0, 0.0 }; }
  SampleArray Samples(const glm::ivec3& first) const override;
  void HideCells(const glm::ivec3&, HiddenCells&) const override {}
  double MeshTolerance() const override { return 0.0; }
  CellsField::Piece Cells() override { return {}; }
  MeshField::Piece Mesh(Communicator&, bool) override { return {}; }

private:
  const Volume& Whole;
  Box Own; ///< samples
};

} // namespace banyan::bench

#endif
