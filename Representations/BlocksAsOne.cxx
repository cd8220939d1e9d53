#include "BlocksAsOne.h"

#include "MotionEnhancement.h"
#include "StepWindow.h"
#include "vtkBanyanDeferred.h"

#include "vtkAppendFilter.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnstructuredGrid.h"

namespace banyan
{

vtkSmartPointer<vtkDataSet> BlocksAsOne(vtkDataObject* data)
{
  vtkCompositeDataSet* const blocks = vtkCompositeDataSet::SafeDownCast(data);
  if (!blocks)
  {
    return vtkDataSet::SafeDownCast(data);
  }
  vtkNew<vtkAppendFilter> append;
  const auto visit = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
  for (visit->InitTraversal(); !visit->IsDoneWithTraversal(); visit->GoToNextItem())
  {
    vtkDataSet* const block = vtkDataSet::SafeDownCast(visit->GetCurrentDataObject());
    if (block && block->GetNumberOfPoints() > 0)
    {
      append->AddInputData(block);
    }
  }
  if (append->GetNumberOfInputConnections(0) == 0)
  {
    return nullptr;
  }
  append->Update();
  return append->GetOutput();
}

void AddNeighbours(vtkDataArray* array, const StepWindow& steps, vtkDataSet* piece)
{
  vtkImageData* const image = vtkImageData::SafeDownCast(piece);
  const vtkBanyanDeferred::Handle* const handle = array ? vtkBanyanDeferred::From(array) : nullptr;
  const bool fromSeries = handle && image && vtkBanyanDeferred::LiesOnSeries(image, *handle);
  if (!array || !array->GetName() || fromSeries)
  {
    return;
  }
  const auto add = [&](vtkDataObject* step, const char* name)
  {
    const vtkSmartPointer<vtkDataSet> data = BlocksAsOne(step);
    vtkDataArray* const there = data ? data->GetPointData()->GetArray(array->GetName()) : nullptr;
    if (there)
    {
      const auto renamed = vtkSmartPointer<vtkDataArray>::Take(there->NewInstance());
      renamed->ShallowCopy(there);
      renamed->SetName(name);
      piece->GetPointData()->AddArray(renamed);
    }
  };
  add(steps.Previous(), MotionEnhancement::PreviousName());
  add(steps.Next(), MotionEnhancement::NextName());
}

} // namespace banyan
