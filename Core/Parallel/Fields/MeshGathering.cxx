// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/MeshGathering.h"

#include "Mesh/Octree/TakenComponent.h"
#include "Parallel/Communicate/Collective.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace banyan
{
namespace
{

constexpr int TagOfPieces = 0;

/// Bytes of all ranks, one behind the other.
struct Gathered
{
  std::shared_ptr<char> Memory;
  std::size_t Bytes = 0;
};

/// @param begins where each rank's bytes begin
void SendToMachines(Communicator& communicator, const NodeCommunicator& machines, char* all,
  const std::vector<std::size_t>& begins)
{
  const auto partOf = [&](int rank)
  {
    const auto i = static_cast<std::size_t>(rank);
    return std::make_pair(all + begins[i], begins[i + 1] - begins[i]);
  };
  const int self = communicator.Rank();
  for (const int leader : machines.Leaders())
  {
    const auto part = partOf(self);
    if (leader != machines.LeaderOf(self) && part.second > 0)
    {
      communicator.Send(leader, TagOfPieces, part.first, part.second);
    }
  }
  for (int rank = 0; machines.Leads() && rank < communicator.Size(); ++rank)
  {
    const auto part = partOf(rank);
    if (machines.LeaderOf(rank) != self && part.second > 0)
    {
      communicator.Receive(rank, TagOfPieces, part.first, part.second);
    }
  }
  communicator.WaitAll();
  communicator.Barrier();
}

/// Ranks that share memory write their own part each; leaders of machines get what the others have.
/// @param count of values of this rank
/// @param fill writes them where it is told, and throws nothing: the others wait already
template <class T, class Fill>
Gathered GatherArray(
  Communicator& communicator, NodeCommunicator& machines, std::int64_t count, const Fill& fill)
{
  const auto ranks = static_cast<std::size_t>(communicator.Size());
  const std::uint64_t own = static_cast<std::uint64_t>(count) * sizeof(T);
  std::vector<std::uint64_t> sizes(ranks);
  communicator.AllGather(&own, sizeof(own), sizes.data());
  std::vector<std::size_t> begins(ranks + 1, 0);
  for (std::size_t rank = 0; rank < ranks; ++rank)
  {
    begins[rank + 1] = begins[rank] + sizes[rank];
  }
  Gathered all{ machines.Allocate(communicator, begins.back()), begins.back() };
  char* const memory = all.Memory.get();
  fill(reinterpret_cast<T*>(memory + begins[static_cast<std::size_t>(communicator.Rank())]));
  if (machines.Shares())
  {
    communicator.Together(
      [&](Communicator& together) { SendToMachines(together, machines, memory, begins); });
    return all;
  }
  for (std::size_t rank = 0; rank < ranks; ++rank)
  {
    if (sizes[rank] > 0)
    {
      communicator.Broadcast(static_cast<int>(rank), memory + begins[rank], sizes[rank]);
    }
  }
  return all;
}

template <class To, class From>
Gathered GatherConverted(Communicator& communicator, NodeCommunicator& machines, const From* values,
  std::int64_t count, std::int64_t offset = 0)
{
  return GatherArray<To>(communicator, machines, count,
    [&](To* out)
    {
      for (std::int64_t i = 0; i < count; ++i)
      {
        out[i] = static_cast<To>(static_cast<To>(values[i]) + static_cast<To>(offset));
      }
    });
}

/// A cell that refers to a point that is not there; empty if there is none.
std::string StrayPoint(const HexMesh& piece)
{
  std::string problem;
  DispatchMesh(piece,
    [&](const auto*, const auto* ids)
    {
      for (std::int64_t i = 0; i < 8 * piece.CellCount && problem.empty(); ++i)
      {
        if (ids[i] < 0 || ids[i] >= piece.PointCount)
        {
          problem = "Cell " + std::to_string(i / 8) + " refers to point " + std::to_string(ids[i]) +
                    ", and the mesh has " + std::to_string(piece.PointCount) + " points";
        }
      }
    });
  return problem;
}

template <class Out>
void WriteComponent(const NodeArray& array, std::int64_t points, Out* out)
{
  Dispatch(array.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const T* tuple = static_cast<const T*>(array.Values);
      for (std::int64_t i = 0; i < points; ++i, tuple += array.Components)
      {
        out[i] = static_cast<Out>(TakenComponent(tuple, array));
      }
    });
}

template <class Out>
Gathered GatherComponent(Communicator& communicator, NodeCommunicator& machines,
  const NodeArray& array, std::int64_t points)
{
  return GatherArray<Out>(
    communicator, machines, points, [&](Out* out) { WriteComponent(array, points, out); });
}

} // namespace

