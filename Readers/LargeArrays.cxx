// SPDX-License-Identifier: BSD-3-Clause
#include "LargeArrays.h"

#include "Base/LargePages.h"

#include "vtkDataArray.h"

namespace banyan
{

void SetTuples(vtkDataArray* array, vtkIdType tuples)
{
  const vtkIdType values = tuples * array->GetNumberOfComponents();
  const std::size_t bytes =
    static_cast<std::size_t>(values) * static_cast<std::size_t>(array->GetDataTypeSize());
  if (bytes < LargePages::PageBytes)
  {
    array->SetNumberOfTuples(tuples);
    return;
  }
  array->SetVoidArray(
    LargePages::Allocate(bytes), values, 0, vtkAbstractArray::VTK_DATA_ARRAY_USER_DEFINED);
  array->SetArrayFreeFunction(LargePages::Free);
}

} // namespace banyan
