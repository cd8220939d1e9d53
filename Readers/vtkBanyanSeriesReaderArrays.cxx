// SPDX-License-Identifier: BSD-3-Clause
// Arrays of image data: for whom they decode on first touch, and for whom they are plain.
#include "DeferredConsumers.h"
#include "SeriesReaderInternals.h"
#include "vtkBanyanDeferred.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkPointData.h"

#include <algorithm>

int vtkBanyanSeriesReader::ComputePipelineMTime(
  vtkInformation*, vtkInformationVector**, vtkInformationVector*, int, vtkMTimeType* mtime)
{
  // Nobody tells the reader that somebody was connected, so it looks before each update.
  if (this->Self->GaveDeferred && !banyan::ConsumersReadDeferred(*this))
  {
    this->Self->GaveDeferred = false;
    this->Self->PlainWanted.Modified();
    auto* const image = vtkImageData::SafeDownCast(this->GetOutputDataObject(0));
    for (int i = 0; image && i < image->GetPointData()->GetNumberOfArrays(); ++i)
    {
      this->Self->Replaced.emplace_back(image->GetPointData()->GetArray(i));
      vtkBanyanDeferred::Supersede(this->Self->Replaced.back());
    }
  }
  *mtime = std::max(this->GetMTime(), this->Self->PlainWanted.GetMTime());
  return 1;
}

/// To be called by all ranks, with or without a piece: they execute again together, or not.
void vtkBanyanSeriesReader::DecideOnDeferring()
{
  if (this->Self->PlainWanted < this->Self->Executed)
  {
    this->Self->Replaced.clear();
  }
  this->Self->Executed.Modified();
  this->Self->GaveDeferred =
    this->DeferDecoding && !this->IsMesh() && banyan::ConsumersReadDeferred(*this);
}

void vtkBanyanSeriesReader::AddImageArrays(vtkBanyanDeferred::Handle handle, vtkPointData* output)
{
  const banyan::SeriesFile& series = *this->Self->Series;
  const banyan::SeriesIndex& index = series.Index();
  const bool defer = this->Self->GaveDeferred && !handle.Samples.Empty();
  const auto newArray = defer                 ? &vtkBanyanDeferred::New
                        : this->DeferDecoding ? &vtkBanyanDeferred::NewDecoded
                                              : &vtkBanyanDeferred::NewPlain;
  const int arrays = static_cast<int>(index.Arrays.size());
  for (handle.Array = 0; handle.Array < arrays; ++handle.Array)
  {
    this->UpdateProgress(static_cast<double>(handle.Array) / arrays);
    const banyan::ArrayIndex& array = index.Arrays[handle.Array];
    if (!this->Self->Wants(array))
    {
      continue;
    }
    const int components = static_cast<int>(array.Components.size());
    for (int component = 0; defer && component < components; ++component)
    {
      this->Self->Verified.Verify(
        series, { handle.Step, handle.Array, component, handle.Level }, handle.Samples);
    }
    output->AddArray(newArray(handle));
  }
  if (output->HasArray(index.ActiveScalars.c_str()))
  {
    output->SetActiveScalars(index.ActiveScalars.c_str());
  }
}
