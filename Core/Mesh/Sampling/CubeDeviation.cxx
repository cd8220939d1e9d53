// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Sampling/CubeDeviation.h"

#include <algorithm>

namespace banyan
{
namespace
{

/// Number of the point that is `part` halves of an edge from the first corner.
std::size_t PointNumber(const glm::ivec3& part)
{
  return static_cast<std::size_t>(part.x + 3 * (part.y + 3 * part.z));
}

glm::ivec3 CornerPart(int corner)
{
  return 2 * glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
}

} // namespace

std::size_t CubeDeviation::ColumnOf(std::int64_t node)
{
  const auto found = std::find(this->Nodes.begin(), this->Nodes.end(), node);
  const auto column = static_cast<std::size_t>(found - this->Nodes.begin());
  if (found == this->Nodes.end())
  {
    this->Nodes.push_back(node);
  }
  return column;
}

void CubeDeviation::Collect(const CubePlaces& places)
{
  this->Nodes.clear();
  std::int64_t last = -1;
  std::array<std::size_t, 8> columns{};
  for (std::size_t point = 0; point < 27; ++point)
  {
    if (places[point] == nullptr)
    {
      continue;
    }
    const PlaceInCell& place = *places[point];
    if (place.Cell != last)
    {
      std::array<std::int64_t, 8> nodes;
      this->Shapes.NodesOf(place.Cell, nodes);
      std::transform(nodes.begin(), nodes.end(), columns.begin(),
        [this](std::int64_t node) { return this->ColumnOf(node); });
      last = place.Cell;
    }
    this->Columns[point] = columns;
    this->Weights[point] = TrilinearWeights(place.Part);
  }
}

double CubeDeviation::Of(const CubePlaces& places)
{
  this->Collect(places);
  double worst = 0.0;
  for (int z = 0; z < 3; ++z)
  {
    for (int y = 0; y < 3; ++y)
    {
      for (int x = 0; x < 3; ++x)
      {
        const std::size_t point = PointNumber({ x, y, z });
        if ((x != 1 && y != 1 && z != 1) || places[point] == nullptr || !places[point]->Inside)
        {
          continue;
        }
        this->Difference.assign(this->Nodes.size(), 0.0);
        const auto add = [&](std::size_t from, double factor)
        {
          for (std::size_t i = 0; i < 8; ++i)
          {
            this->Difference[this->Columns[from][i]] += factor * this->Weights[from][i];
          }
        };
        add(point, 1.0);
        const std::array<double, 8> share = TrilinearWeights(0.5 * glm::dvec3(x, y, z));
        for (int corner = 0; corner < 8; ++corner)
        {
          if (share[static_cast<std::size_t>(corner)] > 0.0)
          {
            add(PointNumber(CornerPart(corner)), -share[static_cast<std::size_t>(corner)]);
          }
        }
        double sum = 0.0;
        for (const double difference : this->Difference)
        {
          sum += std::abs(difference);
        }
        worst = std::max(worst, 0.5 * sum);
      }
    }
  }
  return worst;
}

} // namespace banyan
