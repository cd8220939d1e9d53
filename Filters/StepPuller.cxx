// SPDX-License-Identifier: BSD-3-Clause
#include "StepPuller.h"

#include "RankMessages.h"
#include "StepGathering.h"

#include "vtkDataArray.h"
#include "vtkDataArraySelection.h"
#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkNew.h"

#include "Base/Interruption.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace banyan
{

StepPuller::StepPuller(const WritingOrder& order, Communicator& ranks, std::function<void()> tick)
  : Order(order)
  , Ranks(ranks)
  , Tick(std::move(tick))
  , Input(order.Producer, order.Port)
  , Mesh(ranks, order.Options, order.Selection, order.CellSelection, order.Displacements)
  , Grid(ranks)
{
}

void StepPuller::FindTimes()
{
  Collective(this->Ranks,
    [this]
    {
      if (this->Order.FileName.empty())
      {
        throw Error("No file name is set for the series.");
      }
      this->Times = this->Input.Times(this->Order.AllSteps);
    });
  // Every rank asks for the steps of rank 0, so that all go through the same number of them.
  std::uint64_t steps = this->Times.size();
  this->Ranks.Broadcast(0, &steps, sizeof(steps));
  this->Times.resize(steps);
  this->Ranks.Broadcast(0, this->Times.data(), steps * sizeof(double));
}

int StepPuller::Count() const
{
  return std::max(1, static_cast<int>(this->Times.size()));
}

vtkSmartPointer<vtkDataObject> StepPuller::PullMine(int step, bool withFiles) const
{
  vtkSmartPointer<vtkDataObject> data = this->Input.Pull(this->Ranks.Rank(), this->Ranks.Size(),
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
  for (vtkMultiProcessStream& theirs : AllGatherStreams(this->Ranks, stream))
  {
    reports.emplace_back();
    reports.back().Load(theirs);
  }
  return reports;
}

StepAgreement StepPuller::Pull(int step, Purpose purpose)
{
  constexpr const char* noMemory = "There is not enough memory for a piece of the input.";
  StepReport mine;
  const auto pull = [&] { this->Data = this->PullMine(step, purpose != Purpose::ValuesAgain); };
  Attempt(mine.Problem, pull, noMemory);
  Meet(this->Ranks, this->Tick);
  // Collective: a rank with a problem must not leave it out.
  std::string ofMesh;
  Attempt(ofMesh,
    [&]
    {
      this->Mesh.Take(this->Data, mine.Problem);
      this->Grid.Take(this->Data, mine.Problem);
    });
  mine.Problem = mine.Problem.empty() ? ofMesh : mine.Problem;
  const auto report = [&] { mine = this->ReportOfMine(purpose == Purpose::Ranges); };
  Attempt(mine.Problem, report, noMemory);
  Meet(this->Ranks, this->Tick);
  mine.Aborted = this->Order.Aborted();
  StepAgreement now = Agree(this->ReportsOfAll(mine));
  if (now.Aborted)
  {
    throw Interruption("Writing was interrupted at " + this->Named(step) + ".");
  }
  if (!now.Problem.empty())
  {
    throw CollectiveError("At " + this->Named(step) + ": " + now.Problem);
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
