// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_GoldenFiles_h
#define banyan_Testing_GoldenFiles_h

#include "Series/GoldenCases.h"

#include <map>
#include <string>
#include <vector>

namespace banyan::testing
{

/// What a folder of golden files says: a name of a part ("moving array 0 step 1 ...") to the text
/// that stands for it. `checksums.txt` holds it with one line "part: text" each.
using GoldenParts = std::map<std::string, std::string>;

constexpr const char* ChecksumFile = "checksums.txt";

/// Opens every `*.banyan` of a folder and reads everything: main fields of the index as they are;
/// per field XXH3-64 of all decoded values and of all nodes (range, mask, uniform, non-finite; not
/// how they are stored); per file XXH3-128 of its bytes. The text of what cannot be read is the
/// error.
GoldenParts ReadGolden(const std::string& folder);

GoldenParts LoadChecksums(const std::string& folder);
void SaveChecksums(const std::string& folder, const GoldenParts& parts);

/// One sentence per part that is not the same in both, or is in one only.
std::vector<std::string> Differences(const GoldenParts& expected, const GoldenParts& found);

/// Encodes a series into a folder.
SeriesIndex WriteGoldenSeries(const std::string& folder, const GoldenCase& series);

/// Version that the first line of an index names.
int VersionOf(const std::string& indexPath);

} // namespace banyan::testing

#endif
