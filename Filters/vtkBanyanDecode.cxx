// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBanyanDecode.h"

#include "vtkBanyanDeferred.h"

#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"

vtkStandardNewMacro(vtkBanyanDecode);

void vtkBanyanDecode::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

int vtkBanyanDecode::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet");
  return 1;
}

int vtkBanyanDecode::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->SetErrorCode(vtkErrorCode::NoError);
  vtkDataSet* input = vtkDataSet::GetData(inputs[0]);
  vtkDataSet* output = vtkDataSet::GetData(outputs);
  output->ShallowCopy(input);
  vtkPointData* from = input->GetPointData();
  vtkPointData* to = output->GetPointData();
  const int arrays = from->GetNumberOfArrays();
  for (int i = 0; i < arrays; ++i)
  {
    this->UpdateProgress(static_cast<double>(i) / arrays);
    vtkDataArray* array = from->GetArray(i);
    if (!array)
    {
      continue; // strings are never deferred
    }
    const vtkSmartPointer<vtkDataArray> plain = vtkBanyanDeferred::Plain(array);
    if (!plain)
    {
      this->SetErrorCode(vtkErrorCode::FileFormatError);
      output->Initialize();
      return 0;
    }
    if (plain == array)
    {
      continue;
    }
    // An array of a name that is there takes the place of the other, and its role.
    to->AddArray(plain);
  }
  return 1;
}
