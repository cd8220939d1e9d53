// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Filters_SeriesChanges_h
#define banyan_Filters_SeriesChanges_h

#include "StepReport.h"

#include "Parallel/Communicate/Collective.h"

#include <functional>
#include <set>
#include <string>

namespace banyan
{

/// Compares the steps of a series with the first one. All ranks call it with the same agreements,
/// and all throw the same error.
class SeriesChanges
{
public:
  /// A step hides points or cells, and the files so far say that none does.
  class LateHiding : public CollectiveError
  {
  public:
    using CollectiveError::CollectiveError;
  };

  /// @param warn called with sentences for the user
  explicit SeriesChanges(std::function<void(const std::string&)> warn)
    : Warn(std::move(warn))
  {
  }

  /// Takes step 0 as the first one. Of later steps, throws CollectiveError when their grid or
  /// arrays differ; otherwise notes what they hide. Warns of arrays that are not written, once
  /// each.
  /// @param named the step, for messages
  void Add(int step, const StepAgreement& now, const std::string& named);

  /// Adds the ranges of a step's values to those of the series. The step must have been added.
  void IncludeRanges(const StepAgreement& now);

  /// Throws CollectiveError when grid or arrays of a step differ from those of the first one.
  void Compare(const StepAgreement& now, const std::string& named) const;

  /// Throws LateHiding when a step hides points or cells and no step before did.
  void MustHideAlready(int step, const StepAgreement& now) const;

  /// The first step, with what any step hides and with the ranges that were included.
  const StepAgreement& Series() const { return this->First; }

private:
  void WarnOf(int step, const StepAgreement& now, const std::string& named);

  std::function<void(const std::string&)> Warn;
  StepAgreement First;
  std::set<std::string> Warned; ///< sentences and names of arrays that users have been told
};

} // namespace banyan

#endif
