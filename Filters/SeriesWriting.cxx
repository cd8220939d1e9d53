// SPDX-License-Identifier: BSD-3-Clause
#include "SeriesWriting.h"

#include "CommunicatorOf.h"

#include "Base/Interruption.h"
#include "Parallel/Communicate/Collective.h"
#include "Series/Format/SeriesPath.h"

#include <algorithm>

namespace banyan
{
namespace
{

/// Whether the values of the whole series must be known before the first one is encoded.
bool NeedsAllValuesFirst(const EncodeOptions& options)
{
  const bool relative =
    options.Mode == ErrorBoundMode::RelativeToSeriesRange && options.ErrorBound > 0.0;
  return options.Quantizer.NeedsHistogram(relative) ||
         (relative && options.Quantizer.Range.From != RangeRule::Source::Given);
}

} // namespace

SeriesWriting::SeriesWriting(WritingOrder order)
  : Order(std::move(order))
  , Ranks(CommunicatorOf(this->Order.Controller))
  , Steps(this->Order, *this->Ranks, [this] { this->Tick(); })
  , Changes(
      [this](const std::string& warning)
      {
        if (this->Ranks->Rank() == 0)
        {
          this->Order.Warn(warning);
        }
      })
  , Histograms(this->Order.Options)
  , Groups(std::make_unique<SeriesGroups>(
      this->Order, *this->Ranks, this->Steps, [this] { this->Tick(); }))
{
}

void SeriesWriting::Run()
{
  try
  {
    this->Steps.FindTimes();
    this->TakeLock();
    this->Write();
  }
  catch (const Interruption&)
  {
    this->Kept = this->Groups->GiveUp(true);
    throw;
  }
  catch (const CollectiveError&)
  {
    this->Kept = this->Groups->GiveUp(false);
    throw;
  }
}

void SeriesWriting::Write()
{
  if (NeedsAllValuesFirst(this->Order.Options))
  {
    this->WriteInTwoPasses();
    return;
  }
  try
  {
    this->WriteInOnePass();
  }
  catch (const SeriesChanges::LateHiding&)
  {
    this->StartAnew();
    this->WriteInTwoPasses();
  }
}

void SeriesWriting::WriteInOnePass()
{
  this->ForEachStep({ 0.0, 0.5, 0.5 },
    [this](int step)
    {
      const StepAgreement now = this->Steps.Pull(step, StepPuller::Purpose::Values);
      this->Changes.MustHideAlready(step, now);
      this->Changes.Add(step, now, this->Steps.Named(step));
      this->EncodeStep(step, now);
    });
  this->Groups->Finish();
}

void SeriesWriting::WriteInTwoPasses()
{
  this->LookAtAllSteps();
  this->ForEachStep({ 0.5, 0.25, 0.25 },
    [this](int step)
    {
      const StepAgreement now = this->Steps.Pull(step, StepPuller::Purpose::ValuesAgain);
      this->Changes.Compare(now, this->Steps.Named(step));
      this->EncodeStep(step, now);
    });
  this->Groups->Finish();
}

void SeriesWriting::LookAtAllSteps()
{
  this->ForEachStep({ 0.0, 0.5, 0.0 },
    [this](int step)
    {
      const StepAgreement now = this->Steps.Pull(step, StepPuller::Purpose::Ranges);
      this->Changes.Add(step, now, this->Steps.Named(step));
      this->Changes.IncludeRanges(now);
      Collective(*this->Ranks,
        [&] { this->Histograms.Count(this->Steps.Mine(), now, this->Ranks->Rank()); });
    });
  this->Histograms.Merge(*this->Ranks, this->Changes.Series().Arrays);
}

void SeriesWriting::EncodeStep(int step, const StepAgreement& now)
{
  if (step == 0)
  {
    this->Groups->Open(this->Changes.Series(), this->Histograms);
  }
  this->Groups->Add(step, now);
}

/// Collective. Before anything is computed: it may take hours.
void SeriesWriting::TakeLock()
{
  std::string path;
  CollectiveOn(0, *this->Ranks,
    [&]
    {
      path = FollowLinks(this->Order.FileName);
      this->Lock = std::make_unique<SeriesLock>(path);
    });
  this->Order.FileName = BroadcastStrings(*this->Ranks, { path })[0];
}

void SeriesWriting::StartAnew()
{
  this->Groups->GiveUp(false);
  this->Groups = std::make_unique<SeriesGroups>(
    this->Order, *this->Ranks, this->Steps, [this] { this->Tick(); });
}

template <class Action>
void SeriesWriting::ForEachStep(const PassProgress& pass, const Action& action)
{
  this->Pass = pass;
  for (int step = 0; step < this->Steps.Count(); ++step)
  {
    this->Pulled = step;
    this->Report();
    action(step);
  }
  this->Pulled = this->Steps.Count();
}

void SeriesWriting::Tick()
{
  this->Report();
  if (this->Order.Aborted())
  {
    this->Groups->Interrupt();
  }
}

void SeriesWriting::Report()
{
  const double pulled = static_cast<double>(this->Pulled) / this->Steps.Count();
  const double done =
    this->Pass.Before + this->Pass.Pulling * pulled + this->Pass.Encoding * this->Groups->Share();
  this->Told = std::min(std::max(done, this->Told), 1.0);
  this->Order.Progress(this->Told);
}

} // namespace banyan
