// SPDX-License-Identifier: BSD-3-Clause
// How steps may differ from the first one.
#include "SeriesWriting.h"

#include "vtkDataObject.h"
#include "vtkInformation.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace banyan
{

/// Some sources list times that they had, and have the present one alone.
void SeriesWriting::CheckTime(int step, vtkDataObject* data) const
{
  if (!this->HasTimes || !data || !data->GetInformation()->Has(vtkDataObject::DATA_TIME_STEP()))
  {
    return;
  }
  const double asked = this->Times[step];
  const double delivered = data->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP());
  // Times may be rounded on the way, but not to those of other steps.
  double most = 1e-6 * std::max({ std::abs(asked), std::abs(delivered), 1e-6 });
  for (const int other : { step - 1, step + 1 })
  {
    if (other >= 0 && other < static_cast<int>(this->Times.size()))
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

void SeriesWriting::CompareWithFirst(int step, const StepAgreement& now) const
{
  const std::string change = ChangeBetween(this->First, now);
  if (!change.empty())
  {
    throw AgreedError("The data change at " + this->Named(step) + ": " + change +
                      ". All steps of a series need the same grid and the same arrays.");
  }
}

void SeriesWriting::Remember(int step, const StepAgreement& now)
{
  if (step > 0)
  {
    this->CompareWithFirst(step, now);
  }
  else
  {
    this->First = now;
  }
  this->First.HidesPoints = this->First.HidesPoints || now.HidesPoints;
  this->First.HidesCells = this->First.HidesCells || now.HidesCells;
  this->WarnOf(step, now);
}

/// Warns of arrays that were not there to be chosen, and of those that cannot be written.
void SeriesWriting::WarnOf(int step, const StepAgreement& now)
{
  std::string warning = this->Warned.insert(now.Warning).second ? now.Warning : "";
  for (const std::string& name : now.NotChosen)
  {
    // Who left out some of the first step's arrays does not want all of them.
    if (step > 0 && this->First.NotChosen.empty() && this->Warned.insert(name).second)
    {
      warning += "The " + name + " first appears at " + this->Named(step) +
                 " and is not written: a series has the arrays of its first step, at all steps. ";
    }
  }
  if (!warning.empty() && this->Talk.Rank() == 0)
  {
    this->Order.Warn(warning);
  }
}

/// Files that are being written say what is hidden from their first step on.
void SeriesWriting::MustHideAlready(int step, const StepAgreement& now) const
{
  if (step > 0 && ((now.HidesPoints && !this->First.HidesPoints) ||
                    (now.HidesCells && !this->First.HidesCells)))
  {
    throw LateHiding("");
  }
}

/// Sets `Written`, too.
std::vector<ArrayDescription> SeriesWriting::DescribeArrays()
{
  std::vector<ArrayDescription> descriptions;
  this->Written.clear();
  for (const ArrayFlags flags : { ArrayFlags::OfPoints, ArrayFlags::OfCells })
  {
    if (flags == ArrayFlags::OfPoints ? this->First.HidesPoints : this->First.HidesCells)
    {
      this->Written.push_back(HiddenFlags(flags));
      descriptions.push_back(DescriptionOfFlags(flags));
    }
  }
  for (const WrittenArray& array : this->First.Arrays)
  {
    this->Written.push_back(array);
    descriptions.push_back(
      { array.Name, array.Type, array.Components, array.Ranges, this->Histograms.Of(array.Name) });
  }
  return descriptions;
}

void SeriesWriting::StartAnew()
{
  this->GiveUp(false);
  this->Opened = false;
  this->Encoder.reset();
  this->Assembly.reset();
  this->Folder.reset();
  this->Encoded = 0;
  this->Encoding = 0;
  this->InSecondPass = false;
  this->TwoPasses = true;
}

} // namespace banyan
