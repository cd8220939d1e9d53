// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/CellSeries/CellsFileParts.h"
#include "Mesh/CellSeries/PointNumbers.h"
#include "Mesh/Series/Sections.h"

#include "Base/OrderedBits.h"
#include "Base/Varint.h"

namespace banyan
{
namespace
{

using namespace cells_file;
using mesh_file::Require;

constexpr std::uint64_t MostItems = (std::uint64_t{ 1 } << 32) - 2;

std::uint64_t Small(ByteReader& reader, std::uint64_t greatest)
{
  const std::uint64_t value = reader.Varint();
  Require(value <= greatest, "A number of the mesh is out of range");
  return value;
}

PointPrediction PredictionOf(ByteReader& reader)
{
  const std::uint8_t prediction = reader.Byte();
  Require(prediction <= 1, "The points of the mesh are predicted in an unknown way");
  return static_cast<PointPrediction>(prediction);
}

ImageOrder OrderOf(ByteReader& reader)
{
  const std::uint8_t order = reader.Byte();
  Require(order <= 1, "The values of the mesh have an unknown order");
  return static_cast<ImageOrder>(order);
}

class CellsReader
{
public:
  explicit CellsReader(const Bytes& bytes)
    : Mesh(std::make_shared<StoredCells>())
    , Parts(mesh_file::SplitSections(bytes, MeshMagic, Version, Sections))
  {
  }

  std::shared_ptr<const StoredCells> Read()
  {
    this->ReadHead();
    this->ReadRuns();
    this->ReadIds();
    this->ReadFaces();
    StoredCells& mesh = *this->Mesh;
    mesh.Points = PointsOfNumbers(mesh, this->Prediction, this->Of(cells_file::Points), nullptr);
    LayOut(mesh);
    return this->Mesh;
  }

private:
  const Bytes& Of(Section section) const { return this->Parts[static_cast<std::size_t>(section)]; }
  ByteReader ReaderOf(Section section) const
  {
    return { this->Of(section).data(), this->Of(section).size() };
  }

  void ReadHead()
  {
    StoredCells& mesh = *this->Mesh;
    ByteReader reader = this->ReaderOf(Head);
    const std::uint8_t bytes = reader.Byte();
    Require(bytes == 4 || bytes == 8, "The points of the mesh are neither float32 nor float64");
    mesh.PointType = bytes == 4 ? ScalarType::Float32 : ScalarType::Float64;
    this->Prediction = PredictionOf(reader);
    mesh.PointOrder = OrderOf(reader);
    mesh.CellOrder = OrderOf(reader);
    this->Cells = reader.Varint();
    this->PointCount = reader.Varint();
    // Other sections say how many there are, so that nothing is made larger than the file explains.
    Require(this->Cells >= 1 && this->Cells <= MostItems && this->PointCount <= MostItems &&
              this->Of(cells_file::Points).size() == 3 * this->PointCount * bytes,
      "The mesh has an impossible number of cells or points");
    mesh.Points.resize(this->Of(cells_file::Points).size());
    ReadBox(reader, mesh.PointOrder, this->PointCount, mesh.PointBox);
    ReadBox(reader, mesh.CellOrder, this->Cells, mesh.CellBox);
    const glm::ivec3 samples = mesh.Samples();
    const auto slab = static_cast<std::uint64_t>(samples.x) * static_cast<std::uint64_t>(samples.y);
    Require(slab <= MostItems / static_cast<std::uint64_t>(samples.z),
      "The image of the mesh is too large");
    reader.MustBeDone();
  }

  /// @param count how many things have samples in it, where any has
  static void ReadBox(ByteReader& reader, ImageOrder order, std::uint64_t count, glm::ivec3& box)
  {
    std::uint64_t most[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      most[axis] = Small(reader, std::uint64_t{ 1 } << 30);
      box[axis] = static_cast<int>(most[axis]);
    }
    if (most[0] + most[1] + most[2] == 0)
    {
      return;
    }
    // All must have a place, and no more room be taken than they need.
    const auto part = [](std::uint64_t all, std::uint64_t parts)
    { return parts == 0 ? 0 : (all + parts - 1) / parts; };
    const bool fits = order == ImageOrder::OfFile
                        ? most[0] <= count && most[1] <= part(count, most[0]) &&
                            most[2] == part(part(count, most[0]), most[1])
                        : most[2] <= count && most[1] <= part(count, most[2]) &&
                            most[0] == part(part(count, most[2]), most[1]);
    Require(most[0] > 0 && most[1] > 0 && most[2] > 0 && count > 0 && fits,
      "A box of the image of the mesh does not fit the number of points or cells");
  }

