// SPDX-License-Identifier: BSD-3-Clause
#include "VerifiedMesh.h"

#include "Base/Error.h"
#include "Mesh/CellSeries/CellsFile.h"
#include "Mesh/Series/AtlasValues.h"
#include "Mesh/Series/MeshFile.h"

#include <cstring>
#include <string>

namespace banyan
{
namespace
{

template <class T>
bool Same(const std::vector<T>& mine, ScalarType type, const std::vector<std::uint8_t>& values)
{
  return type == ScalarTypeOf<T>() && values.size() == mine.size() * sizeof(T) &&
         std::memcmp(values.data(), mine.data(), values.size()) == 0;
}

[[noreturn]] void Refuse(int step, const std::string& what)
{
  throw Error(
    "At step " + std::to_string(step) + " the " + what + " of the source differ from the series.");
}

} // namespace

VerifiedMesh::VerifiedMesh(const SeriesFile& series)
  : Series(series)
{
  if (series.Index().Mesh->OfCells)
  {
    this->Cells = ReadCells(series);
  }
  else
  {
    this->Octree = ReadMesh(series);
  }
}

Bytes VerifiedMesh::PointsAt(int step) const
{
  const PointsFile* const moved = MovedPointsOf(this->Series.Index(), step);
  return this->Octree ? this->Octree->Points
         : moved      ? ReadMovedPoints(this->Series, *this->Cells, *moved)
                      : this->Cells->Points;
}

void VerifiedMesh::CheckParts(int step, const SourceMesh& mesh) const
{
  if (this->Cells && (this->Cells->Faces.empty() != (mesh.Faces < 0)))
  {
    Refuse(step, "faces of cells");
  }
}

void VerifiedMesh::Compare(int step, const SourceMesh& mesh, int array, ScalarType type,
  const std::vector<std::uint8_t>& values) const
{
  if (array == mesh.Coordinates)
  {
    const ScalarType mine = this->Octree ? this->Octree->PointType : this->Cells->PointType;
    if (type != mine || values != this->PointsAt(step))
    {
      Refuse(step, "coordinates of points");
    }
  }
  else if (array == mesh.Corners)
  {
    if (!Same(this->Octree ? this->Octree->Connectivity : this->Cells->Connectivity, type, values))
    {
      Refuse(step, "corners of cells");
    }
  }
  else if (array == mesh.Types)
  {
    if (!Same(this->Octree ? this->Octree->CellTypes : this->Cells->Types, type, values))
    {
      Refuse(step, "types of cells");
    }
  }
  else if (this->Cells && array == mesh.Offsets && !Same(this->Cells->Offsets, type, values))
  {
    Refuse(step, "corners of cells");
  }
  else if (this->Cells && array == mesh.Faces && !Same(this->Cells->Faces, type, values))
  {
    Refuse(step, "faces of cells");
  }
}

Bytes VerifiedMesh::ValuesOf(const ArrayIndex& array, const Bytes& image) const
{
  const bool points = array.CellArray.empty();
  const MeshValues where = points ? MeshValues::OfPoints : MeshValues::OfCells;
  const MeshIndex& index = *this->Series.Index().Mesh;
  Bytes values(static_cast<std::size_t>(points ? index.Points : index.Cells) * SizeOf(array.Type));
  (this->Octree ? AtlasValues(this->Octree, where) : AtlasValues(this->Cells, where))
    .FromImage(array.Type, image.data(), 1, values.data());
  return values;
}

} // namespace banyan
