// SPDX-License-Identifier: BSD-3-Clause
#include "HiddenFlags.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include "Series/Decode/SeriesFile.h"

#include <glm/common.hpp>

namespace banyan
{
namespace
{

/// Between two steps, the flags of both.
vtkSmartPointer<vtkUnsignedCharArray> Read(vtkBanyanDeferred::Handle handle)
{
  const bool between = handle.Fraction > 0.0;
  handle.Fraction = 0.0;
  vtkSmartPointer<vtkUnsignedCharArray> flags =
    vtkUnsignedCharArray::SafeDownCast(vtkBanyanDeferred::NewPlain(handle));
  flags->SetName(vtkDataSetAttributes::GhostArrayName());
  if (between)
  {
    ++handle.Step;
    const vtkSmartPointer<vtkUnsignedCharArray> later =
      vtkUnsignedCharArray::SafeDownCast(vtkBanyanDeferred::NewPlain(handle));
    for (vtkIdType i = 0; i < flags->GetNumberOfValues(); ++i)
    {
      flags->SetValue(i, flags->GetValue(i) | later->GetValue(i));
    }
  }
  return flags;
}

/// Calls `body(cell, whether a corner is hidden)` for each cell of a piece.
/// @param samples of the piece, per axis
/// @param points null: none is hidden
template <class Body>
void ForEachCell(const glm::ivec3& samples, const unsigned char* points, Body&& body)
{
  const glm::ivec3 cells = glm::max(samples - 1, 1);
  const glm::ivec3 next = glm::min(samples - 1, 1); // 0 along an axis without cells
  const auto at = [&](int x, int y, int z)
  { return (static_cast<vtkIdType>(z) * samples.y + y) * samples.x + x; };
  vtkIdType cell = 0;
  for (int z = 0; z < cells.z; ++z)
  {
    for (int y = 0; y < cells.y; ++y)
    {
      for (int x = 0; x < cells.x; ++x, ++cell)
      {
        bool hidden = false;
        for (int corner = 0; corner < 8 && points; ++corner)
        {
          hidden = hidden || points[at(x + (corner & 1) * next.x, y + (corner >> 1 & 1) * next.y,
                               z + (corner >> 2) * next.z)] != 0;
        }
        body(cell, hidden);
      }
    }
  }
}

} // namespace

void AddHiddenFlags(vtkDataSet* image, vtkBanyanDeferred::Handle& handle)
{
  const SeriesIndex& index = handle.Series->Index();
  vtkBanyanDeferred::Handle own = handle;
  own.Array = index.FindFlags(ArrayFlags::OfPoints);
  if (own.Array >= 0)
  {
    handle.Flags = Read(own);
    handle.FlagsTime = handle.Flags->GetMTime();
    image->GetPointData()->AddArray(handle.Flags);
  }
  own.Array = index.FindFlags(ArrayFlags::OfCells);
  if (own.Array >= 0)
  {
    // A cell has the place of its lowest corner.
    for (int axis = 0; axis < 3; ++axis)
    {
      own.Samples.Hi[axis] -= own.Samples.Size()[axis] > 1 ? 1 : 0;
    }
    const vtkSmartPointer<vtkUnsignedCharArray> cells = Read(own);
    bool follow = true;
    ForEachCell(handle.Samples.Size(), handle.Flags ? handle.Flags->GetPointer(0) : nullptr,
      [&](vtkIdType cell, bool hiddenCorner)
      {
        unsigned char& flag = *cells->GetPointer(cell);
        // Every second cell does not know of corners that the fine cell does not have.
        flag |= handle.Level > 0 && hiddenCorner ? vtkDataSetAttributes::HIDDENCELL : 0;
        follow = follow && (flag == 0 || hiddenCorner);
      });
    image->GetCellData()->AddArray(cells);
    if (follow)
    {
      handle.CellFlags = cells;
      handle.CellFlagsTime = cells->GetMTime();
    }
  }
}

} // namespace banyan
