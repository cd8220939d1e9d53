// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Series/MeshFileParts.h"
#include "Mesh/Series/MeshPlaces.h"
#include "Mesh/Series/Sections.h"

#include "Base/Varint.h"

#include <algorithm>
#include <map>

namespace banyan
{
namespace
{

using namespace mesh_file;

class MeshWriter
{
public:
  explicit MeshWriter(const StoredMesh& mesh)
    : Mesh(mesh)
  {
  }

  Bytes Write()
  {
    this->WriteLeaves();
    this->WriteCells();
    this->WriteNodes();
    Dispatch(this->Mesh.PointType,
      [this](auto tag)
      {
        using Real = typename decltype(tag)::Type;
        if constexpr (std::is_floating_point_v<Real>)
        {
          this->WriteCoordinates<Real>();
        }
      });
    this->WriteHead();
    return JoinSections(MeshMagic, Version, this->Parts);
  }

private:
  Bytes& Of(Section section) { return this->Parts[static_cast<std::size_t>(section)]; }

  void PutReal(Section section, double value)
  {
    Bytes& out = this->Of(section);
    out.resize(out.size() + sizeof(value));
    StoreNumber(out.data() + out.size() - sizeof(value), value);
  }

  void WriteHead()
  {
    const MeshAtlas& atlas = *this->Mesh.Atlas;
    Bytes& head = this->Of(Head);
    head.push_back(this->Mesh.PointType == ScalarType::Float64 ? 8 : 4);
    PutVarint(head, static_cast<std::uint64_t>(this->Mesh.CellCount()));
    PutVarint(head, static_cast<std::uint64_t>(this->Mesh.PointCount()));
    PutVarint(head, this->Mesh.PointOfNode.size());
    for (int a = 0; a < 3; ++a)
    {
      this->PutReal(Head, this->Mesh.Origin[a]);
      this->PutReal(Head, this->Mesh.Edge[a]);
      PutVarint(head, static_cast<std::uint64_t>(atlas.Samples()[a]));
    }
    PutVarint(head, static_cast<std::uint64_t>(atlas.CoarsestLevel()));
    PutVarint(head, static_cast<std::uint64_t>(atlas.Listed()));
    PutVarint(head, atlas.Boxes().size());
    for (const AtlasBox& box : atlas.Boxes())
    {
      PutVarint(this->Of(Boxes), static_cast<std::uint64_t>(box.Level));
      for (const glm::ivec3& v : { box.Low, box.Samples, box.Place })
      {
        for (int a = 0; a < 3; ++a)
        {
          PutVarint(this->Of(Boxes), static_cast<std::uint64_t>(v[a]));
        }
      }
    }
  }

  void WriteLeaves()
  {
    MortonKey end = 0;
    const OctreeLeaves& leaves = this->Mesh.Leaves;
    this->Of(Levels).assign(leaves.Levels.begin(), leaves.Levels.end());
    for (std::size_t i = 0; i < leaves.Keys.size(); ++i)
    {
      PutVarint(this->Of(Gaps), leaves.Keys[i] - end);
      end = leaves.Keys[i] + CubeKeys(leaves.Levels[i]);
    }
  }

  /// Nothing where all differences to the number before are 1.
  void WriteNumbers(Section section, const std::vector<std::uint32_t>& numbers)
  {
    std::int64_t next = 0;
    bool inOrder = true;
    for (const std::uint32_t number : numbers)
    {
      inOrder = inOrder && number == next;
      PutSigned(this->Of(section), std::int64_t{ number } - next);
      next = std::int64_t{ number } + 1;
    }
    if (inOrder)
    {
      this->Of(section).clear();
    }
  }

  void WriteCells()
  {
    const StoredMesh& mesh = this->Mesh;
    this->WriteNumbers(Cells, mesh.CellOfLeaf);
    bool hexahedra = true;
    for (const std::uint32_t cell : mesh.CellOfLeaf)
    {
      this->Of(Types).push_back(mesh.CellTypes[cell]);
      hexahedra = hexahedra && mesh.CellTypes[cell] == Hexahedron;
    }
    if (hexahedra)
    {
      this->Of(Types).clear();
    }
    for (const CornerOrder& order : mesh.Orders)
    {
      this->Of(Orders).insert(this->Of(Orders).end(), order.begin(), order.end());
    }
    for (std::size_t i = 0; mesh.Orders.size() > 1 && i < mesh.OrderOfLeaf.size(); ++i)
    {
      PutVarint(this->Of(OrderOfLeaf), mesh.OrderOfLeaf[i]);
    }
  }

