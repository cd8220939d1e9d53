// SPDX-License-Identifier: BSD-3-Clause
// Facts that ranks tell each other about their pieces of image data.
#include "DistributedFieldFacts.h"

#include "HiddenInImage.h"

#include "Series/Decode/SeriesFile.h"

#include "vtkBanyanDeferred.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"

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

/// The largest error that encoding has made of a component, or -1: of the length.
double EncodingErrorOf(const vtkBanyanDeferred::Handle& handle, int component)
{
  const std::vector<ComponentIndex>& components =
    handle.Series->Index().Arrays.at(static_cast<std::size_t>(handle.Array)).Components;
  if (component >= 0)
  {
    return components.at(static_cast<std::size_t>(component)).MeasuredMaxError;
  }
  // A length is off by no more than the vector.
  double squares = 0.0;
  for (const ComponentIndex& each : components)
  {
    squares += each.MeasuredMaxError * each.MeasuredMaxError;
  }
  return std::sqrt(squares);
}

} // namespace

DistributedField::Facts DistributedField::FactsOf(const FieldPiece& piece) const
{
  Facts facts;
  if (!piece.Image || !piece.Array)
  {
    return facts;
  }
  facts.HasData = 1;
  facts.Components = piece.Array->GetNumberOfComponents();
  facts.Component = piece.Component;
  const int* extent = piece.Image->GetExtent();
  for (int i = 0; i < 3; ++i)
  {
    facts.Lo[i] = extent[2 * i];
    facts.Hi[i] = extent[2 * i + 1] + 1;
  }
  piece.Image->GetOrigin(facts.Origin);
  piece.Image->GetSpacing(facts.Spacing);
  std::copy_n(piece.Image->GetDirectionMatrix()->GetData(), 9, facts.Direction);

  facts.HiddenCells = FlagsOfHiddenCells(piece.Image) ? 1 : 0;

  const vtkBanyanDeferred::Handle* handle = vtkBanyanDeferred::From(piece.Array);
  facts.EncodingError = handle ? EncodingErrorOf(*handle, piece.Component) : 0.0;
  if (handle && vtkBanyanDeferred::LiesOnSeries(piece.Image, *handle))
  {
    facts.Deferred = 1;
    facts.Step = handle->Step;
    facts.Array = handle->Array;
    facts.Level = handle->Level;
  }
  return facts;
}

/// Empty if a rank's piece belongs to the same grid as the first one's; otherwise what differs.
std::string DistributedField::CheckAgainst(
  const Facts& mine, const Facts& first, int firstRank) const
{
  const auto differs = [&](const std::string& what)
  {
    return "The pieces of the data do not belong to one grid: " + what +
           " differs from that on rank " + std::to_string(firstRank) +
           ". Draw such data one block at a time.";
  };
  const double scale = *std::max_element(first.Spacing, first.Spacing + 3);
  for (int i = 0; i < 3; ++i)
  {
    if (!Same(mine.Origin[i], first.Origin[i], scale))
    {
      return differs("the origin");
    }
    if (!Same(mine.Spacing[i], first.Spacing[i], 0.0))
    {
      return differs("the spacing");
    }
  }
  for (int i = 0; i < 9; ++i)
  {
    if (!Same(mine.Direction[i], first.Direction[i], 1.0))
    {
      return differs("the direction");
    }
  }
  return mine.Components == first.Components ? std::string() : differs("the number of components");
}

} // namespace banyan
