// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_RankTalk_h
#define banyan_Inputs_RankTalk_h

#include "BanyanInputsModule.h"

#include "Base/Error.h"

#include "vtkMultiProcessStream.h"

#include <functional>
#include <string>
#include <vector>

class vtkMultiProcessController;

namespace banyan
{

/// Is thrown by all ranks together, with the same sentence, after the same messages: they may go on
/// to talk to each other. Any other exception is one rank's own.
class BANYANINPUTS_EXPORT AgreedError : public Error
{
public:
  using Error::Error;
};

/// All ranks were told to stop.
class BANYANINPUTS_EXPORT Interruption : public AgreedError
{
public:
  using AgreedError::AgreedError;
};

/// How the ranks of a controller agree. Every method but the first two is collective.
class BANYANINPUTS_EXPORT RankTalk
{
public:
  /// @param controller may be nullptr: this rank alone
  explicit RankTalk(vtkMultiProcessController* controller);

  int Rank() const { return this->Mine; }
  int Ranks() const { return this->Count; }

  /// Returns when all ranks have called it. MPI's own calls keep a core busy while they wait; this
  /// one sleeps, so that threads which work in the background get it.
  /// @param tick called again and again meanwhile
  void Meet(const std::function<void()>& tick) const;

  /// Returns what every rank says, in the order of ranks.
  std::vector<vtkMultiProcessStream> Exchange(const vtkMultiProcessStream& mine) const;

  /// @param problem a sentence, or nothing if all is well. Throws AgreedError with that of the
  /// lowest rank that has one, which it names.
  void AgreeOn(const std::string& problem) const;

  /// Every rank does something, and all of them throw AgreedError when one of them fails.
  void Together(const std::function<void()>& action) const;

  /// Does the same as Together; only one rank has something to do.
  void OnRank(int rank, const std::function<void()>& action) const;

  /// The texts that rank 0 gives.
  std::vector<std::string> FromRankZero(const std::vector<std::string>& texts) const;

  /// Ranks on this machine, this one included.
  int RanksOnThisNode() const;

private:
  vtkMultiProcessController* Controller;
  int Mine = 0;
  int Count = 1;
};

} // namespace banyan

#endif
