// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/SharedMesh.h"

#include "Base/ProcessCores.h"
#include "Base/ThreadPool.h"
#include "Mesh/Octree/OctreeBytes.h"
#include "Parallel/Communicate/Collective.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <vector>

namespace banyan
{
namespace
{

void Add(std::size_t bytes, bool together, MeshBytes& sum)
{
  (together ? sum.Together : sum.Own) += bytes;
}

/// Collective: a field that leaders have, for all ranks.
/// @param field empty on other ranks
NodalField GiveField(Communicator& communicator, NodeCommunicator& machines,
  const std::shared_ptr<const ElementOctree>& tree, std::optional<NodalField>& field,
  MeshBytes& sum)
{
  const bool leads = machines.Leads();
  const bool wide =
    AllMax(communicator, leads && field->Type() == ScalarType::Float64 ? 1.0 : 0.0) > 0.0;
  const MachineBytes bytes = NodeBroadcast(communicator, machines, leads ? field->Bytes() : 0,
    [&](char* to) { std::memcpy(to, field->Values(), field->Bytes()); });
  Add(bytes.Count, bytes.Together, sum);
  NodeArray array;
  array.Values = bytes.Memory.get();
  array.Type = wide ? ScalarType::Float64 : ScalarType::Float32;
  return NodalField(tree, array, bytes.Memory);
}

HexBrickSummary GiveSummary(Communicator& communicator, NodeCommunicator& machines,
  std::size_t bricks, const HexBrickSummary& summary, MeshBytes& sum)
{
  const MachineBytes bytes = NodeBroadcast(communicator, machines,
    HexBrickSummary::PackedBytes(bricks), [&](char* to) { summary.WriteTo(to); });
  Add(bytes.Count, bytes.Together, sum);
  return HexBrickSummary::Read(bricks, bytes.Memory);
}

} // namespace

SharedMesh::SharedMesh(Communicator& communicator, const HexMesh& piece, int brickCells,
  double tolerance, const std::string& machine)
  : Machines(communicator, machine)
{
  HexMesh mesh = GatherMesh(communicator, this->Machines, piece);
  const bool together = this->Machines.RanksHere() > 1;
  std::shared_ptr<const ElementOctree> tree;
  OnLeaders(communicator, this->Machines,
    [&] { tree = ElementOctree::Find(mesh, this->Threads(this->Machines), tolerance); });
  if (mesh.PointOwner)
  {
    mesh.Points = nullptr;
    mesh.PointOwner.reset();
  }
  // A mesh that one process draws alone belongs to the pipeline.
  Add(communicator.Size() > 1 ? mesh.ConnectivityBytes() : 0, together, this->OfMesh);
  if (this->Machines.Shares())
  {
    NodeCommunicator machines = this->Machines;
    std::optional<OctreeBytes> packed;
    OnLeaders(communicator, machines, [&] { packed.emplace(tree, false); });
    const MachineBytes bytes = NodeBroadcast(
      communicator, machines, packed ? packed->Count() : 0, [&](char* to) { packed->WriteTo(to); });
    Collective(communicator, [&] { tree = OctreeBytes::Read(mesh, bytes.Memory); });
    Add(bytes.Count, bytes.Together, this->OfMesh);
  }
  else
  {
    Add(tree->Bytes(), false, this->OfMesh);
  }
  Collective(communicator, [&] { this->Cut = std::make_shared<HexBricks>(tree, brickCells); });
}

SharedMesh::~SharedMesh() = default;

/// Returns the threads of all ranks of the machine: the others wait.
ThreadPool& SharedMesh::Threads(const NodeCommunicator& machines)
{
  ThreadPool& own = ThreadPool::Process();
  const int width = std::min(own.Width() * machines.RanksHere(), ProcessCores());
  if (width <= own.Width())
  {
    return own;
  }
  if (!this->Wide || this->Wide->Width() != width)
  {
    this->Wide = std::make_unique<ThreadPool>(width);
  }
  return *this->Wide;
}

NodalField SharedMesh::MakeField(const NodeArray& values, ValuesOn where, ThreadPool& pool) const
{
  const std::shared_ptr<const ElementOctree> tree(this->Cut, &this->Tree());
  if (where == ValuesOn::Points)
  {
    return NodalField(tree, values, pool);
  }
  const CellNodes made(*tree, values, where, pool);
  return NodalField(tree, made.Nodes(), pool);
}

std::unique_ptr<HexBrickSource> SharedMesh::Field(
  Communicator& communicator, const NodeArray& piece, std::int64_t count, ValuesOn where)
{
  this->OfValues = {};
  const std::shared_ptr<const ElementOctree> tree(this->Cut, &this->Tree());
  NodeCommunicator gathering = this->Machines;
  GatheredValues all = GatherNodes(communicator, gathering, piece, count);
  // Where memory cannot be had together any more, leaders still make what others have no octree
  // for: it was agreed on with the mesh.
  NodeCommunicator machines = this->Machines;
  std::optional<NodalField> field;
  if (where == ValuesOn::Points && all.Memory && gathering.Shares() == machines.Shares())
  {
    OnLeaders(communicator, machines,
      [&] { NodalField::MakeContinuous(*tree, all.Memory.get(), all.Array.Type); });
    field.emplace(tree, all.Array, all.Memory);
    Add(field->Bytes(), machines.RanksHere() > 1, this->OfValues);
  }
  else
  {
    OnLeaders(communicator, machines,
      [&] { field = this->MakeField(all.Array, where, this->Threads(machines)); });
    all = {};
    if (machines.Shares())
    {
      field = GiveField(communicator, machines, tree, field, this->OfValues);
    }
    else
    {
      Add(field->Bytes(), false, this->OfValues);
    }
  }
  HexBrickSummary summary;
  OnLeaders(communicator, machines,
    [&] { summary = HexBrickSummary::Of(*this->Cut, *field, this->Threads(machines)); });
  if (machines.Shares())
  {
    summary =
      GiveSummary(communicator, machines, this->Cut->List().size(), summary, this->OfValues);
  }
  else
  {
    Add(summary.Bytes(), false, this->OfValues);
  }
  return std::make_unique<HexBrickSource>(this->Cut, std::move(*field), std::move(summary));
}

void SharedMesh::BringLevels(Communicator& communicator, int count)
{
  if (!this->Machines.Shares() || this->LevelsAlone)
  {
    return;
  }
  NodeCommunicator machines = this->Machines;
  try
  {
    while (this->Cut->LevelCount() < count)
    {
      this->BringLevel(communicator, machines);
    }
  }
  catch (const CollectiveError&) // and no Interruption
  {
    this->LevelsAlone = true;
  }
}

/// The next one: the octree, and then the points of the mesh that its points are.
void SharedMesh::BringLevel(Communicator& communicator, NodeCommunicator& machines)
{
  std::optional<HexBricks::Level> made;
  std::optional<OctreeBytes> tree;
  OnLeaders(communicator, machines,
    [&]
    {
      made = this->Cut->NextLevel(this->Threads(machines));
      const std::shared_ptr<const HexBricks>& bricks = made->Bricks;
      tree.emplace(std::shared_ptr<const ElementOctree>(bricks, &bricks->Tree()), true);
    });
  const MachineBytes bytes =
    NodeBroadcast(communicator, machines, tree ? tree->Count() + made->NodeOfPoint.Bytes() : 0,
      [&](char* to)
      {
        tree->WriteTo(to);
        std::memcpy(to + tree->Count(), made->NodeOfPoint.data(), made->NodeOfPoint.Bytes());
      });
  const auto add = [&]
  {
    const std::shared_ptr<const ElementOctree> read = OctreeBytes::Read({}, bytes.Memory);
    const auto points = static_cast<std::size_t>(read->Mesh().PointCount);
    const char* const end = bytes.Memory.get() + bytes.Count;
    this->Cut->AddLevel(read,
      { reinterpret_cast<const std::uint32_t*>(end) - points, points, bytes.Memory },
      bytes.Together ? 0 : bytes.Count);
  };
  // A frame that is broken off must not leave the level on some ranks alone: they would not know of
  // the failure of the others.
  communicator.Together([&](Communicator& ranks) { Collective(ranks, add); });
  this->OfMesh.Together += bytes.Together ? bytes.Count : 0;
}

MeshBytes SharedMesh::Bytes() const
{
  MeshBytes sum = this->OfMesh;
  sum.Own += this->OfValues.Own + this->Cut->Bytes();
  sum.Together += this->OfValues.Together;
  sum.Leads = this->Machines.Leads();
  return sum;
}

} // namespace banyan
