// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Programs_Verification_h
#define banyan_Programs_Verification_h

#include "Series/Decode/SeriesFile.h"
#include "SourceSteps.h"
#include "ValueErrors.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace banyan
{

/// The value that went most wrong of a component.
struct WorstValue
{
  int Step = 0;
  glm::ivec3 Index{ 0 }; ///< (i, j, k) in the extent of the series
  std::string Original;  ///< as many digits as bring back the same bits; NaN with its bits
  std::string Decoded;
  double Error = 0.0; ///< as it is judged; infinity where one of them is not finite
};

/// One component of one array, compared over all steps.
struct ComponentVerification
{
  int Array = 0;
  int Component = 0;
  std::string Name;
  double Bound = 0.0;
  bool Transformed = false; ///< the bound is one on transformed values
  std::int64_t Clamped = 0; ///< values that were judged by what they were clamped to
  std::vector<ValueErrors> Steps;
  ValueErrors All;
  std::optional<WorstValue> Worst; ///< nothing when no bit differs
  /// The index promises less than was asked for: nothing, or a sentence.
  std::string TooLoose;

  bool Proven() const { return this->All.Proven() && this->TooLoose.empty(); }
};

struct Verification
{
  std::vector<ComponentVerification> Components;
  std::vector<double> Times;

  bool Proven() const;
};

struct VerificationChoice
{
  std::vector<std::string> Arrays; ///< to compare; empty: all of the series, which must be all of
                                   ///< the source
  /// For equation 2. Nothing: the one that the component was encoded for; when there is none, a
  /// ramp from 0 at the least to 1 at the greatest value of each component. Which values nobody can
  /// see is for the series to say, not for this.
  std::optional<OpacityFunction> Opacity;
};

/// Compares each value of each step of a series with its source, at the finest level.
/// @param progress called after each step with the number of steps compared
/// Throws Error, with a sentence for the user, when the two cannot be compared: steps, times, grid,
/// arrays, types or components differ, or one of them cannot be read.
/// Memory: one array of the source and one component of the series, at one step.
Verification Verify(const SeriesFile& series, SourceSteps& source, const VerificationChoice& choice,
  const std::function<void(int)>& progress = {});

} // namespace banyan

#endif
