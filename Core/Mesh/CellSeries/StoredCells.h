// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_CellSeries_StoredCells_h
#define banyan_Mesh_CellSeries_StoredCells_h

#include "Base/Bytes.h"
#include "Base/ScalarType.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace banyan
{

/// VTK's number of polyhedra, the only cells with faces of their own.
constexpr std::uint8_t PolyhedronType = 42;

/// The order in which points or cells lie in their box of the image; numbers are those of the
/// format.
enum class ImageOrder : std::uint8_t
{
  OfPlaces = 0, ///< see OrderInBox
  OfFile = 1    ///< that of the mesh
};

/// A mesh of cells of any type as a series keeps it: everything that brings it back as it was, bit
/// for bit, and where each of its points and cells lies in the image that values are encoded as.
struct StoredCells
{
  // The mesh, in its own order.
  ScalarType PointType = ScalarType::Float32; ///< or Float64
  Bytes Points;                               ///< x, y, z of each point
  std::vector<std::uint8_t> Types;            ///< of cells: VTK's numbers
  std::vector<std::int64_t> Offsets;          ///< where the points of each cell begin, and the end
  std::vector<std::int64_t> Connectivity;     ///< points of cells, in the order that their type has
  /// Of each polyhedron, in order: how many faces; per face how many points, and these.
  std::vector<std::int64_t> Faces;

  // The image.
  glm::ivec3 PointBox{ 0 }; ///< samples of the box of points. 0: no values
  glm::ivec3 CellBox{ 0 };  ///< the same for cells
  ImageOrder PointOrder = ImageOrder::OfPlaces;
  ImageOrder CellOrder = ImageOrder::OfPlaces;
  std::vector<std::uint32_t> SampleOfPoint;
  std::vector<std::uint32_t> SampleOfCell;

  std::int64_t PointCount() const
  {
    return static_cast<std::int64_t>(this->Points.size() / (3 * SizeOf(this->PointType)));
  }
  std::int64_t CellCount() const { return static_cast<std::int64_t>(this->Types.size()); }
  std::size_t SizeOfCell(std::size_t cell) const
  {
    return static_cast<std::size_t>(this->Offsets[cell + 1] - this->Offsets[cell]);
  }
  /// Samples of the image: both boxes begin at its first one.
  glm::ivec3 Samples() const
  {
    return glm::max(glm::max(this->PointBox, this->CellBox), glm::ivec3(1));
  }
};

/// Values of a step that are to be kept, to choose an order by: `[tuple][component]`.
struct ValuesToKeep
{
  ScalarType Type = ScalarType::Float32;
  const void* Values = nullptr;
  int Components = 1;
  double Bound = 0.0;    ///< on their error
  bool Absolute = false; ///< whether the bound is not a share of their range
};

/// Which values a series of a mesh has.
struct StoredValues
{
  bool AtPoints = true;
  bool InCells = true;
  /// Those of one step. Without any, the order is that of places.
  std::vector<ValuesToKeep> PointArrays{};
  std::vector<ValuesToKeep> CellArrays{};
};

/// Checks a mesh, and finds its image, in the order in which the values cost less.
/// @param mesh without the image
/// Throws Error where a cell names a point that is not there, or the mesh is too large for one
/// series.
std::shared_ptr<const StoredCells> StoreCells(StoredCells mesh, const StoredValues& values);

/// Finds the samples of points and cells from the boxes, the same for reader and writer.
void LayOut(StoredCells& mesh);

/// Throws Error where something in a mesh is not there or does not fit together.
void CheckCells(const StoredCells& mesh);

/// The mesh as the content of a file: see Documentation/format.md. Equal meshes give equal bytes.
Bytes CellsToBytes(const StoredCells& mesh);

/// Inverse of CellsToBytes. Throws Error when the bytes are no such file, or say what cannot be:
/// nothing of it is trusted.
std::shared_ptr<const StoredCells> CellsFromBytes(const Bytes& bytes);

/// Points that have moved, as the content of a file: as many as those of the mesh, of their type.
Bytes MovedPointsToBytes(const StoredCells& mesh, const std::uint8_t* points);

/// Inverse of MovedPointsToBytes. Throws Error as CellsFromBytes does.
Bytes MovedPointsFromBytes(const StoredCells& mesh, const Bytes& bytes);

} // namespace banyan

#endif
