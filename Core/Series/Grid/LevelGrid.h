// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Grid_LevelGrid_h
#define banyan_Series_Grid_LevelGrid_h

#include "Series/Grid/Grid.h"

namespace banyan
{

/// The grid that a level looks like to somebody who knows nothing of levels.
///
/// Level 0 is the domain itself. Level L > 0 holds the samples that lie exactly on every 2^L-th
/// sample of the domain, floor((n - 1) / 2^L) + 1 per axis; its extent starts at 0, its spacing is
/// 2^L times the domain's, its origin is the position of the domain's first sample, and the
/// directions are kept. A last sample that only repeats the last fine one (see BrickLayout) is not
/// part of it, because a regular grid has no place for it.
///
/// Sample (i, j, k) of the returned extent is sample (i, j, k) - Extent.Lo of the level's
/// BrickLayout, bit-exact.
/// @param level >= 0
Grid GridOfLevel(const Grid& domain, int level);

} // namespace banyan

#endif
