// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBanyanSeriesWriter.h"

#include "SeriesWriting.h"
#include "WriterQuantizer.h"

#include "vtkCommand.h"
#include "vtkDataArraySelection.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"

#include "Base/InterruptSignals.h"
#include "Base/PropertyNumber.h"

#include "Base/Error.h"

#include <algorithm>
#include <csignal>

vtkStandardNewMacro(vtkBanyanSeriesWriter);

vtkBanyanSeriesWriter::vtkBanyanSeriesWriter()
  : Quantizer(std::make_unique<banyan::WriterQuantizer>())
{
  this->Controller = vtkMultiProcessController::GetGlobalController();
}

vtkBanyanSeriesWriter::~vtkBanyanSeriesWriter()
{
  delete[] this->FileName;
}

void vtkBanyanSeriesWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n"
     << indent << "ErrorBound: " << this->ErrorBound << "\n"
     << indent << "ErrorBoundMode: " << this->ErrorBoundMode << "\n"
     << indent << "KeyframeInterval: " << this->KeyframeInterval << "\n"
     << indent << "BrickCells: " << this->BrickCells << "\n"
     << indent << "ClosedGroups: " << this->ClosedGroups << "\n"
     << indent << "Profile: " << this->Profile << "\n"
     << indent << "DisplacementArray: " << this->DisplacementArray << "\n"
     << this->Quantizer->Text() << indent << "WriteTimeSteps: " << this->WriteTimeSteps << "\n"
     << indent << "PointArraySelection:\n";
  this->Selection->PrintSelf(os, indent.GetNextIndent());
  os << indent << "CellArraySelection:\n";
  this->CellSelection->PrintSelf(os, indent.GetNextIndent());
}

void vtkBanyanSeriesWriter::SetDisplacementArray(const char* name)
{
  const std::string array = name ? name : "";
  if (this->DisplacementArray != array)
  {
    this->DisplacementArray = array;
    this->Modified();
  }
}

void vtkBanyanSeriesWriter::SetTransform(int transform)
{
  if (this->Quantizer->Transform != transform)
  {
    this->Quantizer->Transform = std::min(std::max(transform, int{ UNIFORM }), int{ ADAPTIVE });
    this->Modified();
  }
}

int vtkBanyanSeriesWriter::GetTransform()
{
  return this->Quantizer->Transform;
}

void vtkBanyanSeriesWriter::SetAsinhScale(double scale)
{
  if (this->Quantizer->AsinhScale != scale)
  {
    this->Quantizer->AsinhScale = scale;
    this->Modified();
  }
}

double vtkBanyanSeriesWriter::GetAsinhScale()
{
  return this->Quantizer->AsinhScale;
}

void vtkBanyanSeriesWriter::AddTransformKnot(double value, double transformed)
{
  this->Quantizer->TransformTable.push_back(value);
  this->Quantizer->TransformTable.push_back(transformed);
  this->Modified();
}

void vtkBanyanSeriesWriter::RemoveAllTransformKnots()
{
  this->Quantizer->TransformTable.clear();
  this->Modified();
}

void vtkBanyanSeriesWriter::SetRangeMode(int mode)
{
  if (this->Quantizer->RangeMode != mode)
  {
    this->Quantizer->RangeMode = std::min(std::max(mode, int{ FROM_DATA }), int{ GIVEN });
    this->Modified();
  }
}

int vtkBanyanSeriesWriter::GetRangeMode()
{
  return this->Quantizer->RangeMode;
}

void vtkBanyanSeriesWriter::SetRangePercentiles(double low, double high)
{
  this->Quantizer->RangePercentiles[0] = low;
  this->Quantizer->RangePercentiles[1] = high;
  this->Modified();
}

void vtkBanyanSeriesWriter::SetRange(double low, double high)
{
  this->Quantizer->Range[0] = low;
  this->Quantizer->Range[1] = high;
  this->Modified();
}

void vtkBanyanSeriesWriter::SetClampOutside(bool clamp)
{
  if (this->Quantizer->ClampOutside != clamp)
  {
    this->Quantizer->ClampOutside = clamp;
    this->Modified();
  }
}

bool vtkBanyanSeriesWriter::GetClampOutside()
{
  return this->Quantizer->ClampOutside;
}

void vtkBanyanSeriesWriter::AddFillValue(double value)
{
  this->Quantizer->FillValues.push_back(value);
  this->Modified();
}

void vtkBanyanSeriesWriter::RemoveAllFillValues()
{
  this->Quantizer->FillValues.clear();
  this->Modified();
}

void vtkBanyanSeriesWriter::AddOpacityKnot(double value, double opacity)
{
  this->Quantizer->OpacityFunction.push_back(value);
  this->Quantizer->OpacityFunction.push_back(opacity);
  this->Modified();
}

