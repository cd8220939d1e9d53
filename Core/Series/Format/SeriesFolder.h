// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Format_SeriesFolder_h
#define banyan_Series_Format_SeriesFolder_h

#include "Series/Format/SeriesIndex.h"

#include <string>

namespace banyan
{

/// Throws Error, which says what to open instead, when a path leads to a folder.
void RefuseFolder(const std::string& path);

/// Whether a folder has the first segment of an index, and its mesh: a quick look.
bool BeginsInFolder(const std::string& folder, const SeriesIndex& index);

/// The folder that holds all files which an index names. Looked for in this order: `path + ".d"`;
/// the same beside the file that `path` leads to, where it is a symbolic link; and every other
/// folder `*.d` at these two places, for an index that was renamed without its folder.
/// @param path of the index
/// Throws Error, a sentence that says which files are missing where and what to do, when no folder
/// holds all of them, or when several do and none of them has the right name. A folder of the right
/// name whose files are all there in a wrong size is given back: who opens them says which.
std::string FindSeriesFolder(const std::string& path, const SeriesIndex& index);

} // namespace banyan

#endif
