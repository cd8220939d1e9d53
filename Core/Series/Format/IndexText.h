// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Format_IndexText_h
#define banyan_Series_Format_IndexText_h

#include "Series/Format/SeriesIndex.h"

#include <string>
#include <vector>

namespace banyan
{

/// Greatest size of an index file, checked before it is read.
constexpr std::uint64_t GreatestIndexBytes = std::uint64_t{ 256 } << 20;

/// Whether a file begins with the word that all indexes begin with. False for what cannot be read.
/// Reads some bytes and nothing else.
bool BeginsAsSeries(const std::string& path);

/// The content of an index file: see Documentation/format.md. Throws Error when a name is not UTF-8
/// or a number that must be finite is not.
std::string IndexToText(const SeriesIndex& index);

/// Inverse of `IndexToText`; doubles come back bit-exact. Throws Error that names `path` when the
/// text is no index, of another version, with features that are not known, damaged, or says what
/// cannot be.
SeriesIndex IndexFromText(const std::string& text, const std::string& path);

/// Lists all features of the format, in the order of Documentation/format.md.
std::vector<std::string> KnownFeatures();

/// Lists the features that a reader must know to read the series, by the names of
/// Documentation/format.md, in its order.
std::vector<std::string> FeaturesOf(const SeriesIndex& index);

/// Checks what encoder and reader both need to hold: sizes, limits, names, finite numbers, order.
/// Throws Error.
void CheckIndex(const SeriesIndex& index);

/// Throws Error when the grid is out of the format's limits (they keep every product of sizes far
/// from overflow).
void CheckGrid(const Grid& grid, int brickCells);

} // namespace banyan

#endif
