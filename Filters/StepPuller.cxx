// SPDX-License-Identifier: BSD-3-Clause
#include "StepPuller.h"

#include "StepGathering.h"

#include "vtkDataArray.h"
#include "vtkDataArraySelection.h"
#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMultiProcessController.h"
#include "vtkMultiProcessStream.h"
#include "vtkNew.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <sstream>

namespace banyan
{
namespace
{

/// @param problem set to a sentence when the action throws
void Attempt(std::string& problem, const std::function<void()>& action)
{
  try
  {
    action();
  }
  catch (const std::bad_alloc&)
  {
    problem = "There is not enough memory for a piece of the input.";
  }
  catch (const std::exception& error)
  {
    problem = error.what();
  }
}

} // namespace

StepPuller::StepPuller(const WritingOrder& order, const RankTalk& talk, std::function<void()> tick)
  : Order(order)
  , Talk(talk)
  , Tick(std::move(tick))
  , Input(order.Producer, order.Port)
  , Mesh(talk, order.Controller, order.Options, order.Selection, order.CellSelection,
      order.Displacements)
{
}

void StepPuller::FindTimes()
{
  std::string problem;
  try
  {
    if (this->Order.FileName.empty())
    {
      throw Error("No file name is set for the series.");
    }
    this->Times = this->Input.Times(this->Order.AllSteps);
  }
  catch (const std::exception& error)
  {
    problem = error.what();
  }
  this->Talk.AgreeOn(problem);
  if (this->Talk.Ranks() > 1)
  {
    // Every rank asks for the steps of rank 0, so that all go through the same number of them.
    vtkMultiProcessStream stream;
    stream << static_cast<int>(this->Times.size());
    for (const double time : this->Times)
    {
      stream << time;
    }
    this->Order.Controller->Broadcast(stream, 0);
    int steps = 0;
    stream >> steps;
    this->Times.resize(static_cast<std::size_t>(steps));
    for (double& time : this->Times)
    {
      stream >> time;
    }
  }
}

int StepPuller::Count() const
{
  return std::max(1, static_cast<int>(this->Times.size()));
}

vtkSmartPointer<vtkDataObject> StepPuller::PullMine(int step, bool withFiles) const
{
  vtkSmartPointer<vtkDataObject> data = this->Input.Pull(this->Talk.Rank(), this->Talk.Ranks(),
    this->Times.empty() ? nullptr : &this->Times[step], withFiles);
  this->CheckTime(step, data);
  return data;
}

/// Some sources list times that they had, and have the present one alone.
void StepPuller::CheckTime(int step, vtkDataObject* data) const
{
  if (this->Times.empty() || !data || !data->GetInformation()->Has(vtkDataObject::DATA_TIME_STEP()))
  {
    return;
  }
  const double asked = this->Times[step];
  const double delivered = data->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP());
  // Times may be rounded on the way, but not to those of other steps.
  double most = 1e-6 * std::max({ std::abs(asked), std::abs(delivered), 1e-6 });
  for (const int other : { step - 1, step + 1 })
  {
    if (other >= 0 && other < this->Count())
    {
      most = std::min(most, std::abs(this->Times[other] - asked) / 4.0);
    }
  }
  if (!(std::abs(delivered - asked) <= most))
  {
    std::ostringstream text;
    text.precision(17);
    text
      << "The input lists the time " << asked << ", and delivers data of time " << delivered
      << " when it is asked for that. A source that has the present step alone, as in a Catalyst "
         "script, is saved with 'Write Time Steps' off.";
    throw Error(text.str());
  }
}

StepReport StepPuller::ReportOfMine(bool withRanges) const
{
  // The images of a mesh are those that are to be written.
  const vtkNew<vtkDataArraySelection> all;
  StepReport report =
    ReportOf(this->Data, this->Mesh.Active() ? *all : *this->Order.Selection, withRanges);
  if (this->Mesh.Active())
  {
    report.Warning += this->Mesh.Warning();
    report.NotChosen = this->Mesh.NotChosen();
  }
  // Values that are decoded or copied on first touch are touched here, where a failure can still
  // be agreed upon.
  for (const WrittenArray& array : report.Arrays)
  {
    ArrayOf(this->Mine(), array.Name)->GetVoidPointer(0);
  }
  return report;
}

std::vector<StepReport> StepPuller::ReportsOfAll(const StepReport& mine) const
{
  vtkMultiProcessStream stream;
  mine.Save(stream);
  std::vector<StepReport> reports;
  for (vtkMultiProcessStream& theirs : this->Talk.Exchange(stream))
  {
    reports.emplace_back();
    reports.back().Load(theirs);
  }
  return reports;
}

StepAgreement StepPuller::Pull(int step, Purpose purpose)
{
  StepReport mine;
  Attempt(
    mine.Problem, [&] { this->Data = this->PullMine(step, purpose != Purpose::ValuesAgain); });
  this->Talk.Meet(this->Tick);
  mine.Problem = this->Mesh.Take(this->Data, mine.Problem);
  if (mine.Problem.empty())
  {
    Attempt(mine.Problem, [&] { mine = this->ReportOfMine(purpose == Purpose::Ranges); });
  }
  this->Talk.Meet(this->Tick);
  mine.Aborted = this->Order.Aborted();
  StepAgreement now = Agree(this->ReportsOfAll(mine));
  if (now.Aborted)
  {
    throw Interruption("Writing was interrupted at " + this->Named(step) + ".");
  }
  if (!now.Problem.empty())
  {
    throw AgreedError("At " + this->Named(step) + ": " + now.Problem);
  }
  return now;
}

double StepPuller::TimeOf(int step) const
{
  if (!this->Times.empty())
  {
    return this->Times[step];
  }
  vtkInformation* data = this->Input.Data()->GetInformation();
  return data->Has(vtkDataObject::DATA_TIME_STEP()) ? data->Get(vtkDataObject::DATA_TIME_STEP())
                                                    : 0.0;
}

std::string StepPuller::Named(int step) const
{
  std::ostringstream text;
  text << "step " << step;
  if (!this->Times.empty())
  {
    text << " (time " << this->Times[step] << ")";
  }
  return text.str();
}

vtkImageData* StepPuller::Mine() const
{
  return vtkImageData::SafeDownCast(this->Data);
}

} // namespace banyan
