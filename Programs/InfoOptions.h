// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Programs_InfoOptions_h
#define banyan_Programs_InfoOptions_h

#include "SeriesReport.h"

#include <string>
#include <vector>

namespace banyan
{

/// Holds what banyan-info is asked to do. `InfoHelp()` explains each one.
struct InfoOptions
{
  std::string File;
  ReportChoice Choice;
  std::string Csv; ///< file for the table by steps; empty: none
  bool Json = false;
  bool Time = false;
  bool Between = false;
  bool Help = false;
};

/// @param arguments without the program's name
/// Throws Error, with a sentence that names the argument, when one is unknown or out of range.
InfoOptions ParseInfoOptions(const std::vector<std::string>& arguments);

std::string InfoHelp();

} // namespace banyan

#endif
