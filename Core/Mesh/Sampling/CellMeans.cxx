// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Sampling/CellMeans.h"

#include "Mesh/Octree/TakenComponent.h"

namespace banyan
{

CellMeans::CellMeans(const HexMesh& mesh, const NodeArray& values)
{
  RequireComponent(values);
  const auto points = static_cast<std::size_t>(mesh.PointCount);
  this->Means.assign(points, 0.0);
  std::vector<std::uint32_t> counts(points, 0);
  const auto addTo = [&](const auto* ids, const auto* tuples)
  {
    for (std::int64_t cell = 0; cell < mesh.CellCount; ++cell)
    {
      const double value = TakenComponent(tuples + cell * values.Components, values);
      for (int i = 0; i < 8; ++i)
      {
        const auto node = static_cast<std::size_t>(ids[8 * cell + i]);
        this->Means[node] += value;
        ++counts[node];
      }
    }
  };
  Dispatch(values.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      DispatchMesh(mesh,
        [&](const auto*, const auto* ids) { addTo(ids, static_cast<const T*>(values.Values)); });
    });
  for (std::size_t node = 0; node < points; ++node)
  {
    this->Means[node] /= counts[node] > 0 ? counts[node] : 1;
  }
}

NodeArray CellMeans::Nodes() const
{
  NodeArray array;
  array.Values = this->Means.data();
  array.Type = ScalarType::Float64;
  return array;
}

} // namespace banyan
