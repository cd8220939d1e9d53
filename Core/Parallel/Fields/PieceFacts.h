// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_PieceFacts_h
#define banyan_Parallel_Fields_PieceFacts_h

#include "Series/Grid/Grid.h"

#include <cstdint>
#include <string>

namespace banyan
{

/// Facts that a rank tells the others about its piece. Plain memory: it is sent as it is.
struct PieceFacts
{
  enum class Kind : std::int32_t
  {
    Nothing,
    Image, ///< samples on a grid; all numbers below are those of images
    Mesh,  ///< axis-aligned boxes, which may be the leaves of an octree
    Cells, ///< of any shapes
    Leaves ///< of trees or AMR, which become hexahedra
  };

  Kind Has = Kind::Nothing;
  std::int32_t Deferred = 0; ///< drawn from the file, if all ranks can
  std::int32_t Components = 0;
  std::int32_t Lo[3] = { 0, 0, 0 }; ///< samples, half-open
  std::int32_t Hi[3] = { 0, 0, 0 };
  std::int32_t HiddenCells = 0; ///< whether there are some
  double Origin[3] = { 0, 0, 0 };
  double Spacing[3] = { 1, 1, 1 };
  double Direction[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 }; ///< row by row
  /// The largest error that encoding has made, as far as it is known.
  double EncodingError = 0.0;
  double Fraction = 0.0; ///< of a series drawn from the file: see StepAndFraction
  std::int32_t Step = 0;
  std::int32_t Array = 0;
  std::int32_t Component = 0; ///< or SampleArray::Magnitude, Colours
  std::int32_t Level = 0;

  bool IsImage() const { return this->Has == Kind::Image; }
  bool IsMesh() const { return this->Has != Kind::Nothing && this->Has != Kind::Image; }

  Box Samples() const
  {
    return { { this->Lo[0], this->Lo[1], this->Lo[2] }, { this->Hi[0], this->Hi[1], this->Hi[2] } };
  }

  /// Returns the grid that the samples lie on.
  Grid Geometry() const;

  /// Returns a sentence that says how the grid of this image differs from that of another rank's;
  /// empty if both are pieces of one.
  std::string DifferenceFrom(const PieceFacts& other, int otherRank) const;
};

} // namespace banyan

#endif
