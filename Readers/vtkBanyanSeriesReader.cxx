// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBanyanSeriesReader.h"

#include "DeferredConsumers.h"
#include "GridOutput.h"
#include "ImageOutput.h"
#include "MeshOutput.h"
#include "SeriesInformation.h"
#include "SeriesOfRanks.h"
#include "vtkBanyanDeferred.h"

#include "vtkDataArray.h"
#include "vtkDataArraySelection.h"
#include "vtkDataObjectTypes.h"
#include "vtkDataSet.h"
#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTimeStamp.h"

#include "Base/Timer.h"
#include "Cache/BrickCache.h"
#include "Parallel/Communicate/Collective.h"
#include "Series/Decode/SeriesFile.h"

#include <algorithm>
#include <string>
#include <vector>

using Pipeline = vtkStreamingDemandDrivenPipeline;

struct vtkBanyanSeriesReader::Internals
{
  banyan::SeriesOfRanks File;
  banyan::ImageOutput Image;
  banyan::MeshOutput Mesh;
  banyan::GridOutput Grid;
  double LoadSeconds = 0;                      ///< of the last update
  vtkNew<vtkDataArraySelection> Selection;     ///< of point arrays
  vtkNew<vtkDataArraySelection> CellSelection; ///< of cell arrays of meshes
  std::string ErrorMessage;
  std::string Contents; ///< what GetContents() has returned
  banyan::HeldArrays Held;
  bool GaveDeferred = false; ///< whether the output has arrays that decode on first touch
  vtkTimeStamp PlainWanted;  ///< when somebody came who needs plain ones instead
  vtkTimeStamp Executed;
  /// Arrays that plain ones have replaced: ParaView's 2D histogram keeps pointers to arrays that it
  /// saw before the update.
  std::vector<vtkSmartPointer<vtkDataArray>> Replaced;

  /// Whether an array of the series is to be read.
  bool Wants(const banyan::ArrayIndex& array) const
  {
    return array.Flags != banyan::ArrayFlags::None ? false
           : array.CellArray.empty()
             ? this->Selection->ArrayIsEnabled(array.Name.c_str()) != 0
             : this->CellSelection->ArrayIsEnabled(array.CellArray.c_str()) != 0;
  }
};

vtkStandardNewMacro(vtkBanyanSeriesReader);

vtkBanyanSeriesReader::vtkBanyanSeriesReader()
  : Self(new Internals)
{
  this->SetNumberOfInputPorts(0);
}

vtkBanyanSeriesReader::~vtkBanyanSeriesReader()
{
  delete[] this->FileName;
}

void vtkBanyanSeriesReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n"
     << indent << "Level: " << this->Level << "\n"
     << indent << "MeshAsHyperTreeGrid: " << this->MeshAsHyperTreeGrid << "\n"
     << indent << "DeferDecoding: " << this->DeferDecoding << "\n"
     << indent << "ReadAhead: " << this->ReadAhead << "\n"
     << indent << "InterpolateInTime: " << this->InterpolateInTime << "\n"
     << indent << "CacheBudget: " << this->CacheBudget << "\n"
     << indent << "Steps: " << (this->Series() ? this->Series()->Index().Steps() : 0) << "\n";
  os << indent << "PointArraySelection:\n";
  this->Self->Selection->PrintSelf(os, indent.GetNextIndent());
  os << indent << "CellArraySelection:\n";
  this->Self->CellSelection->PrintSelf(os, indent.GetNextIndent());
}

int vtkBanyanSeriesReader::CanReadFile(const char* fileName)
{
  return banyan::LooksAsSeries(fileName ? fileName : "") ? 1 : 0;
}

int vtkBanyanSeriesReader::GetNumberOfLevels()
{
  if (this->IsMesh())
  {
    try
    {
      return this->Self->Mesh.Levels();
    }
    catch (const std::exception&)
    {
      return 1; // the update says what is wrong
    }
  }
  return this->Series() ? this->Series()->Index().Levels : 0;
}

void vtkBanyanSeriesReader::SetCacheBudget(int mebibytes)
{
  if (mebibytes < -1)
  {
    vtkErrorMacro(
      << "'Cache Budget' (CacheBudget) must be a number of MiB, or -1 to share that of the process, "
         "and is "
      << mebibytes << ". It stays " << this->CacheBudget << ".");
    return;
  }
  if (this->CacheBudget != mebibytes)
  {
    this->CacheBudget = mebibytes;
    this->Modified(); // the series is opened again, with these caches
  }
}

vtkDataArraySelection* vtkBanyanSeriesReader::GetPointArraySelection()
{
  return this->Self->Selection;
}

