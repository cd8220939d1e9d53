// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Cache_PlayDirection_h
#define banyan_Cache_PlayDirection_h

#include <cstdint>

namespace banyan
{

class SeriesFile;

/// Which step of a series comes next, from those that were asked for before: the play goes on as it
/// went from the step before to this one, and after the last step it begins again.
class PlayDirection
{
public:
  /// @param step that is asked for now; the one before, once more, changes nothing
  /// @return the step that is expected next; -1 where only one was asked for
  int Asked(const SeriesFile& series, int step);

  /// The step that is expected to be asked for after another one; -1 while none is.
  int After(int step) const;

private:
  std::uint64_t SeriesId = 0;
  int Steps = 0;
  int Step = -1;
  int Apart = 0; ///< from the step before to this one; 0 while only one was asked for
};

} // namespace banyan

#endif
