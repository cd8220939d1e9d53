// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_PieceSamples_h
#define banyan_Parallel_Fields_PieceSamples_h

#include "Parallel/Fields/PieceGrid.h"
#include "Render/Bricks/ArraySamples.h"
#include "Render/Bricks/SampledBox.h"

#include <optional>
#include <vector>

namespace banyan
{

/// Returns the type of views whose values have the given type and may be missing (NaN).
ScalarType TypeWithMissing(ScalarType type);

/// One value that is missing, wherever it is asked for.
SampledBox MissingSamples(const Box& samples);

/// The samples that one rank has of a grid in pieces: its array, which stays where it is, and once
/// they were received, those around it that bricks with a layer around them take.
class PieceSamples
{
public:
  /// Makes the samples of a rank without data.
  PieceSamples() = default;
  /// Throws Error when the array's description is not usable.
  explicit PieceSamples(const SampleArray& array)
    : Own(array)
  {
  }

  bool HasData() const { return this->Own.has_value(); }
  /// HasData.
  const ArraySamples& Array() const { return *this->Own; }
  /// That views have, unless samples are missing in them.
  ScalarType Type() const { return this->Own ? this->Own->ViewType() : ScalarType::Float32; }

  bool HasColours() const { return this->Own && this->Own->HasColours(); }

  bool HasShell() const { return this->ShellIsKnown; }
  /// @param parts those of PieceGrid::ShellOf
  void SetShell(std::vector<SampledBox> parts);

  /// @param samples of the whole grid; what neither the array nor the shell has is NaN.
  /// May be called from any thread. Throws Error when this rank has no data.
  BrickView View(const Box& samples) const;
  /// Memory that the view takes beside the array.
  std::size_t ViewBytes(const Box& samples) const;

private:
  bool IsInside(const Box& samples) const { return this->Own->Array().Samples.Contains(samples); }
  BrickView OwnView(const Box& samples) const;

  std::optional<ArraySamples> Own;
  std::vector<SampledBox> Shell;
  bool ShellIsKnown = false;
};

} // namespace banyan

#endif
