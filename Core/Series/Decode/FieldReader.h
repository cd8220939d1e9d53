// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Decode_FieldReader_h
#define banyan_Series_Decode_FieldReader_h

#include "Series/Decode/OpenGroup.h"

#include <atomic>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace banyan
{

/// Finds segments and their tables, keeps those that were used last, and decodes bricks: the inside
/// of SeriesFile, which checks arguments first. All methods may be called from any thread.
class FieldReader
{
public:
  /// Segments are opened at once, so that replacing the series does not take them away (see
  /// SegmentFile). Throws Error.
  /// @param series is kept
  explicit FieldReader(const OpenSeries& series);
  ~FieldReader();
  FieldReader(const FieldReader&) = delete;
  FieldReader& operator=(const FieldReader&) = delete;

  /// See SeriesFile.
  std::shared_ptr<const std::vector<BrickNode>> Nodes(const FieldKey& field);
  void DecodeBrick(const FieldKey& field, std::int64_t brick, void* values);
  /// Decodes as SeriesFile::DecodePart does. @return false when the caller has to decode the whole
  /// brick instead
  bool DecodePart(const FieldKey& field, std::int64_t brick, const Box& part,
    const glm::i64vec3& stride, void* first);
  /// Decodes as SeriesFile::DecodeRow does, several bricks at once. @return false when the caller
  /// has to decode them one by one
  bool DecodeRow(const FieldKey& field, std::int64_t brick, int count, const Box& part,
    const glm::i64vec3& stride, void* first);
  /// See SeriesFile.
  double StepOfValues(const FieldKey& field);
  /// Decodes some bricks at the end of the grid as well. Checksums do not tell that an index and
  /// its segments do not belong together, such as an index with another extent.
  void VerifyBricks(const FieldKey& field, const std::vector<std::int64_t>& bricks);
  std::uint64_t BytesRead() const { return this->Read; }
  std::uint64_t BricksDecoded() const { return this->Decoded; }

private:
  using Kept = std::pair<std::uint64_t, std::shared_ptr<OpenGroup>>;

  std::shared_ptr<GroupReader> Segment(int step);
  /// Where a field is stored: as it is asked for or, where it rests, at the last step of the group
  /// from which on it does.
  FieldKey Stored(FieldKey field);
  /// Returns the hash of the header of the segment where the last step before a group is stored.
  Hash128 HashBefore(const FieldKey& last);
  /// @param field as Stored says
  std::shared_ptr<OpenGroup> Open(const FieldKey& field);
  std::shared_ptr<OpenGroup> MakeGroup(
    const FieldKey& field, const std::shared_ptr<GroupReader>& segment, std::uint32_t component);
  void ForgetOldGroups();

  const OpenSeries& Series;
  std::mutex SegmentMutex;
  std::vector<std::shared_ptr<GroupReader>> Segments;
  std::unordered_map<std::string, std::shared_ptr<const SegmentFile>> Files; ///< by name
  std::mutex StaticMutex;
  std::unordered_map<std::uint64_t, int> StaticFields; ///< by segment and component; see Stored
  std::mutex OpenMutex;
  std::list<Kept> Opened; ///< most recently used first
  std::atomic<std::uint64_t> Read{ 0 };
  std::atomic<std::uint64_t> Decoded{ 0 };
};

} // namespace banyan

#endif
