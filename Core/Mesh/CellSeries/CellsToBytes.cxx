// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/CellSeries/CellsFileParts.h"
#include "Mesh/CellSeries/PointNumbers.h"
#include "Mesh/Series/Sections.h"

#include "Base/OrderedBits.h"
#include "Base/Varint.h"
#include "Series/Format/Zstd.h"

namespace banyan
{
namespace
{

using namespace cells_file;

/// Enough cells to see which distance is best.
constexpr std::size_t CellsToTry = 1 << 15;
/// Quick, and in the same order as the level of the file.
constexpr int LevelToTry = 1;

/// The ids of the first cells of a group as numbers that are small where they were predicted well.
void PutIds(
  const StoredCells& mesh, const Group& group, std::size_t cells, std::size_t distance, Bytes& out)
{
  std::vector<std::uint32_t> numbers(cells);
  for (std::size_t corner = 0; corner < group.Corners; ++corner)
  {
    for (std::size_t place = 0; place < cells; ++place)
    {
      const std::int64_t id =
        mesh.Connectivity[static_cast<std::size_t>(mesh.Offsets[group.Cells[place]]) + corner];
      numbers[place] = Zigzag(static_cast<std::uint32_t>(
        static_cast<std::uint32_t>(id) - ExpectedId(mesh, group, place, corner, distance)));
    }
    out.resize(out.size() + sizeof(std::uint32_t) * cells);
    ToPlanes(numbers.data(), cells, out.data() + out.size() - sizeof(std::uint32_t) * cells);
  }
}

std::size_t SizeOfTry(const Bytes& numbers)
{
  Bytes packed;
  AppendCompressed(numbers.data(), numbers.size(), LevelToTry, packed);
  return packed.size();
}

/// The distance that gives the fewest bytes: cells of generators often repeat after a few.
std::size_t BestDistance(const StoredCells& mesh, const Group& group)
{
  const std::size_t cells = std::min(group.Cells.size(), CellsToTry);
  std::size_t best = 1, least = 0;
  for (const std::size_t distance : { 1, 2, 3, 4, 5, 6, 8, 12, 24 })
  {
    Bytes numbers;
    PutIds(mesh, group, cells, distance, numbers);
    const std::size_t bytes = SizeOfTry(numbers);
    if (distance == 1 || bytes < least)
    {
      best = distance;
      least = bytes;
    }
    if (distance >= cells)
    {
      break;
    }
  }
  return best;
}

class CellsWriter
{
public:
  explicit CellsWriter(const StoredCells& mesh)
    : Mesh(mesh)
  {
  }

  Bytes Write()
  {
    this->WriteRuns();
    this->WriteIds();
    this->WriteFaces();
    const auto prediction = this->WritePoints();
    this->WriteHead(prediction);
    return mesh_file::JoinSections(MeshMagic, Version, this->Parts);
  }

private:
  Bytes& Of(Section section) { return this->Parts[static_cast<std::size_t>(section)]; }

  void WriteHead(PointPrediction prediction)
  {
    Bytes& head = this->Of(Head);
    head.push_back(this->Mesh.PointType == ScalarType::Float64 ? 8 : 4);
    head.push_back(static_cast<std::uint8_t>(prediction));
    head.push_back(static_cast<std::uint8_t>(this->Mesh.PointOrder));
    head.push_back(static_cast<std::uint8_t>(this->Mesh.CellOrder));
    PutVarint(head, static_cast<std::uint64_t>(this->Mesh.CellCount()));
    PutVarint(head, static_cast<std::uint64_t>(this->Mesh.PointCount()));
    for (const glm::ivec3& box : { this->Mesh.PointBox, this->Mesh.CellBox })
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        PutVarint(head, static_cast<std::uint64_t>(box[axis]));
      }
    }
  }

