// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/PieceFacts.h"

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

/// Whether two numbers that were computed in slightly different ways mean the same place.
bool Same(double a, double b, double scale)
{
  return std::abs(a - b) <= 1e-9 * std::max({ std::abs(a), std::abs(b), scale });
}

} // namespace

Grid PieceFacts::Geometry() const
{
  Grid grid;
  grid.Extent = this->Samples();
  for (int i = 0; i < 3; ++i)
  {
    grid.Origin[i] = this->Origin[i];
    grid.Spacing[i] = this->Spacing[i];
    for (int j = 0; j < 3; ++j)
    {
      grid.Direction[j][i] = this->Direction[3 * i + j];
    }
  }
  return grid;
}

std::string PieceFacts::DifferenceFrom(const PieceFacts& other, int otherRank) const
{
  const auto differs = [&](const std::string& what)
  {
    return "The pieces of the data do not belong to one grid: " + what +
           " differs from that on rank " + std::to_string(otherRank) +
           ". Draw such data one block at a time.";
  };
  const double scale = *std::max_element(other.Spacing, other.Spacing + 3);
  for (int i = 0; i < 3; ++i)
  {
    if (!Same(this->Origin[i], other.Origin[i], scale))
    {
      return differs("the origin");
    }
    if (!Same(this->Spacing[i], other.Spacing[i], 0.0))
    {
      return differs("the spacing");
    }
  }
  for (int i = 0; i < 9; ++i)
  {
    if (!Same(this->Direction[i], other.Direction[i], 1.0))
    {
      return differs("the direction");
    }
  }
  return this->Components == other.Components ? std::string() : differs("the number of components");
}

} // namespace banyan