  void WriteNodes()
  {
    const StoredMesh& mesh = this->Mesh;
    this->WriteNumbers(PointNumbers, mesh.PointOfNode);
    this->NodeOfPoint.assign(static_cast<std::size_t>(mesh.PointCount()), MeshAtlas::NoSample);
    for (std::size_t node = 0; node < mesh.PointOfNode.size(); ++node)
    {
      this->NodeOfPoint[mesh.PointOfNode[node]] = static_cast<std::uint32_t>(node);
    }
    const MeshPlaces places(mesh.Leaves, *mesh.Atlas);
    NodesAtPlaces nodes(mesh.Atlas->SampleCount());
    bool alone = true;
    for (std::size_t leaf = 0; leaf < mesh.Leaves.Keys.size(); ++leaf)
    {
      for (std::size_t corner = 0; corner < 8; ++corner)
      {
        const std::uint32_t node =
          this->NodeOfPoint[static_cast<std::size_t>(mesh.PointAt(leaf, corner))];
        const std::uint32_t place = places.PlaceOf(leaf, corner);
        const std::uint32_t choice = nodes.Find(place, node);
        if (choice == nodes.Count(place))
        {
          nodes.Add(place, node);
        }
        alone = alone && choice == 0;
        PutVarint(this->Of(Choices), choice);
      }
    }
    if (alone)
    {
      this->Of(Choices).clear();
    }
  }

  template <class Real>
  Real Coordinate(std::size_t point, int axis) const
  {
    return LoadNumber<Real>(
      this->Mesh.Points.data() + (3 * point + static_cast<std::size_t>(axis)) * sizeof(Real));
  }

  /// Points of the mesh lie on planes of its lattice: what those are is kept once.
  template <class Real>
  void WriteCoordinates()
  {
    const StoredMesh& mesh = this->Mesh;
    std::map<std::int64_t, std::int64_t> planes[3];
    bool exact = true;
    ForEachNode(mesh, this->NodeOfPoint,
      [&](std::uint32_t node, const glm::ivec3& position)
      {
        for (int a = 0; a < 3; ++a)
        {
          const std::int64_t at = Ordered(this->Coordinate<Real>(mesh.PointOfNode[node], a));
          const std::int64_t plane = planes[a].emplace(position[a], at).first->second;
          PutSigned(this->Of(Offsets), Less(at, plane));
          exact = exact && at == plane;
        }
      });
    if (exact)
    {
      this->Of(Offsets).clear();
    }
    for (int a = 0; a < 3; ++a)
    {
      PutVarint(this->Of(Planes), planes[a].size());
      std::int64_t next = 0;
      for (const auto& plane : planes[a])
      {
        PutVarint(this->Of(Planes), static_cast<std::uint64_t>(plane.first - next));
        PutSigned(this->Of(Planes), Less(plane.second, ExpectedPlane<Real>(mesh, a, plane.first)));
        next = plane.first + 1;
      }
    }
    for (std::size_t point = 0; point < this->NodeOfPoint.size(); ++point)
    {
      if (this->NodeOfPoint[point] == MeshAtlas::NoSample)
      {
        const std::uint8_t* at = mesh.Points.data() + 3 * sizeof(Real) * point;
        this->Of(LoosePoints).insert(this->Of(LoosePoints).end(), at, at + 3 * sizeof(Real));
      }
    }
  }

  const StoredMesh& Mesh;
  std::vector<std::uint32_t> NodeOfPoint;
  std::vector<Bytes> Parts = std::vector<Bytes>(Sections);
};

} // namespace

Bytes MeshToBytes(const StoredMesh& mesh)
{
  return MeshWriter(mesh).Write();
}

} // namespace banyan
