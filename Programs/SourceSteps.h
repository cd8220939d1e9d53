// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Programs_SourceSteps_h
#define banyan_Programs_SourceSteps_h

#include "Base/ScalarType.h"
#include "Series/Format/SeriesIndex.h"
#include "Series/Grid/Grid.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace banyan
{

/// One array of a source, without its values.
struct SourceArray
{
  std::string Name;
  ScalarType Type = ScalarType::Float32;
  int Components = 1;
  std::int64_t Tuples = 0; ///< 0: one per sample
  bool OfCells = false;    ///< of a mesh: one value per cell

  /// Whether an array of a series was made of it.
  bool IsSourceOf(const ArrayIndex& array) const
  {
    return this->Name == (this->OfCells ? array.CellArray : array.Name) &&
           this->OfCells != array.CellArray.empty();
  }
};

/// Holds what a source says of its mesh, before the values: where it is found among the arrays.
struct SourceMesh
{
  std::int64_t Cells = 0;
  int Coordinates = -1; ///< x, y, z of each point
  int Corners = -1;     ///< points (int64) of all cells, in the order that their types have
  int Offsets = -1;     ///< (int64) where those of each cell begin among them, and the end
  int Types = -1;       ///< (uint8) VTK's numbers
  int Faces = -1;       ///< (int64) of polyhedra, as StoredCells has them; may be missing

  bool Has(int array) const
  {
    return array == this->Coordinates || array == this->Corners || array == this->Offsets ||
           array == this->Types || array == this->Faces;
  }
};

/// Says which arrays of a source are the points of its grid.
struct SourcePoints
{
  GridKind Kind = GridKind::Curvilinear;
  /// Rectilinear: the coordinates along each axis. Curvilinear: x, y, z of each sample first.
  std::array<int, 3> Arrays{ -1, -1, -1 };
};

/// Holds what a source says of a step, before its values.
struct SourceStep
{
  std::optional<double> Time; ///< nothing: the source knows of no time
  /// The whole grid, where the source knows it. Where not, only `Samples` counts.
  std::optional<Grid> Domain;
  glm::ivec3 Samples{ 0 };
  std::vector<SourceArray> Arrays;
  std::optional<SourceMesh> Mesh{}; ///< samples are points, along x, then

  std::optional<SourcePoints> Points{}; ///< of a grid that is not regular

  /// Whether an array holds values, and neither a mesh nor points.
  bool IsValue(std::size_t array) const
  {
    const int number = static_cast<int>(array);
    return !(this->Mesh && this->Mesh->Has(number)) && this->AxisOf(array) < 0;
  }
  /// The place of an array in SourcePoints::Arrays, or -1.
  int AxisOf(std::size_t array) const
  {
    for (int axis = 0; this->Points && axis < 3; ++axis)
    {
      if (this->Points->Arrays[static_cast<std::size_t>(axis)] == static_cast<int>(array))
      {
        return axis;
      }
    }
    return -1;
  }
};

/// The steps of something that a series is compared with, one after the other. Nothing but the step
/// at hand is kept in memory.
class SourceSteps
{
public:
  virtual ~SourceSteps() = default;

  /// Goes to the next step. Throws Error when it cannot be read.
  /// @return false when there is none
  virtual bool Next(SourceStep& step) = 0;

  /// Reads the values of an array of the step at hand, `[z][y][x][component]`, component fastest:
  /// each array at most once, and in their order.
  /// Throws Error when they cannot be read.
  virtual void ReadValues(std::size_t array, std::vector<std::uint8_t>& values) = 0;
};

/// Bytes of an array's values at a step. The caller has checked that `samples` fit into memory.
inline std::size_t BytesOf(const SourceArray& array, const glm::ivec3& samples)
{
  const std::int64_t tuples =
    array.Tuples > 0 ? array.Tuples : Box{ glm::ivec3(0), samples }.Count();
  return static_cast<std::size_t>(tuples) * static_cast<std::size_t>(array.Components) *
         SizeOf(array.Type);
}

} // namespace banyan

#endif
