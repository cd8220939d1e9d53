// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBanyanSeriesReader.h"

#include "HiddenFlags.h"
#include "SeriesInformation.h"
#include "SeriesReaderInternals.h"
#include "vtkBanyanDeferred.h"

#include "vtkDataArray.h"
#include "vtkDataArraySelection.h"
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

#include "Base/Timer.h"
#include "Cache/BrickCache.h"
#include "Series/Decode/SeriesFile.h"
#include "Series/Format/IndexText.h"
#include "Series/Grid/LevelGrid.h"

#include <algorithm>
#include <new>
#include <sstream>

using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkStandardNewMacro(vtkBanyanSeriesReader);

vtkBanyanSeriesReader::vtkBanyanSeriesReader()
  : Self(new Internals)
{
  this->SetNumberOfInputPorts(0);
  this->Self->Controller = vtkMultiProcessController::GetGlobalController();
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
     << indent << "CacheBudget: " << this->CacheBudget << "\n"
     << indent << "Steps: " << (this->Self->Series ? this->Self->Series->Index().Steps() : 0)
     << "\n";
  os << indent << "PointArraySelection:\n";
  this->Self->Selection->PrintSelf(os, indent.GetNextIndent());
  os << indent << "CellArraySelection:\n";
  this->Self->CellSelection->PrintSelf(os, indent.GetNextIndent());
}

int vtkBanyanSeriesReader::CanReadFile(const char* fileName)
{
  const std::string path = fileName ? fileName : "";
  const auto endsWith = [&path](const std::string& suffix)
  {
    return path.size() > suffix.size() &&
           path.compare(path.size() - suffix.size(), suffix.size(), suffix) == 0;
  };
  return endsWith(".banyan") || endsWith(".banyan.d") || banyan::BeginsAsSeries(path) ? 1 : 0;
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
  return this->Self->Series ? this->Self->Series->Index().Levels : 0;
}

void vtkBanyanSeriesReader::SetCacheBudget(int mebibytes)
{
  if (mebibytes < -1)
  {
    vtkErrorMacro(
      << "'Cache Budget' (CacheBudget) must be a number of MiB, or -1 for that of the process, "
         "and is "
      << mebibytes << ". It stays " << this->CacheBudget << ".");
    return;
  }
  if (mebibytes >= 0)
  {
    banyan::BrickCache::Process().SetBudget(static_cast<std::uint64_t>(mebibytes) << 20);
  }
  if (this->CacheBudget != mebibytes)
  {
    // No Modified(): the output does not depend on it.
    this->CacheBudget = mebibytes;
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
  this->Self->Reopen = true;
  this->Modified();
}

void vtkBanyanSeriesReader::SetController(vtkMultiProcessController* controller)
{
  this->Self->Controller = controller;
}

vtkMultiProcessController* vtkBanyanSeriesReader::GetController()
{
  return this->Self->Controller;
}

const char* vtkBanyanSeriesReader::GetErrorMessage()
{
  return this->Self->ErrorMessage.c_str();
}

vtkMTimeType vtkBanyanSeriesReader::GetMTime()
{
  return std::max({ this->Superclass::GetMTime(), this->Self->Selection->GetMTime(),
    this->Self->CellSelection->GetMTime() });
}

//--------------------------------------------------------------------------------------------------
// Opening

std::string vtkBanyanSeriesReader::Place() const
{
  std::ostringstream text;
  text << (this->FileName ? this->FileName : "(no file name)");
  const vtkMultiProcessController* controller = this->Self->Controller;
  if (controller && this->Self->Controller->GetNumberOfProcesses() > 1)
  {
    text << " (rank " << this->Self->Controller->GetLocalProcessId() << ")";
  }
  return text.str();
}

void vtkBanyanSeriesReader::Fail(unsigned long code, const std::string& sentence)
{
  this->SetErrorCode(code);
  this->Self->ErrorMessage = sentence;
  vtkErrorMacro(<< sentence);
}

void vtkBanyanSeriesReader::Clear()
{
  this->SetErrorCode(vtkErrorCode::NoError);
  this->Self->ErrorMessage.clear();
}

bool vtkBanyanSeriesReader::AllRanksAreWell(unsigned long code, const std::string& problem)
{
  vtkMultiProcessController* controller = this->Self->Controller;
  const int failing = problem.empty() ? 0 : 1;
  int failingRanks = failing;
  if (controller && controller->GetNumberOfProcesses() > 1)
  {
    controller->AllReduce(&failing, &failingRanks, 1, vtkCommunicator::SUM_OP);
  }
  if (failing)
  {
    this->Fail(code, problem);
  }
  else if (failingRanks > 0)
  {
    this->Fail(vtkErrorCode::UserError,
      this->Place() + " could be read here, but not on " + std::to_string(failingRanks) +
        " other rank(s), so no rank reads it: see their messages.");
  }
  return failingRanks == 0;
}

//--------------------------------------------------------------------------------------------------
// Information

int vtkBanyanSeriesReader::UsedLevel() const
{
  return std::min(this->Level, this->Self->Series->Index().Levels - 1);
}

int vtkBanyanSeriesReader::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  this->Clear();
  if (!this->OpenOnAllRanks())
  {
    return 0;
  }
  for (const banyan::ArrayIndex& array : this->Self->Series->Index().Arrays)
  {
    if (array.Flags == banyan::ArrayFlags::None) // these come with whatever is chosen
    {
      const bool ofCells = !array.CellArray.empty();
      (ofCells ? this->Self->CellSelection : this->Self->Selection)
        ->AddArray((ofCells ? array.CellArray : array.Name).c_str());
    }
  }
  banyan::DescribeSeries(
    this->Self->Series->Index(), this->UsedLevel(), *outputs->GetInformationObject(0));
  return 1;
}

