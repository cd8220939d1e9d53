// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Series/MeshFileParts.h"
#include "Mesh/Series/MeshPlaces.h"
#include "Mesh/Series/Sections.h"

#include "Base/Error.h"
#include "Base/Varint.h"

#include <algorithm>
#include <map>

namespace banyan
{
namespace
{

using namespace mesh_file;

constexpr std::uint64_t MostCells = (std::uint64_t{ 1 } << 32) - 2;

class MeshReader
{
public:
  explicit MeshReader(const Bytes& bytes)
    : Mesh(std::make_shared<StoredMesh>())
    , Parts(SplitSections(bytes, MeshMagic, Version, Sections))
  {
  }

  std::shared_ptr<const StoredMesh> Read()
  {
    this->ReadHead();
    this->ReadLeaves();
    this->ReadCells();
    const std::vector<AtlasBox> boxes = this->ReadBoxes();
    this->Mesh->Atlas.emplace(this->ImageSamples, boxes, this->Listed, this->CoarsestLevel);
    const MeshPlaces places(this->Mesh->Leaves, *this->Mesh->Atlas);
    this->ReadNodes(places);
    if (this->Mesh->PointType == ScalarType::Float32)
    {
      this->ReadCoordinates<float>();
    }
    else
    {
      this->ReadCoordinates<double>();
    }
    LayOut(places, *this->Mesh);
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
    ByteReader reader = this->ReaderOf(Head);
    const int bytes = reader.Byte();
    Require(bytes == 4 || bytes == 8, "The points of the mesh are neither float32 nor float64");
    this->Mesh->PointType = bytes == 4 ? ScalarType::Float32 : ScalarType::Float64;
    this->Cells = reader.Varint();
    this->Points = reader.Varint();
    this->Nodes = reader.Varint();
    Require(this->Cells >= 1 && this->Cells <= MostCells && this->Points <= MostCells &&
              this->Nodes <= this->Points && this->Nodes <= 8 * this->Cells && this->Nodes >= 8,
      "The mesh has an impossible number of cells or points");
    // Their sections say how many there are, so that nothing is made larger than the file explains.
    Require(this->Of(Levels).size() == this->Cells &&
              this->Of(LoosePoints).size() ==
                (this->Points - this->Nodes) * 3 * static_cast<std::uint64_t>(bytes),
      "The mesh has another number of cells or points than its parts");
    for (int a = 0; a < 3; ++a)
    {
      this->Mesh->Origin[a] = reader.Number<double>();
      this->Mesh->Edge[a] = reader.Number<double>();
      Require(std::isfinite(this->Mesh->Origin[a]) && std::isfinite(this->Mesh->Edge[a]),
        "The origin or the finest edge of the mesh is not finite");
      this->ImageSamples[a] = this->Small(reader, 1 << 30);
    }
    this->CoarsestLevel = this->Small(reader, MortonBits);
    this->Listed = static_cast<std::int64_t>(this->Small64(reader, MostCells));
    this->BoxCount = this->Small64(reader, this->Of(Boxes).size());
    reader.MustBeDone();
  }

  static std::uint64_t Small64(ByteReader& reader, std::uint64_t greatest)
  {
    const std::uint64_t value = reader.Varint();
    Require(value <= greatest, "A number of the mesh is out of range");
    return value;
  }
  static int Small(ByteReader& reader, int greatest)
  {
    return static_cast<int>(Small64(reader, static_cast<std::uint64_t>(greatest)));
  }

  std::vector<AtlasBox> ReadBoxes() const
  {
    ByteReader reader = this->ReaderOf(Boxes);
    std::vector<AtlasBox> boxes(this->BoxCount);
    for (AtlasBox& box : boxes)
    {
      box.Level = Small(reader, MortonBits);
      for (glm::ivec3* v : { &box.Low, &box.Samples, &box.Place })
      {
        for (int a = 0; a < 3; ++a)
        {
          (*v)[a] = Small(reader, 1 << 30);
        }
      }
    }
    reader.MustBeDone();
    return boxes;
  }

