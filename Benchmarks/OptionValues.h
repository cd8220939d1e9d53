// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_OptionValues_h
#define banyan_Benchmarks_OptionValues_h

#include <string>
#include <vector>

/// Values of the options of the programs that measure.
namespace banyan::bench
{

/// The argument behind `arguments[i]`, of which `i` becomes the number. Throws Error when there is
/// none.
const std::string& ValueBehind(const std::vector<std::string>& arguments, std::size_t& i);

std::vector<std::string> SplitAtCommas(const std::string& text);

/// A number within limits. Throws Error with a sentence that names the option.
double NumberIn(const std::string& option, const std::string& text, double low, double high);

/// A whole number within limits, likewise.
int CountIn(const std::string& option, const std::string& text, int low, int high);

} // namespace banyan::bench

#endif
