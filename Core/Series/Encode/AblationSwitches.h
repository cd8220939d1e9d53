// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_AblationSwitches_h
#define banyan_Series_Encode_AblationSwitches_h

namespace banyan
{

/// Ideas that an encoding can do without, which tells what each is worth (see
/// Documentation/codec.md). What is written is as valid, and as close to the values, without them;
/// only larger.
struct AblationSwitches
{
  /// Symbols have tables by what is around them; else by the kind of unit and pass only.
  bool TablesByActivity = true;
  bool SharedTables = true;      ///< contexts that are alike have one table
  bool SmoothestAxisLast = true; ///< else x, y, z
  bool GroupBefore = true;       ///< a group refers to the key frame of the one before
  bool StaticArrays = true; ///< an array that stays the same over a whole group is not stored again
  bool AllModes = true; ///< else cubic interpolation, with the mean of both references or without
};

} // namespace banyan

#endif