  void ReadRuns()
  {
    StoredCells& mesh = *this->Mesh;
    ByteReader reader = this->ReaderOf(Runs);
    const std::uint64_t corners = this->Of(Ids).size() / sizeof(std::uint32_t);
    mesh.Offsets.push_back(0);
    while (reader.Left() > 0)
    {
      const std::uint8_t type = reader.Byte();
      const std::uint64_t size = Small(reader, MostItems);
      const std::uint64_t count = Small(reader, this->Cells - mesh.Types.size());
      const auto before = static_cast<std::uint64_t>(mesh.Offsets.back());
      Require(
        count >= 1 && (size > 0 || count == 1) && (size == 0 || count <= (corners - before) / size),
        "The cells of the mesh have another number of points than the file");
      mesh.Types.insert(mesh.Types.end(), count, type);
      for (std::uint64_t i = 0; i < count; ++i)
      {
        mesh.Offsets.push_back(mesh.Offsets.back() + static_cast<std::int64_t>(size));
      }
    }
    Require(mesh.Types.size() == this->Cells &&
              static_cast<std::uint64_t>(mesh.Offsets.back()) * sizeof(std::uint32_t) ==
                this->Of(Ids).size(),
      "The mesh has another number of cells than its parts");
  }

  void ReadIds()
  {
    StoredCells& mesh = *this->Mesh;
    mesh.Connectivity.resize(static_cast<std::size_t>(mesh.Offsets.back()));
    ByteReader reader = this->ReaderOf(Distances);
    const std::uint8_t* planes = this->Of(Ids).data();
    std::vector<std::uint32_t> numbers;
    for (const Group& group : GroupsOf(mesh))
    {
      const std::size_t distance = Small(reader, MostDistance);
      Require(distance > 0, "A number of the mesh is out of range");
      const std::size_t cells = group.Cells.size();
      numbers.resize(cells);
      for (std::size_t corner = 0; corner < group.Corners; ++corner)
      {
        FromPlanes(planes, cells, numbers.data());
        planes += sizeof(std::uint32_t) * cells;
        for (std::size_t place = 0; place < cells; ++place)
        {
          const std::uint32_t id =
            FromZigzag(numbers[place]) + ExpectedId(mesh, group, place, corner, distance);
          Require(id < this->PointCount, "A cell of the mesh has a point that is not there");
          mesh.Connectivity[static_cast<std::size_t>(mesh.Offsets[group.Cells[place]]) + corner] =
            id;
        }
      }
    }
    reader.MustBeDone();
  }

  void ReadFaces()
  {
    StoredCells& mesh = *this->Mesh;
    ByteReader counts = this->ReaderOf(FaceCounts);
    ByteReader ids = this->ReaderOf(FaceIds);
    for (std::size_t cell = 0; cell < mesh.Types.size(); ++cell)
    {
      if (mesh.Types[cell] != PolyhedronType)
      {
        continue;
      }
      const std::size_t size = mesh.SizeOfCell(cell);
      // Each face takes a byte, and each of its points one.
      const std::uint64_t faces = Small(counts, counts.Left());
      mesh.Faces.push_back(static_cast<std::int64_t>(faces));
      for (std::uint64_t face = 0; face < faces; ++face)
      {
        const std::uint64_t corners = Small(counts, ids.Left());
        mesh.Faces.push_back(static_cast<std::int64_t>(corners));
        for (std::uint64_t i = 0; i < corners; ++i)
        {
          const std::uint64_t place = Small(ids, size);
          const std::int64_t id =
            place < size ? mesh.Connectivity[static_cast<std::size_t>(mesh.Offsets[cell]) + place]
                         : static_cast<std::int64_t>(Small(ids, MostItems));
          Require(static_cast<std::uint64_t>(id) < this->PointCount,
            "A face of the mesh has a point that is not there");
          mesh.Faces.push_back(id);
        }
      }
    }
    counts.MustBeDone();
    ids.MustBeDone();
  }

  std::shared_ptr<StoredCells> Mesh;
  std::vector<Bytes> Parts;
  std::uint64_t Cells = 0, PointCount = 0;
  PointPrediction Prediction = PointPrediction::Before;
};

} // namespace

std::shared_ptr<const StoredCells> CellsFromBytes(const Bytes& bytes)
{
  return CellsReader(bytes).Read();
}

Bytes MovedPointsFromBytes(const StoredCells& mesh, const Bytes& bytes)
{
  const std::vector<Bytes> parts =
    mesh_file::SplitSections(bytes, PointsMagic, Version, PointsSections);
  ByteReader reader(parts[PointsHead].data(), parts[PointsHead].size());
  const PointPrediction prediction = PredictionOf(reader);
  const std::uint8_t moved = reader.Byte();
  reader.MustBeDone();
  Require(moved <= 1 && parts[Moved].size() == mesh.Points.size(),
    "The file has not the points of the mesh");
  return PointsOfNumbers(mesh, prediction, parts[Moved], moved != 0 ? mesh.Points.data() : nullptr);
}

} // namespace banyan