vtkDataArraySelection* vtkBanyanSeriesReader::GetCellArraySelection()
{
  return this->Self->CellSelection;
}

int vtkBanyanSeriesReader::GetNumberOfPointArrays()
{
  return this->Self->Selection->GetNumberOfArrays();
}

const char* vtkBanyanSeriesReader::GetPointArrayName(int index)
{
  return this->Self->Selection->GetArrayName(index);
}

int vtkBanyanSeriesReader::GetPointArrayStatus(const char* name)
{
  return this->Self->Selection->ArrayIsEnabled(name);
}

void vtkBanyanSeriesReader::SetPointArrayStatus(const char* name, int status)
{
  this->Self->Selection->SetArraySetting(name, status);
}

void vtkBanyanSeriesReader::Refresh()
{
  this->Self->File.OpenAgain();
  this->Modified();
}

void vtkBanyanSeriesReader::SetController(vtkMultiProcessController* controller)
{
  this->Self->File.SetController(controller);
}

vtkMultiProcessController* vtkBanyanSeriesReader::GetController()
{
  return this->Self->File.Controller();
}

const char* vtkBanyanSeriesReader::GetContents()
{
  const banyan::SeriesFile* const series = this->Series();
  this->Self->Contents = series ? banyan::SummaryOf(series->Index()) : "";
  return this->Self->Contents.c_str();
}

const char* vtkBanyanSeriesReader::GetErrorMessage()
{
  return this->Self->ErrorMessage.c_str();
}

vtkIdType vtkBanyanSeriesReader::GetBricksReadAhead()
{
  const banyan::SeriesFile* const series = this->Series();
  return series ? static_cast<vtkIdType>(banyan::BrickCache::Of(*series).GetAheadStatistics().Hits)
                : 0;
}

/// For CacheContext::WithBudget.
std::int64_t vtkBanyanSeriesReader::CacheBytes() const
{
  return this->CacheBudget < 0 ? -1 : std::int64_t{ this->CacheBudget } << 20;
}

double vtkBanyanSeriesReader::GetLoadSeconds()
{
  return this->Self->LoadSeconds;
}

vtkIdType vtkBanyanSeriesReader::GetBricksDecoded()
{
  return this->Series() ? static_cast<vtkIdType>(this->Series()->BricksDecoded()) : 0;
}

vtkMTimeType vtkBanyanSeriesReader::GetMTime()
{
  return std::max({ this->Superclass::GetMTime(), this->Self->Selection->GetMTime(),
    this->Self->CellSelection->GetMTime() });
}

//--------------------------------------------------------------------------------------------------
// Opening

const banyan::SeriesFile* vtkBanyanSeriesReader::Series() const
{
  return this->Self->File.Series().get();
}

bool vtkBanyanSeriesReader::IsMesh() const
{
  return this->Series() && this->Series()->Index().Mesh;
}

bool vtkBanyanSeriesReader::IsImage() const
{
  return this->Series() && !this->Series()->Index().Mesh && !this->Series()->Index().Points;
}

int vtkBanyanSeriesReader::UsedLevel() const
{
  return std::min(this->Level, this->Series()->Index().Levels - 1);
}

void vtkBanyanSeriesReader::Fail(unsigned long code, const std::string& sentence)
{
  this->SetErrorCode(code);
  this->Self->ErrorMessage = sentence;
  // All ranks have the same sentence; one of them says it.
  if (this->Self->File.Ranks().Rank() == 0)
  {
    vtkErrorMacro(<< sentence);
  }
}

void vtkBanyanSeriesReader::Clear()
{
  this->SetErrorCode(vtkErrorCode::NoError);
  this->Self->ErrorMessage.clear();
}

bool vtkBanyanSeriesReader::OpenOnAllRanks()
{
  const std::shared_ptr<const banyan::SeriesFile> before = this->Self->File.Series();
  const bool named = this->FileName && *this->FileName;
  try
  {
    this->Self->File.Open(this->FileName, this->CacheBytes());
  }
  catch (const std::exception& error)
  {
    this->Fail(
      named ? vtkErrorCode::CannotOpenFileError : vtkErrorCode::NoFileNameError, error.what());
    return false;
  }
  if (this->Self->File.Series() != before)
  {
    this->Self->Mesh.Open(this->Self->File.Series());
    this->Self->Grid.Forget();
  }
  return true;
}

//--------------------------------------------------------------------------------------------------
// Information

int vtkBanyanSeriesReader::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkDataObject");
  return 1;
}

vtkTypeBool vtkBanyanSeriesReader::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  if (request->Has(Pipeline::REQUEST_DATA_OBJECT()))
  {
    return this->MakeOutput(outputs);
  }
  return this->Superclass::ProcessRequest(request, inputs, outputs);
}