  void ReadLeaves()
  {
    OctreeLeaves& leaves = this->Mesh->Leaves;
    leaves.Levels = this->Of(Levels);
    leaves.Keys.resize(leaves.Levels.size());
    ByteReader reader = this->ReaderOf(Gaps);
    constexpr MortonKey all = MortonKey{ 1 } << 3 * MortonBits;
    MortonKey end = 0;
    for (std::size_t i = 0; i < leaves.Keys.size(); ++i)
    {
      const std::uint64_t gap = Small64(reader, all - end);
      Require(leaves.Levels[i] <= this->CoarsestLevel, "A cell of the mesh has an impossible size");
      const MortonKey size = CubeKeys(leaves.Levels[i]);
      Require(size <= all - end - gap && (end + gap) % size == 0,
        "A cell of the mesh lies where no leaf of an octree can be");
      leaves.Keys[i] = end + gap;
      end = leaves.Keys[i] + size;
    }
    reader.MustBeDone();
  }

  /// @param limit all numbers are below, and none comes twice
  std::vector<std::uint32_t> ReadNumbers(
    Section section, std::size_t count, std::uint64_t limit) const
  {
    std::vector<std::uint32_t> numbers(count);
    if (this->Of(section).empty())
    {
      for (std::size_t i = 0; i < count; ++i)
      {
        numbers[i] = static_cast<std::uint32_t>(i);
      }
      return numbers;
    }
    ByteReader reader = this->ReaderOf(section);
    std::vector<char> seen(limit);
    std::int64_t next = 0;
    for (std::uint32_t& number : numbers)
    {
      const std::int64_t at = Plus(reader.Signed(), next);
      Require(at >= 0 && static_cast<std::uint64_t>(at) < limit &&
                seen[static_cast<std::size_t>(at)] == 0,
        "Two cells or points of the mesh have one number, or one is out of range");
      seen[static_cast<std::size_t>(at)] = 1;
      number = static_cast<std::uint32_t>(at);
      next = at + 1;
    }
    reader.MustBeDone();
    return numbers;
  }

  void ReadCells()
  {
    StoredMesh& mesh = *this->Mesh;
    mesh.CellOfLeaf = this->ReadNumbers(mesh_file::Cells, this->Cells, this->Cells);
    mesh.CellTypes.assign(this->Cells, Hexahedron);
    const Bytes& types = this->Of(Types);
    Require(types.empty() || types.size() == this->Cells, "The mesh has not a type for each cell");
    for (std::size_t leaf = 0; leaf < types.size(); ++leaf)
    {
      Require(types[leaf] == 11 || types[leaf] == 12, "A cell of the mesh has an unknown type");
      mesh.CellTypes[mesh.CellOfLeaf[leaf]] = types[leaf];
    }
    const Bytes& orders = this->Of(Orders);
    Require(!orders.empty() && orders.size() % 8 == 0 && orders.size() / 8 <= 65535,
      "The mesh has an impossible number of orders of corners");
    for (std::size_t i = 0; i < orders.size(); i += 8)
    {
      CornerOrder order{};
      int seen = 0;
      for (std::size_t c = 0; c < 8; ++c)
      {
        Require(orders[i + c] < 8, "A cell of the mesh has an impossible order of corners");
        order[c] = orders[i + c];
        seen |= 1 << order[c];
      }
      Require(seen == 255, "A cell of the mesh has an impossible order of corners");
      mesh.Orders.push_back(order);
    }
    mesh.OrderOfLeaf.assign(this->Cells, 0);
    if (mesh.Orders.size() > 1)
    {
      ByteReader reader = this->ReaderOf(OrderOfLeaf);
      for (std::uint16_t& order : mesh.OrderOfLeaf)
      {
        order = static_cast<std::uint16_t>(Small(reader, static_cast<int>(mesh.Orders.size()) - 1));
      }
      reader.MustBeDone();
    }
  }

