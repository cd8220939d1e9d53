// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_GroupWriter_h
#define banyan_Series_Encode_GroupWriter_h

#include "Base/Hash.h"
#include "Series/Encode/FieldGroup.h"
#include "Series/Encode/SegmentFolder.h"
#include "Series/Format/AtomicFile.h"
#include "Series/Format/SegmentFormat.h"
#include "Series/Format/SeriesIndex.h"

#include <unordered_map>
#include <vector>

namespace banyan
{

/// Writes one segment. Nothing is left behind when it is destroyed before Finish().
class GroupWriter
{
public:
  GroupWriter(SegmentFolder& folder, int number);

  /// Adds a component at the next step: the components of a step in order, then the next step.
  /// @param statistics receives what it came to
  void AddStep(const EncodedStep& step, EncodeStatistics& statistics);
  /// A step of which nothing is stored, as its field rests.
  /// @param like what it would be; for the statistics
  void AddStaticStep(const EncodedStep& like, EncodeStatistics& statistics);

  /// @param heads and @param shapes of the components, in order
  SegmentIndex Finish(const std::vector<group::FieldHead>& heads,
    const std::vector<group::TableShape>& shapes, int firstStep, int steps);

private:
  struct PlaceByHash
  {
    std::size_t operator()(const Hash128& hash) const { return static_cast<std::size_t>(hash.Low); }
  };
  group::Place Store(const Bytes& payload, EncodeStatistics& statistics);
  group::Section AddSection(const Bytes& raw, bool compressed);
  void AddSteps(const std::vector<group::FieldHead>& heads,
    const std::vector<group::TableShape>& shapes, int steps, std::vector<group::Section>& sections);
  void AddDirectory(const std::vector<group::Section>& sections, segment::Header& header);
  Bytes PageHashes() const;

  SegmentFolder& Folder;
  AtomicFile Output;
  Bytes
    Payloads; ///< header and payloads, which are written together: each by itself would take longer
  std::unordered_map<Hash128, group::Place, PlaceByHash> Stored;
  std::vector<group::StepTable> Tables;
};

} // namespace banyan

#endif
