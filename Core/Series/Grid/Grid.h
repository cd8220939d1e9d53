// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Grid_Grid_h
#define banyan_Series_Grid_Grid_h

#include "Base/Box.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace banyan
{

/// The regular grid of a series, with the conventions of vtkImageData: sample (i, j, k) of the
/// extent lies at Origin + Direction * (Spacing * (i, j, k)).
struct Grid
{
  /// Sample indices, half-open: VTK's inclusive extent (x0,x1,...) is Lo = x0, Hi = x1 + 1.
  Box Extent;
  glm::dvec3 Origin{ 0.0 };
  glm::dvec3 Spacing{ 1.0 };
  glm::dmat3 Direction{ 1.0 }; ///< columns are the axes, as glm stores them

  glm::ivec3 Samples() const { return this->Extent.Size(); }
  friend bool operator==(const Grid& a, const Grid& b)
  {
    return a.Extent == b.Extent && a.Origin == b.Origin && a.Spacing == b.Spacing &&
           a.Direction == b.Direction;
  }
};

/// How one level of a grid is cut into bricks.
///
/// Level L keeps every 2^L-th sample of the finest level; where the last cell is not whole, one
/// more sample repeats the last fine one, so that the bricks cover the whole domain:
/// samples(L) = ceil((samples(0) - 1) / 2^L) + 1. A brick owns `BrickCells` cells per axis
/// half-open and carries one more layer of samples, which neighbours share. An axis with one sample
/// has no cells and one layer of bricks.
///
/// Sample positions here start at 0 in each axis (position = extent index - Extent.Lo at level 0).
class BrickLayout
{
public:
  BrickLayout() = default;

  /// @param fineSamples samples per axis at level 0, each >= 1
  /// @param brickCells cells per axis of a brick, a power of two in [4, 128]
  /// @param level 0 is the finest
  BrickLayout(const glm::ivec3& fineSamples, int brickCells, int level);

  int Level() const { return this->LevelNumber; }
  int BrickCells() const { return this->Cells; }
  glm::ivec3 Samples() const { return this->LevelSamples; }
  glm::ivec3 Bricks() const { return this->BrickCounts; }
  std::int64_t BrickCount() const;

  std::int64_t IndexOf(const glm::ivec3& brick) const;
  glm::ivec3 PositionOf(std::int64_t index) const;

  /// Samples of a brick (shared layer included), in samples of this level.
  Box SamplesOf(std::int64_t index) const;
  /// Cells of a brick, in cells of this level. Empty along an axis with a single sample.
  Box CellsOf(std::int64_t index) const;
  /// Position at level 0 of a sample of this level (the last one may repeat the last fine one).
  glm::ivec3 FineSample(const glm::ivec3& sample) const;

  /// The fewest bricks whose samples together cover `samples`: a half-open box of brick positions.
  Box BricksCovering(const Box& samples) const;

  /// Number of levels of a grid: the coarsest is the first that fits into one brick.
  static int LevelCount(const glm::ivec3& fineSamples, int brickCells);

private:
  glm::ivec3 FineSamples{ 1 };
  glm::ivec3 LevelSamples{ 1 };
  glm::ivec3 BrickCounts{ 1 };
  int Cells = 16;
  int LevelNumber = 0;
};

} // namespace banyan

#endif
