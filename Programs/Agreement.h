// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Programs_Agreement_h
#define banyan_Programs_Agreement_h

#include "Series/Format/SeriesIndex.h"
#include "SourceSteps.h"

#include <string>
#include <vector>

namespace banyan
{

/// "wind[u]", or "pressure" when the array has one component.
std::string NameOfComponent(const ArrayIndex& array, std::size_t component);

/// Numbers of the arrays of those names, or of all when there are none. Throws Error for a name
/// that the series does not have.
std::vector<int> ChosenArrays(const SeriesIndex& index, const std::vector<std::string>& names);

/// Throws Error, in a sentence that names the step, when a source's step is not one of the series:
/// another time, grid, type or number of components, or other arrays.
/// @param names arrays that count; empty: all that either of the two has
void CheckAgreement(const SeriesIndex& index, int step, const SourceStep& source,
  const std::vector<std::string>& names);

} // namespace banyan

#endif
