// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Readers_VerifiedBricks_h
#define banyan_Readers_VerifiedBricks_h

#include "Series/Decode/SeriesFile.h"

#include <map>
#include <tuple>
#include <vector>

namespace banyan
{

/// Checks the checksums of the bricks that a piece needs, but not of those that have not changed
/// since they were checked last: same brick, same identity. Remembers one identity per brick,
/// array, component and level, however long the series is.
///
/// For one thread and one series at a time; a call with another series starts over.
class VerifiedBricks
{
public:
  /// Reads the payloads that have to be checked, on the threads of the process's pool.
  /// Throws Error when one is damaged; then nothing of this call is remembered.
  void Verify(const SeriesFile& series, const FieldKey& field, const Box& samples);

private:
  using FieldAtAnyStep = std::tuple<int, int, int>; ///< array, component, level
  std::map<FieldAtAnyStep, std::vector<PayloadIdentity>> Checked;
  std::uint64_t Series = 0;
};

} // namespace banyan

#endif