/// An output of the type that the series is of; an image where it cannot be opened.
int vtkBanyanSeriesReader::MakeOutput(vtkInformationVector* outputs)
{
  bool open = true;
  if (!this->Self->File.IsOpen(this->FileName, this->CacheBytes()))
  {
    this->Clear();
    open = this->OpenOnAllRanks();
  }
  vtkInformation* const info = outputs->GetInformationObject(0);
  const int type = banyan::OutputTypeOf(this->Series(), this->MeshAsHyperTreeGrid);
  vtkDataObject* const now = info->Get(vtkDataObject::DATA_OBJECT());
  if (!now || now->GetDataObjectType() != type)
  {
    vtkSmartPointer<vtkDataObject> output;
    output.TakeReference(vtkDataObjectTypes::NewDataObject(type));
    info->Set(vtkDataObject::DATA_OBJECT(), output);
  }
  return open ? 1 : 0;
}

int vtkBanyanSeriesReader::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  this->Clear();
  if (!this->OpenOnAllRanks())
  {
    return 0;
  }
  for (const banyan::ArrayIndex& array : this->Series()->Index().Arrays)
  {
    if (array.Flags == banyan::ArrayFlags::None) // these come with whatever is chosen
    {
      const bool ofCells = !array.CellArray.empty();
      (ofCells ? this->Self->CellSelection : this->Self->Selection)
        ->AddArray((ofCells ? array.CellArray : array.Name).c_str());
    }
  }
  banyan::DescribeSeries(
    this->Series()->Index(), this->UsedLevel(), *outputs->GetInformationObject(0));
  return 1;
}

//--------------------------------------------------------------------------------------------------
// Data

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
    this->DeferDecoding && this->IsImage() && banyan::ConsumersReadDeferred(*this);
}

int vtkBanyanSeriesReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  if (!this->Series())
  {
    // All ranks know that it could not be opened; but not all of them come here, because nobody
    // told the pipeline that there are pieces. So there is nothing to agree on.
    return 0;
  }
  this->Clear();
  const banyan::Timer timer;
  vtkInformation* outInfo = outputs->GetInformationObject(0);
  vtkDataObject* output = outInfo->Get(vtkDataObject::DATA_OBJECT());
  // The pipeline keeps the scalars of the step before, for those who write into the same memory.
  output->Initialize();
  // No filter is at work now: the time to let go what was decoded for others.
  this->DecideOnDeferring();
  vtkBanyanDeferred::ReleaseBeyondBudgets();
  std::string failure;
  banyan::Attempt(
    failure, [&] { this->FillOutput(outInfo, output); },
    "there is not enough memory for the piece. Raise 'Level', read fewer arrays, or use more "
    "ranks.");
  this->Self->LoadSeconds = timer.Seconds();
  if (!failure.empty())
  {
    failure.insert(0, std::string("The data of ") + this->FileName + " cannot be read: ");
  }
  try
  {
    banyan::ThrowTogether(this->Self->File.Ranks(), failure);
    return 1;
  }
  catch (const std::exception& error)
  {
    this->Fail(vtkErrorCode::FileFormatError, error.what());
    output->Initialize();
    return 0;
  }
}

/// @param info where the pipeline says what it wants
void vtkBanyanSeriesReader::FillOutput(vtkInformation* info, vtkDataObject* output)
{
  banyan::StepRequest request;
  request.Series = this->Self->File.Series();
  banyan::TakeTime(this->Series()->Index(), *info, this->InterpolateInTime, request);
  request.Wants = [this](const banyan::ArrayIndex& array) { return this->Self->Wants(array); };
  this->Self->Held.Warn(*this, request, this->Self->File.Ranks());
  request.Progress = [this](double part) { this->UpdateProgress(part); };
  if (this->IsMesh())
  {
    request.Level = this->Level;
    banyan::TakePiece(*info, request);
    this->Self->Mesh.Fill(request, this->ReadAhead, output);
    return;
  }
  request.Level = this->UsedLevel();
  const banyan::Box wanted = banyan::FromExtent(info->Get(Pipeline::UPDATE_EXTENT()));
  if (!this->IsImage())
  {
    this->Self->Grid.Fill(request, wanted, vtkDataSet::SafeDownCast(output));
    return;
  }
  const banyan::ArrayForm form = this->Self->GaveDeferred ? banyan::ArrayForm::Deferred
                                 : this->DeferDecoding    ? banyan::ArrayForm::Decoded
                                                          : banyan::ArrayForm::Plain;
  this->Self->Image.Fill(request, wanted, info->Get(vtkDataObject::DIRECTION()), form,
    vtkImageData::SafeDownCast(output));
}
