// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_PieceItems_h
#define banyan_Inputs_PieceItems_h

#include "vtkDataArray.h"
#include "vtkSmartPointer.h"

#include <vector>

namespace banyan
{

/// A point or cell of one of the pieces.
struct PieceItem
{
  std::size_t Piece = 0;
  vtkIdType Id = 0;
};

/// The tuples of items, in their order.
/// @param parts the array of each piece, all alike
inline vtkSmartPointer<vtkDataArray> TuplesOf(
  vtkDataArray* like, const std::vector<PieceItem>& items, const std::vector<vtkDataArray*>& parts)
{
  const auto whole = vtkSmartPointer<vtkDataArray>::Take(like->NewInstance());
  whole->SetName(like->GetName());
  whole->SetNumberOfComponents(like->GetNumberOfComponents());
  whole->CopyComponentNames(like);
  whole->SetNumberOfTuples(static_cast<vtkIdType>(items.size()));
  for (std::size_t i = 0; i < items.size(); ++i)
  {
    whole->SetTuple(static_cast<vtkIdType>(i), items[i].Id, parts[items[i].Piece]);
  }
  return whole;
}

} // namespace banyan

#endif
