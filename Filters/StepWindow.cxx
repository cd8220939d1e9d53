// SPDX-License-Identifier: BSD-3-Clause
#include "StepWindow.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkExecutive.h"
#include "vtkInformation.h"
#include "vtkInformationExecutivePortKey.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace banyan
{

std::vector<double> StepWindow::TimesOf(vtkInformation* input)
{
  auto* const key = vtkStreamingDemandDrivenPipeline::TIME_STEPS();
  const double* const times = input->Get(key);
  return times ? std::vector<double>(times, times + input->Length(key)) : std::vector<double>();
}

/// Steps are of use as long as nothing upstream has changed and the same piece is wanted.
void StepWindow::ForgetWhatChanged(vtkAlgorithm* owner, vtkInformation* input)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  std::vector<vtkTypeInt64> stamp;
  for (auto* const key : { Pipeline::UPDATE_PIECE_NUMBER(), Pipeline::UPDATE_NUMBER_OF_PIECES(),
         Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS() })
  {
    stamp.push_back(input->Has(key) ? input->Get(key) : -1);
  }
  if (input->Has(Pipeline::UPDATE_EXTENT()))
  {
    const int* const extent = input->Get(Pipeline::UPDATE_EXTENT());
    stamp.insert(stamp.end(), extent, extent + 6);
  }
  if (auto* const executive = vtkDemandDrivenPipeline::SafeDownCast(owner->GetInputExecutive(0, 0)))
  {
    stamp.push_back(static_cast<vtkTypeInt64>(executive->GetPipelineMTime()));
  }
  if (stamp != this->Stamp)
  {
    this->Stamp = stamp;
    this->Steps.clear();
  }
}

void StepWindow::Request(
  vtkAlgorithm* owner, const std::optional<double>& time, const Neighbours& neighbours)
{
  vtkInformation* const input = owner->GetInputInformation(0, 0);
  this->ForgetWhatChanged(owner, input);
  const std::vector<double> times = TimesOf(input);
  this->Wanted = {};
  this->Timeless = times.empty();
  if (this->Timeless)
  {
    this->Steps.clear();
    return;
  }
  const auto after = time ? std::upper_bound(times.begin(), times.end(), *time) : times.begin() + 1;
  const std::ptrdiff_t now = std::max<std::ptrdiff_t>(after - times.begin() - 1, 0);
  const std::ptrdiff_t last = static_cast<std::ptrdiff_t>(times.size()) - 1;
  this->Wanted[1] = times[static_cast<std::size_t>(now)];
  if (neighbours.Previous && now >= neighbours.Distance)
  {
    this->Wanted[0] = times[static_cast<std::size_t>(now - neighbours.Distance)];
  }
  if (neighbours.Next && now + neighbours.Distance <= last)
  {
    this->Wanted[2] = times[static_cast<std::size_t>(now + neighbours.Distance)];
  }
  if (this->Find(*this->Wanted[1]))
  {
    // The input's present step does not matter: it need not execute.
    input->Remove(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP());
  }
  else
  {
    input->Set(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP(), *this->Wanted[1]);
  }
}

void StepWindow::Keep(double time, vtkDataObject* data)
{
  const auto copy = vtkSmartPointer<vtkDataObject>::Take(data->NewInstance());
  copy->ShallowCopy(data);
  this->Steps.push_back({ time, copy });
}

void StepWindow::Take(vtkAlgorithm* owner)
{
  if (this->Timeless)
  {
    this->Wanted[1] = 0.0;
  }
  if (!this->Find(this->Wanted[1].value()))
  {
    this->Keep(*this->Wanted[1], owner->GetInputDataObject(0, 0));
  }
  const auto unwanted = [this](const Kept& kept)
  {
    return std::find(this->Wanted.begin(), this->Wanted.end(), std::optional<double>(kept.Time)) ==
           this->Wanted.end();
  };
  this->Steps.erase(
    std::remove_if(this->Steps.begin(), this->Steps.end(), unwanted), this->Steps.end());

  // The next step last: it is the wanted one when the series plays on, and then there already.
  for (const std::size_t place : { 0, 2 })
  {
    const std::optional<double>& time = this->Wanted[place];
    if (!time || this->Find(*time))
    {
      continue;
    }
    vtkInformation* const input = owner->GetInputInformation(0, 0);
    input->Set(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP(), *time);
    vtkExecutive* const producer = owner->GetInputExecutive(0, 0);
    vtkDataObject* const data = producer->Update(vtkExecutive::PRODUCER()->GetPort(input))
                                  ? owner->GetInputDataObject(0, 0)
                                  : nullptr;
    if (!data)
    {
      throw std::runtime_error("motion is compared with the step at time " + std::to_string(*time) +
                               ", which cannot be read.");
    }
    this->Keep(*time, data);
  }
}

const StepWindow::Kept* StepWindow::Find(double time) const
{
  const auto found = std::find_if(
    this->Steps.begin(), this->Steps.end(), [time](const Kept& kept) { return kept.Time == time; });
  return found == this->Steps.end() ? nullptr : &*found;
}

vtkDataObject* StepWindow::Of(int place) const
{
  const std::optional<double>& time = this->Wanted[static_cast<std::size_t>(place)];
  const Kept* const kept = time ? this->Find(*time) : nullptr;
  return kept ? kept->Data.GetPointer() : nullptr;
}

} // namespace banyan
