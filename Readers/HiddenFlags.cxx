#include "HiddenFlags.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include "Series/SeriesFile.h"

namespace banyan
{
namespace
{

vtkSmartPointer<vtkUnsignedCharArray> Read(const vtkBanyanDeferred::Handle& handle)
{
  const vtkSmartPointer<vtkDataArray> array = vtkBanyanDeferred::NewPlain(handle);
  array->SetName(vtkDataSetAttributes::GhostArrayName());
  return vtkUnsignedCharArray::SafeDownCast(array);
}

/// What subsampling leaves of cells does not know of corners that the fine cell does not have.
void HideCellsOfHiddenCorners(
  vtkImageData* image, vtkUnsignedCharArray* points, vtkUnsignedCharArray* cells)
{
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < cells->GetNumberOfTuples(); ++cell)
  {
    image->GetCellPoints(cell, corners);
    for (vtkIdType corner = 0; corner < corners->GetNumberOfIds(); ++corner)
    {
      if (points->GetValue(corners->GetId(corner)) != 0)
      {
        cells->SetValue(cell, cells->GetValue(cell) | vtkDataSetAttributes::HIDDENCELL);
      }
    }
  }
}

} // namespace

void AddHiddenFlags(vtkImageData* image, vtkBanyanDeferred::Handle& handle)
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
    if (handle.Level > 0 && handle.Flags)
    {
      HideCellsOfHiddenCorners(image, handle.Flags, cells);
    }
    image->GetCellData()->AddArray(cells);
  }
}

} // namespace banyan
