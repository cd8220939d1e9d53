// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_GroupSchedule_h
#define banyan_Series_Encode_GroupSchedule_h

#include "Series/Encode/GroupEncoder.h"

namespace banyan
{

/// How the groups of a series are dealt out to ranks, and who needs the values of which steps: each
/// rank those of its groups, and the last step of the group before where groups refer to that. Who
/// encodes both of them remembers it.
class GroupSchedule
{
public:
  GroupSchedule() = default;

  /// @param plan of the series
  /// @param steps of the whole series
  GroupSchedule(const SeriesIndex& plan, const EncodeOptions& options, int steps, int ranks)
    : Interval(plan.KeyframeInterval)
    , Steps(steps)
    , Ranks(ranks)
    , RefersBefore(MayReferBefore(plan, options))
  {
  }

  int GroupOf(int step) const { return step / this->Interval; }

  /// Among those of its group.
  int PlaceOf(int step) const { return step % this->Interval; }

  bool EndsGroup(int step) const
  {
    return this->PlaceOf(step) + 1 == this->Interval || step + 1 == this->Steps;
  }

  /// The rank that encodes a group.
  int OwnerOf(int group) const { return group % this->Ranks; }

  /// The rank that needs a step as the one before its group, or -1.
  int NeedsBefore(int step) const
  {
    const int owner = this->OwnerOf(this->GroupOf(step));
    const int next = this->OwnerOf(this->GroupOf(step) + 1);
    // A group of a single step is that key frame alone, and refers to nothing.
    const bool refers = this->RefersBefore && this->EndsGroup(step) && step + 2 < this->Steps;
    return refers && next != owner ? next : -1;
  }

private:
  int Interval = 1;
  int Steps = 0;
  int Ranks = 1;
  bool RefersBefore = false;
};

} // namespace banyan

#endif
