// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Programs_StepTable_h
#define banyan_Programs_StepTable_h

#include "SeriesReport.h"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace banyan
{

/// One line of the table by steps, with what its columns are made from.
struct StepLine
{
  const SeriesReport* Report = nullptr;
  std::size_t Component = 0; ///< in the report
  std::size_t Step = 0;      ///< in the component's steps

  const ComponentReport& Of() const { return this->Report->Components[this->Component]; }
  const StepReport& At() const { return this->Of().Steps[this->Step]; }
};

/// A column of the table by steps: the same in CSV and JSON. Whoever learns something new about a
/// step adds a column, and it appears in both.
struct StepColumn
{
  std::string Name; ///< letters, digits and underscores
  /// Nothing where there is no such number.
  std::function<std::optional<double>(const StepLine&)> Value;
};

/// Columns "unchanged_4096" and the like count the greatest nodes of at most that many voxels.
std::vector<StepColumn> StepColumns(const SeriesReport& report);

/// All lines: components in their order, steps within.
std::vector<StepLine> StepLines(const SeriesReport& report);

/// The table as comma-separated values with a line of headings; the first columns are array (with
/// the component) and the rest as `StepColumns`. Nothing is an empty field.
std::string StepCsv(const SeriesReport& report);

} // namespace banyan

#endif
