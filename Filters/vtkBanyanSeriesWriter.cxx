#include "vtkBanyanSeriesWriter.h"

#include "SeriesWriting.h"

#include "vtkCommand.h"
#include "vtkDataArraySelection.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"

#include "Base/InterruptSignals.h"

#include <csignal>

vtkStandardNewMacro(vtkBanyanSeriesWriter);

vtkBanyanSeriesWriter::vtkBanyanSeriesWriter()
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
     << indent << "WriteTimeSteps: " << this->WriteTimeSteps << "\n"
     << indent << "PointArraySelection:\n";
  this->Selection->PrintSelf(os, indent.GetNextIndent());
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
  if (this->GetNumberOfInputConnections(0) > 0)
  {
    order.Producer = this->GetInputAlgorithm(0, 0, order.Port);
  }
  order.Selection = this->Selection;
  order.AllSteps = this->WriteTimeSteps;
  order.Controller = this->Controller;
  order.Progress = [this](double value) { this->UpdateProgress(value); };
  order.Aborted = [this]
  { return this->GetAbortExecute() != 0 || banyan::InterruptSignals::Came(); };
  order.Warn = [this](const std::string& sentence) { vtkWarningMacro(<< sentence); };
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
    // All ranks throw the same sentence; one of them says it.
    if (!this->Controller || this->Controller->GetLocalProcessId() == 0)
    {
      vtkErrorMacro(<< this->ErrorMessage);
    }
  }
}
