// SPDX-License-Identifier: BSD-3-Clause
#include "AnyMesh/HiddenOfData.h"

#include "ArrayLength.h"
#include "GhostCells.h"

#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"

namespace banyan
{
namespace
{

constexpr int HidingBits = GhostBits | vtkDataSetAttributes::REFINEDCELL;

/// Hides the cells that use a blanked point.
void HideAtPoints(vtkDataSet* data, vtkUnsignedCharArray* points, std::vector<std::uint8_t>& hidden)
{
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < data->GetNumberOfCells(); ++cell)
  {
    data->GetCellPoints(cell, ids);
    for (const vtkIdType point : *ids)
    {
      if (point < 0 || point >= points->GetNumberOfValues())
      {
        throw Error("Cell " + std::to_string(cell) + " refers to point " + std::to_string(point) +
                    ", and the mesh has " + std::to_string(points->GetNumberOfValues()) +
                    " points.");
      }
      if ((points->GetValue(point) & vtkDataSetAttributes::HIDDENPOINT) != 0)
      {
        hidden[static_cast<std::size_t>(cell)] = 1;
      }
    }
  }
}

} // namespace

std::vector<std::uint8_t> HiddenCellsOf(vtkDataSet* data)
{
  CheckLength(GhostFlags(data->GetCellData()), vtkDataObject::CELL, data->GetNumberOfCells());
  CheckLength(GhostFlags(data->GetPointData()), vtkDataObject::POINT, data->GetNumberOfPoints());
  vtkUnsignedCharArray* const cells = data->GetCellGhostArray();
  vtkUnsignedCharArray* const points = data->GetPointGhostArray();
  const bool someCells = HasGhosts(cells, HidingBits);
  const bool somePoints = HasGhosts(points, vtkDataSetAttributes::HIDDENPOINT);
  std::vector<std::uint8_t> hidden;
  if (someCells || somePoints)
  {
    hidden.resize(static_cast<std::size_t>(data->GetNumberOfCells()));
  }
  for (std::size_t cell = 0; cell < hidden.size() && someCells; ++cell)
  {
    hidden[cell] = (cells->GetValue(static_cast<vtkIdType>(cell)) & HidingBits) != 0 ? 1 : 0;
  }
  if (somePoints)
  {
    HideAtPoints(data, points, hidden);
  }
  return hidden;
}

} // namespace banyan
