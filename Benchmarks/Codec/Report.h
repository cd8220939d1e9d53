// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_Report_h
#define banyan_Benchmarks_Report_h

#include "Measure.h"

#include <ostream>
#include <string>
#include <vector>

namespace banyan::bench
{

/// Names of the columns, without the end of the line.
std::string CsvHeader();
std::string CsvLine(const Measurement& measurement);

/// Measures each method at each accuracy and writes a line as soon as it is known.
/// @param messages receives the same for people
/// @return whether all of ours worked and kept their bounds. A peer that fails is left out with a
/// word, and one that breaks its bound is a line like any other.
bool Report(const RawSeries& series, const MethodList& methods, const std::vector<int>& bits,
  const MeasureOptions& options, std::ostream& csv, std::ostream& messages);

} // namespace banyan::bench

#endif
