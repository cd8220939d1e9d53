// SPDX-License-Identifier: BSD-3-Clause
#include "Series/GoldenCells.h"

#include "Base/Hash.h"
#include "Mesh/CellSeries/CellsFile.h"
#include "Series/Decode/SeriesFile.h"

#include <cstdio>

namespace banyan::testing
{
namespace
{

std::string Hex(const void* data, std::size_t bytes)
{
  char text[17];
  std::snprintf(
    text, sizeof(text), "%016llx", static_cast<unsigned long long>(ShortHashOf(data, bytes)));
  return text;
}

template <class T>
std::string Hex(const std::vector<T>& numbers)
{
  return Hex(numbers.data(), numbers.size() * sizeof(T));
}

/// Corners of each type of cells, in the order of a cube's.
struct Division
{
  int Type;
  std::vector<int> Corners;
};

const std::vector<Division>& DivisionOf(int cube)
{
  static const std::vector<Division> divisions[] = {
    { { 12, { 0, 1, 3, 2, 4, 5, 7, 6 } } },
    { { 13, { 0, 1, 2, 4, 5, 6 } }, { 13, { 1, 3, 2, 5, 7, 6 } }, { 0, {} } },
    { { 10, { 0, 1, 3, 5 } }, { 10, { 0, 3, 2, 6 } }, { 10, { 0, 5, 6, 4 } },
      { 10, { 3, 6, 5, 7 } }, { 10, { 0, 3, 5, 6 } } },
    { { 42, { 0, 2, 3, 1, 4, 5, 7, 6 } } },
  };
  return divisions[cube % 4];
}

const std::vector<int> FacesOfCube[] = { { 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 },
  { 2, 6, 7, 3 }, { 0, 4, 6, 2 }, { 1, 3, 7, 5 } };

} // namespace

GoldenCells::GoldenCells()
{
  StoredCells mesh;
  mesh.PointType = ScalarType::Float32;
  mesh.Offsets.push_back(0);
  const glm::ivec3 n{ 5, 4, 3 };
  for (int i = 0; i < n.x * n.y * n.z; ++i)
  {
    this->Points.push_back({ i % n.x, i / n.x % n.y, i / (n.x * n.y) });
  }
  this->Points.push_back({ 9, 9, 9 });
  int number = 0;
  for (const glm::ivec3& low : this->Points)
  {
    if (glm::any(glm::greaterThanEqual(low, n - 1)))
    {
      continue;
    }
    const auto point = [&](int c)
    {
      const glm::ivec3 at = low + glm::ivec3{ c & 1, c >> 1 & 1, c >> 2 };
      return std::int64_t{ at.x } + n.x * (at.y + n.y * at.z);
    };
    for (const Division& part : DivisionOf(number++))
    {
      mesh.Types.push_back(static_cast<std::uint8_t>(part.Type));
      this->Cells.push_back(low);
      for (const int corner : part.Corners)
      {
        mesh.Connectivity.push_back(point(corner));
      }
      mesh.Offsets.push_back(static_cast<std::int64_t>(mesh.Connectivity.size()));
      for (int face = part.Type == PolyhedronType ? 0 : 6; face < 6; ++face)
      {
        if (face == 0)
        {
          mesh.Faces.push_back(6);
        }
        mesh.Faces.push_back(4);
        for (const int corner : FacesOfCube[face])
        {
          mesh.Faces.push_back(point(corner));
        }
      }
    }
  }
  mesh.Points = this->PointsAt(0);
  // Points are in the order of places then, and cells in that of the file.
  std::vector<float> numbers;
  for (std::size_t cell = 0; cell < mesh.Types.size(); ++cell)
  {
    numbers.push_back(static_cast<float>(cell));
  }
  StoredValues values;
  values.CellArrays = { { ScalarType::Float32, numbers.data(), 1, 0.0, false } };
  this->Mesh = StoreCells(std::move(mesh), values);
}

Bytes GoldenCells::PointsAt(int step) const
{
  Bytes points;
  for (const glm::ivec3& p : this->Points)
  {
    for (const int number :
      { 16 * p.x + p.y * p.y, 16 * p.y - p.z, 16 * p.z + (step < 2 ? 0 : p.x) })
    {
      points.resize(points.size() + sizeof(float));
      StoreNumber(points.data() + points.size() - sizeof(float), static_cast<float>(number));
    }
  }
  return points;
}

std::string CellsText(const SeriesFile& file)
{
  const auto mesh = ReadCells(file);
  std::string text = std::to_string(mesh->PointCount()) + " points, " +
                     std::to_string(mesh->CellCount()) + " cells " + Hex(mesh->Types) +
                     ", corners " + Hex(mesh->Offsets) + " " + Hex(mesh->Connectivity) +
                     ", faces " + Hex(mesh->Faces) + ", samples " + Hex(mesh->SampleOfPoint) + " " +
                     Hex(mesh->SampleOfCell) + ", points of steps";
  for (int step = 0; step < file.Index().Steps(); ++step)
  {
    const PointsFile* const moved = MovedPointsOf(file.Index(), step);
    text += " " + Hex(moved ? ReadMovedPoints(file, *mesh, *moved) : mesh->Points);
  }
  return text;
}

} // namespace banyan::testing