  void WriteRuns()
  {
    const StoredCells& mesh = this->Mesh;
    for (std::size_t first = 0, end = 0; first < mesh.Types.size(); first = end)
    {
      const std::size_t size = mesh.SizeOfCell(first);
      // Cells without points take a run each: nothing else of the file would show how many there
      // are.
      for (end = first + 1; end < mesh.Types.size() && size > 0 &&
                            mesh.Types[end] == mesh.Types[first] && mesh.SizeOfCell(end) == size;
           ++end)
      {
      }
      this->Of(Runs).push_back(mesh.Types[first]);
      PutVarint(this->Of(Runs), size);
      PutVarint(this->Of(Runs), end - first);
    }
  }

  void WriteIds()
  {
    for (const Group& group : GroupsOf(this->Mesh))
    {
      const std::size_t distance = BestDistance(this->Mesh, group);
      PutVarint(this->Of(Distances), distance);
      PutIds(this->Mesh, group, group.Cells.size(), distance, this->Of(Ids));
    }
  }

  void WriteFaces()
  {
    const StoredCells& mesh = this->Mesh;
    std::size_t at = 0;
    for (std::size_t cell = 0; cell < mesh.Types.size(); ++cell)
    {
      if (mesh.Types[cell] != PolyhedronType)
      {
        continue;
      }
      const auto first = mesh.Connectivity.begin() + mesh.Offsets[cell];
      const auto end = mesh.Connectivity.begin() + mesh.Offsets[cell + 1];
      const std::int64_t faces = mesh.Faces[at++];
      PutVarint(this->Of(FaceCounts), static_cast<std::uint64_t>(faces));
      for (std::int64_t face = 0; face < faces; ++face)
      {
        const std::int64_t corners = mesh.Faces[at++];
        PutVarint(this->Of(FaceCounts), static_cast<std::uint64_t>(corners));
        for (std::int64_t i = 0; i < corners; ++i)
        {
          const std::int64_t id = mesh.Faces[at++];
          const auto found = std::find(first, end, id);
          PutVarint(this->Of(FaceIds), static_cast<std::uint64_t>(found - first));
          if (found == end)
          {
            PutVarint(this->Of(FaceIds), static_cast<std::uint64_t>(id));
          }
        }
      }
    }
  }

  PointPrediction WritePoints()
  {
    const std::uint8_t* const points = this->Mesh.Points.data();
    Bytes before = NumbersOfPoints(this->Mesh, PointPrediction::Before, points, nullptr);
    Bytes cells = NumbersOfPoints(this->Mesh, PointPrediction::Cells, points, nullptr);
    const bool better = !cells.empty() && SizeOfTry(cells) < SizeOfTry(before);
    this->Of(cells_file::Points) = better ? std::move(cells) : std::move(before);
    return better ? PointPrediction::Cells : PointPrediction::Before;
  }

  const StoredCells& Mesh;
  std::vector<Bytes> Parts = std::vector<Bytes>(Sections);
};

} // namespace

Bytes CellsToBytes(const StoredCells& mesh)
{
  return CellsWriter(mesh).Write();
}

Bytes MovedPointsToBytes(const StoredCells& mesh, const std::uint8_t* points)
{
  std::vector<Bytes> parts(PointsSections);
  std::size_t least = 0;
  const std::uint8_t* const rest = mesh.Points.data();
  for (const PointPrediction prediction : { PointPrediction::Before, PointPrediction::Cells })
  {
    // Points that jumped to other places say nothing about how they move.
    for (const std::uint8_t moved : { 1, 0 })
    {
      Bytes numbers = NumbersOfPoints(mesh, prediction, points, moved != 0 ? rest : nullptr);
      const std::size_t bytes = numbers.empty() ? 0 : SizeOfTry(numbers);
      if (parts[PointsHead].empty() || bytes < least)
      {
        least = bytes;
        parts[PointsHead] = { static_cast<std::uint8_t>(prediction), moved };
        parts[Moved] = std::move(numbers);
      }
    }
  }
  return mesh_file::JoinSections(PointsMagic, Version, parts);
}

} // namespace banyan
