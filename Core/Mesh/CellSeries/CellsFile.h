// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_CellSeries_CellsFile_h
#define banyan_Mesh_CellSeries_CellsFile_h

#include "Mesh/CellSeries/StoredCells.h"
#include "Series/Encode/SeriesEncoder.h"

#include <memory>

namespace banyan
{

class SegmentFolder;
class SeriesFile;

/// Writes the file of a mesh into the folder of its series, and says what encoding must know of it.
/// Throws Error when the file cannot be written.
std::shared_ptr<MeshPlan> WriteCells(const StoredCells& mesh, SegmentFolder& folder);

/// Writes the file of points that have moved.
/// @param points as many as those of the mesh, of their type
/// @param step the first one that has them
/// Throws Error when the file cannot be written.
PointsFile WriteMovedPoints(
  const StoredCells& mesh, const std::uint8_t* points, int step, SegmentFolder& folder);

/// The grid of the images that values of a mesh become.
Grid GridOfImages(const StoredCells& mesh);

/// The mesh of an open series, with the points of its first step. Throws Error that names the file
/// when it is missing or damaged, or is not what the index says.
std::shared_ptr<const StoredCells> ReadCells(const SeriesFile& series);

/// The file that has the points of a step of a mesh of cells; null: they are those of the mesh.
const PointsFile* MovedPointsOf(const SeriesIndex& index, int step);

/// The points in a file of moved points. Throws Error as ReadCells does.
Bytes ReadMovedPoints(const SeriesFile& series, const StoredCells& mesh, const PointsFile& points);

} // namespace banyan

#endif
