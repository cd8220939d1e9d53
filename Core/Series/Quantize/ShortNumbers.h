// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Quantize_ShortNumbers_h
#define banyan_Series_Quantize_ShortNumbers_h

#include <string>
#include <vector>

namespace banyan
{

/// Numbers to three digits, with blanks between them: "0.0123 4e-07 inf". An index that lists them
/// for every step stays small.
std::string ShortNumbers(const std::vector<double>& numbers);

/// Throws Error when it is no such list.
std::vector<double> FromShortNumbers(const std::string& text);

} // namespace banyan

#endif