//--------------------------------------------------------------------------------------------------
// Data

int vtkBanyanSeriesReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  if (!this->Self->Series)
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
  vtkBanyanDeferred::ReleaseDownTo(banyan::BrickCache::Process().Budget());
  unsigned long code = vtkErrorCode::NoError;
  const std::string problem = this->TryToFill(outInfo, code);
  this->Self->LoadSeconds = timer.Seconds();
  if (!this->AllRanksAreWell(code, problem))
  {
    output->Initialize();
    return 0;
  }
  return 1;
}

std::string vtkBanyanSeriesReader::TryToFill(vtkInformation* outInfo, unsigned long& code)
{
  try
  {
    code = vtkErrorCode::FileFormatError;
    if (this->IsMesh())
    {
      this->FillMesh(outInfo);
    }
    else
    {
      this->FillOutput(outInfo);
    }
    return {};
  }
  catch (const std::bad_alloc&)
  {
    code = vtkErrorCode::UnknownError;
    return "There is no memory for the piece of " + this->Place() +
           ": raise 'Level', read fewer arrays, or use more ranks.";
  }
  catch (const std::exception& error)
  {
    return "The data of " + this->Place() + " cannot be read: " + error.what();
  }
}

void vtkBanyanSeriesReader::FillOutput(vtkInformation* outInfo)
{
  const banyan::SeriesFile& series = *this->Self->Series;
  const banyan::SeriesIndex& index = series.Index();
  vtkBanyanDeferred::Handle handle;
  handle.Series = this->Self->Series;
  handle.Step = banyan::StepAt(index, *outInfo);
  handle.Level = this->UsedLevel();

  const banyan::Grid grid = banyan::GridOfLevel(index.Domain, handle.Level);
  const banyan::Box wanted =
    Intersection(banyan::FromExtent(outInfo->Get(Pipeline::UPDATE_EXTENT())), grid.Extent);
  if (!wanted.Empty())
  {
    handle.Samples = { wanted.Lo - grid.Extent.Lo, wanted.Hi - grid.Extent.Lo };
  }
  int extent[6] = { 0, -1, 0, -1, 0, -1 };
  if (!wanted.Empty())
  {
    banyan::ToExtent(wanted, extent);
  }
  vtkImageData* output = vtkImageData::GetData(outInfo);
  output->SetExtent(extent);
  output->SetOrigin(&grid.Origin[0]);
  output->SetSpacing(&grid.Spacing[0]);
  output->SetDirectionMatrix(outInfo->Get(vtkDataObject::DIRECTION()));
  output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), index.Times[handle.Step]);

  if (!wanted.Empty())
  {
    banyan::AddHiddenFlags(output, handle);
  }
  this->AddImageArrays(handle, output->GetPointData());
  this->UpdateProgress(1.0);
}
