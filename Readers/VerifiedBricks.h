#ifndef banyan_Readers_VerifiedBricks_h
#define banyan_Readers_VerifiedBricks_h

#include "Series/SeriesFile.h"

#include <unordered_set>

namespace banyan
{

/// Checks the checksums of the bricks that a piece needs, each payload once: a brick that did not
/// change since an earlier step has the identity of the one checked then.
///
/// For one thread and one series at a time; a call with another series starts over.
class VerifiedBricks
{
public:
  /// Reads the payloads that were not checked before, on the threads of the process's pool.
  /// Throws Error when one is damaged; then nothing of this call is remembered.
  void Verify(const SeriesFile& series, const FieldKey& field, const Box& samples);

private:
  struct Hash
  {
    std::size_t operator()(const PayloadIdentity& identity) const
    {
      return static_cast<std::size_t>(identity.Low);
    }
  };
  std::unordered_set<PayloadIdentity, Hash> Good;
  std::uint64_t Series = 0;
};

} // namespace banyan

#endif
