// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_CodecOptions_h
#define banyan_Benchmarks_CodecOptions_h

#include "Measure.h"

#include <string>
#include <vector>

namespace banyan::bench
{

/// What the program is asked to do. `CodecHelp()` explains each one.
struct CodecOptions
{
  std::vector<std::string> Series; ///< JSON files, see RawSeries::Open
  std::string Output;
  bool Append = false;
  std::vector<int> Bits = { 6, 8, 10, 12 };
  std::vector<std::string> Methods; ///< none means all
  MeasureOptions Measuring;
  bool Help = false;
};

/// @param arguments without the program's name
/// Throws Error, with a sentence that names the argument, when one is unknown or out of range.
CodecOptions ParseCodecOptions(const std::vector<std::string>& arguments);

std::string CodecHelp();

} // namespace banyan::bench

#endif