  /// Which point each corner of each cell is.
  void ReadNodes(const MeshPlaces& places)
  {
    StoredMesh& mesh = *this->Mesh;
    mesh.PointOfNode = this->ReadNumbers(PointNumbers, this->Nodes, this->Points);
    mesh.Connectivity.resize(8 * this->Cells);
    ByteReader reader = this->ReaderOf(Choices);
    const bool alone = this->Of(Choices).empty();
    NodesAtPlaces nodes(mesh.Atlas->SampleCount());
    std::uint32_t next = 0;
    for (std::size_t leaf = 0; leaf < this->Cells; ++leaf)
    {
      for (std::size_t corner = 0; corner < 8; ++corner)
      {
        const std::uint32_t place = places.PlaceOf(leaf, corner);
        const std::uint32_t known = nodes.Count(place);
        const auto choice = static_cast<std::uint32_t>(alone ? 0 : Small64(reader, known));
        if (choice == known)
        {
          Require(next < this->Nodes, "The cells of the mesh have more points than it has");
          nodes.Add(place, next++);
        }
        mesh.Connectivity[8 * std::size_t{ mesh.CellOfLeaf[leaf] } +
                          mesh.Orders[mesh.OrderOfLeaf[leaf]][corner]] =
          mesh.PointOfNode[nodes.Node(place, choice)];
        this->PlacesTaken += choice == known && known == 0 ? 1 : 0;
      }
    }
    if (!alone)
    {
      reader.MustBeDone();
    }
    Require(next == this->Nodes, "The cells of the mesh have fewer points than it has");
    Require(this->Points - this->PlacesTaken == static_cast<std::uint64_t>(this->Listed),
      "The image of the mesh lists another number of points than it has");
  }

  template <class Real>
  void Put(std::size_t point, int axis, Real value)
  {
    StoreNumber(
      this->Mesh->Points.data() + (3 * point + static_cast<std::size_t>(axis)) * sizeof(Real),
      value);
  }

  template <class Real>
  void ReadCoordinates()
  {
    StoredMesh& mesh = *this->Mesh;
    std::map<std::int64_t, std::int64_t> planes[3];
    ByteReader reader = this->ReaderOf(Planes);
    for (int a = 0; a < 3; ++a)
    {
      const std::uint64_t count = Small64(reader, MortonEdge + 1);
      std::int64_t next = 0;
      for (std::uint64_t i = 0; i < count; ++i)
      {
        const std::int64_t plane = next + static_cast<std::int64_t>(Small64(reader, MortonEdge));
        planes[a].emplace_hint(
          planes[a].end(), plane, Plus(reader.Signed(), ExpectedPlane<Real>(mesh, a, plane)));
        next = plane + 1;
      }
    }
    reader.MustBeDone();
    mesh.Points.resize(this->Points * 3 * sizeof(Real));
    std::vector<std::uint32_t> nodeOfPoint(this->Points, MeshAtlas::NoSample);
    for (std::size_t node = 0; node < this->Nodes; ++node)
    {
      nodeOfPoint[mesh.PointOfNode[node]] = static_cast<std::uint32_t>(node);
    }
    ByteReader offsets = this->ReaderOf(Offsets);
    const bool exact = this->Of(Offsets).empty();
    ForEachNode(mesh, nodeOfPoint,
      [&](std::uint32_t node, const glm::ivec3& position)
      {
        for (int a = 0; a < 3; ++a)
        {
          const auto plane = planes[a].find(position[a]);
          Require(plane != planes[a].end(), "A point of the mesh has no coordinate in its table");
          this->Put(mesh.PointOfNode[node], a,
            FromOrdered<Real>(Plus(plane->second, exact ? 0 : offsets.Signed())));
        }
      });
    if (!exact)
    {
      offsets.MustBeDone();
    }
    const std::uint8_t* loose = this->Of(LoosePoints).data();
    for (std::size_t point = 0; point < this->Points; ++point)
    {
      if (nodeOfPoint[point] == MeshAtlas::NoSample)
      {
        std::copy(loose, loose + 3 * sizeof(Real), mesh.Points.data() + 3 * sizeof(Real) * point);
        loose += 3 * sizeof(Real);
      }
    }
  }

  std::shared_ptr<StoredMesh> Mesh;
  std::vector<Bytes> Parts;
  std::uint64_t Cells = 0, Points = 0, Nodes = 0, BoxCount = 0, PlacesTaken = 0;
  glm::ivec3 ImageSamples{ 0 };
  int CoarsestLevel = 0;
  std::int64_t Listed = 0;
};

} // namespace

std::shared_ptr<const StoredMesh> MeshFromBytes(const Bytes& bytes)
{
  return MeshReader(bytes).Read();
}

} // namespace banyan