void vtkBanyanSeriesWriter::RemoveAllOpacityKnots()
{
  this->Quantizer->OpacityFunction.clear();
  this->Modified();
}

int vtkBanyanSeriesWriter::FillInputPortInformation(int, vtkInformation* info)
{
  // Anything is let in, so that what does not fit is refused with a sentence of ours.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

vtkDataArraySelection* vtkBanyanSeriesWriter::GetPointArraySelection()
{
  return this->Selection;
}

vtkDataArraySelection* vtkBanyanSeriesWriter::GetCellArraySelection()
{
  return this->CellSelection;
}

void vtkBanyanSeriesWriter::SetController(vtkMultiProcessController* controller)
{
  this->Controller = controller;
}

vtkMultiProcessController* vtkBanyanSeriesWriter::GetController()
{
  return this->Controller;
}

int vtkBanyanSeriesWriter::Write()
{
  // The input is updated step by step, with the failure of any rank agreed upon by all: so not
  // through this object's own executive, which would leave the other ranks waiting.
  this->InvokeEvent(vtkCommand::StartEvent, nullptr);
  this->WriteSeries();
  this->InvokeEvent(vtkCommand::EndEvent, nullptr);
  return this->GetErrorCode() == vtkErrorCode::NoError;
}

void vtkBanyanSeriesWriter::WriteData()
{
  this->WriteSeries();
}

void vtkBanyanSeriesWriter::WriteSeries()
{
  this->SetErrorCode(vtkErrorCode::NoError);
  this->SetAbortExecute(0);
  this->ErrorMessage.clear();

  banyan::WritingOrder order;
  order.FileName = this->FileName ? this->FileName : "";
  order.Options.ErrorBound = this->ErrorBound;
  order.Options.Mode = this->ErrorBoundMode == ABSOLUTE
                         ? banyan::ErrorBoundMode::Absolute
                         : banyan::ErrorBoundMode::RelativeToSeriesRange;
  order.Options.KeyframeInterval = this->KeyframeInterval;
  order.Options.BrickCells = this->BrickCells;
  order.Options.ClosedGroups = this->ClosedGroups;
  order.Options.Profile = static_cast<banyan::EncodeProfile>(this->Profile);
  if (this->GetNumberOfInputConnections(0) > 0)
  {
    order.Producer = this->GetInputAlgorithm(0, 0, order.Port);
  }
  order.Selection = this->Selection;
  order.CellSelection = this->CellSelection;
  order.Displacements = this->DisplacementArray;
  order.AllSteps = this->WriteTimeSteps;
  order.Controller = this->Controller;
  order.Progress = [this](double value) { this->UpdateProgress(value); };
  order.Aborted = [this]
  { return this->GetAbortExecute() != 0 || banyan::InterruptSignals::Came(); };
  order.Warn = [this](const std::string& sentence) { vtkWarningMacro(<< sentence); };
  try
  {
    banyan::RequireNumber("ErrorBound", this->ErrorBound);
    order.Options.Quantizer = this->Quantizer->Options();
  }
  catch (const banyan::Error& error)
  {
    // The same on all ranks, which have the same properties.
    this->Fail((order.FileName.empty() ? "The series" : order.FileName) + " was not written. " +
               error.what());
    return;
  }
  int signal = 0;
  {
    const banyan::InterruptSignals signals;
    this->Run(order);
    signal = signals.Last();
  }
  if (signal != 0)
  {
    // The files are in order: now it may do what it does without us.
    (void)std::raise(signal);
  }
}

void vtkBanyanSeriesWriter::Run(const banyan::WritingOrder& order)
{
  banyan::SeriesWriting writing(order);
  try
  {
    writing.Run();
    this->UpdateProgress(1.0);
    this->WriteTime.Modified();
  }
  catch (const std::exception& error)
  {
    this->SetErrorCode(
      order.FileName.empty() ? vtkErrorCode::NoFileNameError : vtkErrorCode::UserError);
    this->ErrorMessage = (order.FileName.empty() ? "The series" : order.FileName) +
                         " was not written. " + error.what();
    if (writing.StepsKept() > 0)
    {
      this->ErrorMessage = order.FileName + " holds the first " +
                           std::to_string(writing.StepsKept()) + " steps only. " + error.what();
    }
    this->Fail(this->ErrorMessage);
  }
}

void vtkBanyanSeriesWriter::Fail(const std::string& sentence)
{
  if (this->GetErrorCode() == vtkErrorCode::NoError)
  {
    this->SetErrorCode(vtkErrorCode::UserError);
  }
  this->ErrorMessage = sentence;
  // All ranks have the same sentence; one of them says it.
  if (!this->Controller || this->Controller->GetLocalProcessId() == 0)
  {
    vtkErrorMacro(<< this->ErrorMessage);
  }
}
