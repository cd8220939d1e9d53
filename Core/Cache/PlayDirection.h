// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Cache_PlayDirection_h
#define banyan_Cache_PlayDirection_h

#include <cstdint>

namespace banyan
{

class SeriesFile;

/// Which step of a series comes next, from those that were asked for before: the play goes on as it
/// went from the step before to this one.
class PlayDirection
{
public:
  /// @param step that is asked for now; the one before, once more, changes nothing
  /// @return the step that is expected next; -1 where there is none, or only one was asked for
  int Asked(const SeriesFile& series, int step);

  /// From the step before to this one; 0 while only one was asked for.
  int Stride() const { return this->Apart; }

private:
  std::uint64_t SeriesId = 0;
  int Step = -1;
  int Apart = 0;
};

} // namespace banyan

#endif
