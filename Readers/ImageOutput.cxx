// SPDX-License-Identifier: BSD-3-Clause
#include "ImageOutput.h"

#include "HiddenFlags.h"
#include "SeriesInformation.h"

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include "Series/Decode/BetweenSteps.h"
#include "Series/Decode/SeriesFile.h"
#include "Series/Grid/LevelGrid.h"

namespace banyan
{

void ImageOutput::Fill(const StepRequest& request, const Box& wanted, const double* direction,
  ArrayForm form, vtkImageData* output)
{
  const SeriesIndex& index = request.Series->Index();
  vtkBanyanDeferred::Handle handle;
  handle.Series = request.Series;
  handle.Step = request.Step;
  handle.Fraction = request.Fraction;
  handle.Level = request.Level;
  const Grid grid = GridOfLevel(index.Domain, request.Level);
  const Box piece = Intersection(wanted, grid.Extent);
  int extent[6] = { 0, -1, 0, -1, 0, -1 };
  if (!piece.Empty())
  {
    handle.Samples = { piece.Lo - grid.Extent.Lo, piece.Hi - grid.Extent.Lo };
    ToExtent(piece, extent);
  }
  output->SetExtent(extent);
  output->SetOrigin(&grid.Origin[0]);
  output->SetSpacing(&grid.Spacing[0]);
  output->SetDirectionMatrix(direction);
  output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), request.Time);
  if (!piece.Empty())
  {
    AddHiddenFlags(output, handle);
  }
  const bool nothing = piece.Empty() && form == ArrayForm::Deferred;
  this->AddArrays(request, handle, nothing ? ArrayForm::Decoded : form, output->GetPointData());
}

void ImageOutput::AddArrays(const StepRequest& request, vtkBanyanDeferred::Handle handle,
  ArrayForm form, vtkPointData* output)
{
  const SeriesIndex& index = request.Series->Index();
  const auto newArray = form == ArrayForm::Deferred  ? &vtkBanyanDeferred::New
                        : form == ArrayForm::Decoded ? &vtkBanyanDeferred::NewDecoded
                                                     : &vtkBanyanDeferred::NewPlain;
  const int arrays = static_cast<int>(index.Arrays.size());
  for (handle.Array = 0; handle.Array < arrays; ++handle.Array)
  {
    request.Progress(static_cast<double>(handle.Array) / arrays);
    const ArrayIndex& array = index.Arrays[handle.Array];
    if (!request.Wants(array))
    {
      continue;
    }
    const bool held = request.Fraction > 0.0 && !AreInterpolated(array.Type);
    handle.Fraction = held ? 0.0 : request.Fraction;
    if (held && handle.Flags)
    {
      // Points that the next step hides are hidden, too, and the file does not say so of this one.
      const vtkSmartPointer<vtkDataArray> plain = vtkBanyanDeferred::NewPlain(handle);
      DescribeRange(*request.Series, handle.Array, handle.Flags, *plain);
      output->AddArray(plain);
      continue;
    }
    const int components = static_cast<int>(array.Components.size());
    for (int component = 0; form == ArrayForm::Deferred && component < components; ++component)
    {
      FieldKey field{ handle.Step, handle.Array, component, handle.Level };
      this->Verified.Verify(*request.Series, field, handle.Samples);
      if (handle.Fraction > 0.0)
      {
        ++field.Step;
        this->VerifiedNext.Verify(*request.Series, field, handle.Samples);
      }
    }
    output->AddArray(newArray(handle));
  }
  if (output->HasArray(index.ActiveScalars.c_str()))
  {
    output->SetActiveScalars(index.ActiveScalars.c_str());
  }
  request.Progress(1.0);
}

} // namespace banyan
