#include "Parallel/MeshGathering.h"

#include <cmath>
#include <cstring>
#include <vector>

namespace banyan
{
namespace
{

/// Bytes of all ranks, one behind the other, on every rank.
/// @param begins set to where each rank's bytes begin, and where the last one's end
std::shared_ptr<std::vector<char>> GatherBytes(
  Communicator& communicator, const void* mine, std::size_t bytes, std::vector<std::size_t>& begins)
{
  const auto ranks = static_cast<std::size_t>(communicator.Size());
  const std::uint64_t own = bytes;
  std::vector<std::uint64_t> sizes(ranks);
  communicator.AllGather(&own, sizeof(own), sizes.data());
  begins.assign(ranks + 1, 0);
  for (std::size_t rank = 0; rank < ranks; ++rank)
  {
    begins[rank + 1] = begins[rank] + sizes[rank];
  }
  auto all = std::make_shared<std::vector<char>>(begins.back());
  for (std::size_t rank = 0; rank < ranks; ++rank)
  {
    char* const part = all->data() + begins[rank];
    if (static_cast<int>(rank) == communicator.Rank() && bytes > 0)
    {
      std::memcpy(part, mine, bytes);
    }
    if (sizes[rank] > 0)
    {
      communicator.Broadcast(static_cast<int>(rank), part, sizes[rank]);
    }
  }
  return all;
}

template <class To, class From>
std::vector<To> Converted(const From* values, std::int64_t count, std::int64_t offset = 0)
{
  std::vector<To> result(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < result.size(); ++i)
  {
    result[i] = static_cast<To>(values[i]) + static_cast<To>(offset);
  }
  return result;
}

template <class T>
std::shared_ptr<std::vector<char>> GatherArray(
  Communicator& communicator, const std::vector<T>& mine)
{
  std::vector<std::size_t> begins;
  return GatherBytes(communicator, mine.data(), mine.size() * sizeof(T), begins);
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
std::vector<Out> ComponentOf(const NodeArray& array, std::int64_t points)
{
  std::vector<Out> values(static_cast<std::size_t>(points));
  Dispatch(array.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const T* tuple = static_cast<const T*>(array.Values);
      for (Out& value : values)
      {
        if (array.Component != NodeArray::Magnitude)
        {
          value = static_cast<Out>(tuple[array.Component]);
        }
        else
        {
          double sum = 0.0;
          for (int c = 0; c < array.Components; ++c)
          {
            sum += static_cast<double>(tuple[c]) * static_cast<double>(tuple[c]);
          }
          value = static_cast<Out>(std::sqrt(sum));
        }
        tuple += array.Components;
      }
    });
  return values;
}

} // namespace

HexMesh GatherMesh(Communicator& communicator, const HexMesh& piece)
{
  if (communicator.Size() == 1)
  {
    return piece;
  }
  const std::string problem =
    AgreeOnError(communicator, piece.CellCount > 0 ? StrayPoint(piece) : std::string());
  if (!problem.empty())
  {
    throw Error(problem);
  }
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
  using Owners = std::pair<std::shared_ptr<const void>, std::shared_ptr<const void>>;
  const auto owners = std::make_shared<Owners>();
  DispatchMesh(piece,
    [&](const auto* points, const auto* ids)
    {
      const std::shared_ptr<std::vector<char>> allPoints =
        wide ? GatherArray(communicator, Converted<double>(points, 3 * piece.PointCount))
             : GatherArray(communicator, Converted<float>(points, 3 * piece.PointCount));
      const std::shared_ptr<std::vector<char>> allIds =
        GatherArray(communicator, Converted<std::int64_t>(ids, 8 * piece.CellCount, before));
      mesh.Points = allPoints->data();
      mesh.Connectivity = allIds->data();
      mesh.CellCount = static_cast<std::int64_t>(allIds->size() / (8 * sizeof(std::int64_t)));
      *owners = { allPoints, allIds };
    });
  mesh.PointType = wide ? ScalarType::Float64 : ScalarType::Float32;
  mesh.IdType = ScalarType::Int64;
  mesh.Owner = owners;
  return mesh;
}

GatheredValues GatherNodes(Communicator& communicator, const NodeArray& piece, std::int64_t points)
{
  if (communicator.Size() == 1)
  {
    return { piece, {} };
  }
  const bool wide = AllMax(communicator, points > 0 && !FitsFloat(piece.Type) ? 1.0 : 0.0) > 0.0;
  const std::shared_ptr<std::vector<char>> all =
    wide ? GatherArray(communicator, ComponentOf<double>(piece, points))
         : GatherArray(communicator, ComponentOf<float>(piece, points));
  GatheredValues values;
  values.Array.Values = all->data();
  values.Array.Type = wide ? ScalarType::Float64 : ScalarType::Float32;
  values.Owner = all;
  return values;
}

} // namespace banyan