HexMesh GatherMesh(Communicator& communicator, NodeCommunicator& machines, const HexMesh& piece)
{
  if (communicator.Size() == 1)
  {
    return piece;
  }
  ThrowTogether(communicator, piece.CellCount > 0 ? StrayPoint(piece) : std::string());
  const std::vector<double> counts =
    AllGatherValues(communicator, static_cast<double>(piece.PointCount));
  std::int64_t before = 0;
  HexMesh mesh;
  for (std::size_t rank = 0; rank < counts.size(); ++rank)
  {
    before += static_cast<int>(rank) < communicator.Rank() ? std::int64_t(counts[rank]) : 0;
    mesh.PointCount += static_cast<std::int64_t>(counts[rank]);
  }
  const bool wide =
    AllMax(communicator,
      piece.PointCount > 0 && piece.PointType == ScalarType::Float64 ? 1.0 : 0.0) > 0.0;
  // Ids are what stays of the mesh: four bytes each where that is enough.
  const bool longIds = mesh.PointCount > std::numeric_limits<std::int32_t>::max();
  DispatchMesh(piece,
    [&](const auto* points, const auto* ids)
    {
      const std::int64_t coordinates = 3 * piece.PointCount;
      const Gathered allPoints =
        wide ? GatherConverted<double>(communicator, machines, points, coordinates)
             : GatherConverted<float>(communicator, machines, points, coordinates);
      const std::int64_t corners = 8 * piece.CellCount;
      const Gathered allIds =
        longIds ? GatherConverted<std::int64_t>(communicator, machines, ids, corners, before)
                : GatherConverted<std::int32_t>(communicator, machines, ids, corners, before);
      mesh.Points = allPoints.Memory.get();
      mesh.PointOwner = allPoints.Memory;
      mesh.Connectivity = allIds.Memory.get();
      mesh.Owner = allIds.Memory;
      mesh.CellCount = static_cast<std::int64_t>(
        allIds.Bytes / (8 * (longIds ? sizeof(std::int64_t) : sizeof(std::int32_t))));
    });
  mesh.PointType = wide ? ScalarType::Float64 : ScalarType::Float32;
  mesh.IdType = longIds ? ScalarType::Int64 : ScalarType::Int32;
  return mesh;
}

ValuesOn AgreedPlace(Communicator& communicator, ValuesOn where, bool cells)
{
  const double mine = static_cast<double>(where);
  const double high = AllMax(communicator, cells ? mine : -1.0);
  const double low = -AllMax(communicator, cells ? -mine : -3.0);
  if (low < high)
  {
    throw CollectiveError(
      "The array to draw is a point array on one rank and a cell array on another: rename one "
      "of them.");
  }
  return static_cast<ValuesOn>(static_cast<int>(std::max(high, 0.0)));
}

GatheredValues GatherNodes(Communicator& communicator, NodeCommunicator& machines,
  const NodeArray& piece, std::int64_t points)
{
  if (communicator.Size() == 1)
  {
    return { piece, {} };
  }
  const bool wide = AllMax(communicator, points > 0 && !FitsFloat(piece.Type) ? 1.0 : 0.0) > 0.0;
  const Gathered all = wide ? GatherComponent<double>(communicator, machines, piece, points)
                            : GatherComponent<float>(communicator, machines, piece, points);
  GatheredValues values;
  values.Array.Values = all.Memory.get();
  values.Array.Type = wide ? ScalarType::Float64 : ScalarType::Float32;
  values.Memory = all.Memory;
  return values;
}

} // namespace banyan
