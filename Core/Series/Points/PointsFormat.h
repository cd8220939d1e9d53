// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Points_PointsFormat_h
#define banyan_Series_Points_PointsFormat_h

#include <cstddef>
#include <cstdint>

// What writing and reading the file of points have in common.
namespace banyan::points_file
{

constexpr char Magic[8] = { 'B', 'a', 'n', 'y', 'a', 'n', 'P', 't' };
constexpr std::uint32_t Version = 1;
/// Bytes before the directory: magic, version, 0, number of chunks at 16, zeros.
constexpr std::size_t HeadBytes = 64;
/// Bytes of an entry of the directory: hash and size of a chunk.
constexpr std::size_t EntryBytes = 16;

} // namespace banyan::points_file

#endif
